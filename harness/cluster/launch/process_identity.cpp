#include "harness/cluster/launch/process_identity.hpp"

#include <array>
#include <climits>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

namespace qsmpc::harness {
namespace {

constexpr int kStartField = 22;  // 1-based field of /proc/PID/stat; see proc(5)
constexpr int kStateField = 3;

std::string host_name() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "unknown";
  return name.data();
}

std::string boot_name() {
  std::string boot;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> boot;
  std::error_code error;
  return boot + " " + std::filesystem::read_symlink("/proc/self/ns/pid", error).string();
}

/// The start time of the process `number`; nothing if it does not exist or is a zombie.
std::optional<std::int64_t> start_of(std::int64_t number) {
  std::ifstream file(fmt::format("/proc/{}/stat", number));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  // The name, in parentheses, may contain any character.
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return std::nullopt;
  std::istringstream fields(text.substr(name_end + 1));
  std::string field;
  for (int i = kStateField; fields >> field; ++i) {
    if (i == kStateField && (field == "Z" || field == "X")) return std::nullopt;
    if (i == kStartField) return std::stoll(field);
  }
  return std::nullopt;
}

}  // namespace

ProcessIdentity this_process() {
  return {.host = host_name(),
          .boot = boot_name(),
          .number = ::getpid(),
          .started = start_of(::getpid()).value_or(0)};
}

ProcessFate fate_of(const ProcessIdentity& process) {
  if (process.host != host_name()) return ProcessFate::kElsewhere;
  if (process.boot != boot_name()) return ProcessFate::kGone;
  return start_of(process.number) == process.started ? ProcessFate::kAlive : ProcessFate::kGone;
}

}  // namespace qsmpc::harness
