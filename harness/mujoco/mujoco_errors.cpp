#include "harness/mujoco/mujoco_errors.hpp"

#include <mutex>

#include <mujoco/mujoco.h>

namespace qsmpc::harness {
namespace {

thread_local MujocoTrap* innermost = nullptr;

// If a handler returned, MuJoCo would call exit().
void throw_error(const char* text) { throw MujocoError(text); }

}  // namespace

void MujocoTrap::collect(const char* text) {
  if (innermost != nullptr) innermost->warnings_.emplace_back(text);
}

MujocoTrap::MujocoTrap() : outer_(innermost) {
  // Once per process: MuJoCo reads the pointers without a lock, so they must not change while
  // another thread simulates.
  static std::once_flag installed;
  std::call_once(installed, [] {
    mju_user_error = throw_error;
    mju_user_warning = collect;
  });
  innermost = this;
}

MujocoTrap::~MujocoTrap() { innermost = outer_; }

}  // namespace qsmpc::harness
