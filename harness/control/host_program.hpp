// The location of the program that starts, watches and ends controllers outside qsmpc.
#pragma once

#include <string>

namespace qsmpc::harness {

/// The path of qsmpc-host: the environment variable QSMPC_HOST if set, else beside the running
/// program, else ../libexec/qsmpc relative to it, else in the build folder. Throws IoError if it is
/// in none of these places.
[[nodiscard]] std::string host_program();

}  // namespace qsmpc::harness
