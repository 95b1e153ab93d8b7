// Keeps MuJoCo from writing MUJOCO_LOG.TXT and from waiting for a key on errors.
#pragma once

namespace qsmpc::render {

/// Installs MuJoCo's process-wide handlers if there are none yet: an error then throws
/// std::runtime_error, a warning is dropped. Handlers set by other folders are kept. Thread-safe.
void install_mujoco_guard();

}  // namespace qsmpc::render
