// Where the program is that starts, watches and ends controllers outside of qsmpc.
#pragma once

#include <string>

namespace qsmpc::harness {

/// The path of qsmpc-host: the environment variable QSMPC_HOST where it is set, else beside the
/// running program, else ../libexec/qsmpc from there, else the build folder's. Throws IoError where
/// it is nowhere.
[[nodiscard]] std::string host_program();

}  // namespace qsmpc::harness
