#include "harness/cli/output.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "harness/errors.hpp"

namespace qsmpc {

void print_result(const std::string& text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) {
    throw IoError("standard output: " + std::string(std::strerror(errno)));
  }
}

}  // namespace qsmpc
