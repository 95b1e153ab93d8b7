#include "harness/cli/output.hpp"

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "harness/errors.hpp"

namespace qsmpc::harness {

std::string default_folder(const std::string& name, const std::string& suffix) {
  std::string plain_name = name;
  for (char& c : plain_name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
    if (!plain) c = '_';
  }
  return "out/" + plain_name + "-" + suffix;
}

void print_result(const std::string& text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) {
    throw IoError("standard output: " + std::string(std::strerror(errno)));
  }
}

}  // namespace qsmpc::harness
