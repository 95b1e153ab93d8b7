#include "render/scene/mujoco_guard.hpp"

#include <mutex>
#include <stdexcept>
#include <string>

#include <mujoco/mujoco.h>

namespace qsmpc::render {
namespace {

void throw_error(const char* message) {
  throw std::runtime_error(std::string("MuJoCo: ") + message);
}

void drop_warning(const char* /*message*/) {}

}  // namespace

void install_mujoco_guard() {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  if (mju_user_error == nullptr) {
    mju_user_error = throw_error;
  }
  if (mju_user_warning == nullptr) {
    mju_user_warning = drop_warning;
  }
}

}  // namespace qsmpc::render
