#include "harness/cli/output.hpp"

#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <iostream>

#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/text/fnv1a.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kLongestWarning = 2000;  // bytes

}  // namespace

std::string default_folder(const std::string& name, const std::string& suffix,
                           const std::vector<std::string>& overrides) {
  std::string plain_name = name;
  for (char& c : plain_name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
    if (!plain) c = '_';
  }
  std::string folder = "out/" + plain_name + "-" + suffix;
  if (plain_name == name && overrides.empty()) return folder;
  Fnv1a<std::uint32_t> digest;  // gives the same command the same folder on every machine
  digest.add(name);
  for (const std::string& override : overrides) digest.add('\0' + override);
  return fmt::format("{}-{:08x}", folder, digest.value());
}

void print_result(const std::string& text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0) {
    throw IoError("standard output: " + std::string(std::strerror(errno)));
  }
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    std::cerr << "qsmpc: warning: " << printable(warning, kLongestWarning) << '\n';
  }
}

}  // namespace qsmpc::harness
