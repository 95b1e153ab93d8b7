// Asks a shared library with the C interface (controller/control/controller_abi.h) on behalf of the
// program, which is told lines of JSON as every other controller outside of it.
#pragma once

#include <string>

namespace qsmpc::harness {

/// Reads messages from `input` and writes answers to `output`, two open descriptors, until the
/// program has nothing more to ask. Returns the exit code of the process.
int serve_library(const std::string& path, int input, int output);

}  // namespace qsmpc::harness
