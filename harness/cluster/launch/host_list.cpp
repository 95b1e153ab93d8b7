#include "harness/cluster/launch/host_list.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "harness/cluster/launch/launch_options.hpp"
#include "harness/errors.hpp"
#include "harness/files/text_file.hpp"
#include "harness/text/number_parse.hpp"

namespace qsmpc::harness {
namespace {

constexpr int kMostPorts = 65535;

/// The place of a host, for error messages.
struct HostPlace {
  std::string file{};
  int line = 0;
};

[[noreturn]] void refuse_host(const HostPlace& place, std::string_view found,
                              const std::string& expected) {
  throw InputError({.file = place.file,
                    .line = place.line,
                    .key = "--on",
                    .found = std::string(found),
                    .expected = expected});
}

std::string_view trimmed_host(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/// Whether `text` is safe to pass to ssh as a login: not an option, no shell metacharacters.
bool is_login(std::string_view text) {
  const auto is_fine = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("._-@%[]:").find(c) != std::string_view::npos;
  };
  return !text.empty() && text.front() != '-' && text.back() != '@' &&
         std::ranges::all_of(text, is_fine);
}

LaunchHost parse_host(const HostPlace& place, std::string_view text) {
  constexpr const char* kExpected = "[N/][USER@]HOST[:PORT], or : for this machine";
  LaunchHost host;
  std::string_view rest = text;
  if (const std::size_t end = rest.find_first_of("/*"); end != std::string_view::npos) {
    const auto tasks = parse_integer<int>(rest.substr(0, end));
    if (!tasks || *tasks < 1 || *tasks > kMostTasks) {
      refuse_host(place, text, fmt::format("{} with 1 <= N <= {}", kExpected, kMostTasks));
    }
    host.tasks = *tasks;
    rest.remove_prefix(end + 1);
  }
  // A single colon precedes a port; several belong to an IPv6 address.
  if (const std::size_t colon = rest.find(':');
      rest.size() > 1 && colon != std::string_view::npos && colon == rest.rfind(':')) {
    const auto port = parse_integer<int>(rest.substr(colon + 1));
    if (!port || *port < 1 || *port > kMostPorts) refuse_host(place, text, kExpected);
    host.port = *port;
    rest = rest.substr(0, colon);
  }
  if (rest != ":" && !is_login(rest)) refuse_host(place, text, kExpected);
  host.login = rest;
  return host;
}

std::vector<LaunchHost> hosts_of_file(const std::string& file) {
  const std::string text = read_text_file(file);
  std::vector<LaunchHost> hosts;
  std::string_view rest = text;
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view content = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const std::string_view host = trimmed_host(content.substr(0, content.find('#')));
    if (!host.empty()) hosts.push_back(parse_host({.file = file, .line = line}, host));
  }
  if (hosts.empty()) refuse_host({.file = file}, "no host", "one host per line");
  return hosts;
}

std::vector<LaunchHost> hosts_of_list(std::string_view text) {
  std::vector<LaunchHost> hosts;
  for (std::string_view rest = text;;) {
    const std::size_t comma = rest.find(',');
    const std::string_view host = trimmed_host(rest.substr(0, comma));
    if (host.empty()) refuse_host({}, "ssh:" + std::string(text), "ssh:HOST[,HOST]… or ssh:@FILE");
    hosts.push_back(parse_host({}, host));
    if (comma == std::string_view::npos) return hosts;
    rest.remove_prefix(comma + 1);
  }
}

}  // namespace

std::vector<LaunchHost> parse_hosts(const std::string& text) {
  std::vector<LaunchHost> hosts =
      text.starts_with('@') ? hosts_of_file(text.substr(1)) : hosts_of_list(text);
  std::int64_t tasks = 0;
  for (const LaunchHost& host : hosts) tasks += host.tasks;
  if (tasks > kMostTasks) {
    refuse_host({}, fmt::format("{} workers", tasks), fmt::format("at most {}", kMostTasks));
  }
  return hosts;
}

}  // namespace qsmpc::harness
