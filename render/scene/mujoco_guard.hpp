// Keeps MuJoCo from writing MUJOCO_LOG.TXT and from waiting for a key when something goes wrong.
#pragma once

namespace qsmpc::render {

/// Installs MuJoCo's process-wide handlers where there are none yet: an error then throws
/// std::runtime_error, a warning is dropped. Handlers that another room has set are kept.
/// Thread-safe.
void install_mujoco_guard();

}  // namespace qsmpc::render
