// Serves a shared library with the C interface (controller/control/controller_abi.h), so that the
// program talks to it in lines of JSON as to every other controller outside it.
#pragma once

#include <string>

namespace qsmpc::harness {

/// Reads messages from `input` and writes answers to `output`, two open descriptors, until the
/// program sends no more. Returns the process's exit code.
int serve_library(const std::string& path, int input, int output);

}  // namespace qsmpc::harness
