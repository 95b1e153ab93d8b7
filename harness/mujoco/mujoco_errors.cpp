#include "harness/mujoco/mujoco_errors.hpp"

#include <mutex>

#include <mujoco/mujoco.h>

namespace qsmpc::harness {
namespace {

thread_local MujocoTrap* innermost = nullptr;

// A handler that returned would let MuJoCo go on to exit().
void throw_error(const char* text) { throw MujocoError(text); }

}  // namespace

void MujocoTrap::collect(const char* text) {
  if (innermost != nullptr) innermost->warnings_.emplace_back(text);
}

MujocoTrap::MujocoTrap() : outer_(innermost) {
  // Once in a process: MuJoCo reads the pointers without a lock, so that they must not change while
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
