#include "harness/cluster/launch/launch_options.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <regex>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/cluster/launch/host_list.hpp"
#include "harness/errors.hpp"
#include "harness/files/text_file.hpp"
#include "harness/text/json_text.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSshPrefix = "ssh:";

[[noreturn]] void refuse_option(const char* option, const std::string& found,
                                const std::string& expected) {
  throw InputError({.key = option, .found = found, .expected = expected});
}

bool is_ssh(const LaunchOptions& options) { return options.on.starts_with(kSshPrefix); }

std::string hosts_text(const LaunchOptions& options) {
  return options.on.substr(kSshPrefix.size());
}

/// An option and the kinds that have it.
struct KindOption {
  const char* name;
  std::string value;  ///< empty: not given
  std::string_view kinds;
};

void check_kind(const LaunchOptions& options) {
  const std::string kind = is_ssh(options) ? "ssh" : options.on;
  if (kind != "local" && kind != "slurm" && kind != "ssh") {
    refuse_option("--on", options.on, "local, ssh:HOSTS, ssh:@FILE or slurm");
  }
  const auto number = [](int value) { return value == 0 ? "" : std::to_string(value); };
  const std::array<KindOption, 8> all = {
      {{"--tasks", number(options.tasks), "local slurm"},
       {"--tasks-at-once", number(options.tasks_at_once), "slurm"},
       {"--partition", options.partition, "slurm"},
       {"--time", options.time, "slurm"},
       {"--account", options.account, "slurm"},
       {"--sbatch", options.sbatch_file, "slurm"},
       {"--program", options.program, "slurm ssh"},
       {"--ssh-config", options.ssh_config, "ssh"}}};
  for (const auto& [name, value, kinds] : all) {
    if (value.empty() || kinds.find(kind) != std::string_view::npos) continue;
    if (std::string_view(name) == "--tasks") {
      refuse_option(name, value, "none with --on ssh; N/HOST starts N workers on HOST");
    }
    refuse_option(name, value, fmt::format("none with --on {}", kind));
  }
}

void check_number(const char* option, int value) {
  if (value >= 0 && value <= kMostTasks) return;
  refuse_option(option, std::to_string(value), fmt::format("1 … {}", kMostTasks));
}

/// Refuses values that cannot be inserted verbatim into a line "#SBATCH --NAME=VALUE".
void check_slurm_word(const char* option, const std::string& value) {
  static const std::regex names("[A-Za-z0-9_.:@+-]+(,[A-Za-z0-9_.:@+-]+)*");
  if (!value.empty() && !std::regex_match(value, names)) {
    refuse_option(option, value, "names as used by Slurm, separated by commas");
  }
}

void check_time(const std::string& time) {
  static const std::regex times(
      R"(\d{1,7}(:\d{1,2}){0,2}|\d{1,5}-\d{1,2}(:\d{1,2}){0,2}|infinite|unlimited)",
      std::regex::icase);
  if (!time.empty() && !std::regex_match(time, times)) {
    refuse_option("--time", time, "MINUTES, H:MM:SS, DAYS-H, DAYS-H:MM:SS or unlimited");
  }
}

/// Options of sbatch that the launcher sets itself.
constexpr std::array<std::string_view, 19> kOwnOptions = {
    "-a",       "--array", "-o",           "--output",   "-e",
    "--error",  "-d",      "--dependency", "-J",         "--job-name",
    "-i",       "--input", "--open-mode",  "--requeue",  "--no-requeue",
    "--signal", "--wrap",  "--parsable",   "--test-only"};

void check_sbatch_line(const std::string& file, int number, const std::string& line) {
  static const std::regex form(R"(#SBATCH\s+(-[A-Za-z]|--[a-z][a-z0-9-]*).*)");
  std::smatch parts;
  const auto refuse = [&](const std::string& found, const std::string& expected) {
    throw InputError(
        {.file = file, .line = number, .key = "--sbatch", .found = found, .expected = expected});
  };
  if (!std::regex_match(line, parts, form)) {
    refuse(line, "#SBATCH --OPTION[=VALUE], # and a comment, or nothing");
  }
  const std::string option = parts[1].str();
  if (std::ranges::find(kOwnOptions, option) != kOwnOptions.end()) {
    refuse(option, "an option that qsmpc does not set itself");
  }
}

std::string absolute_path(const std::string& path) {
  return path.empty() ? path : fs::absolute(path).lexically_normal().string();
}

}  // namespace

void check_launch_options(const LaunchOptions& options) {
  check_kind(options);
  check_number("--tasks", options.tasks);
  check_number("--tasks-at-once", options.tasks_at_once);
  check_slurm_word("--partition", options.partition);
  check_slurm_word("--account", options.account);
  check_time(options.time);
  for (const std::string& line : options.sbatch_lines) {
    check_sbatch_line(options.sbatch_file, 0, line);
  }
  if (is_ssh(options)) (void)parse_hosts(hosts_text(options));
  if (!options.ssh_config.empty()) (void)read_text_file(options.ssh_config);
}

int launch_tasks(const LaunchOptions& options) {
  check_launch_options(options);
  if (!is_ssh(options)) return std::max(1, options.tasks);
  int tasks = 0;
  for (const LaunchHost& host : parse_hosts(hosts_text(options))) tasks += host.tasks;
  return tasks;
}

std::vector<std::string> read_sbatch_lines(const std::string& file) {
  const std::string text = read_text_file(file);
  std::vector<std::string> lines;
  std::size_t begin = 0;
  for (int number = 1; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    line.erase(line.find_last_not_of(" \t\r") + 1);
    const bool is_comment = line.starts_with('#') && !line.starts_with("#SBATCH");
    if (line.empty() || is_comment) continue;
    check_sbatch_line(file, number, line);
    lines.push_back(std::move(line));
  }
  return lines;
}

std::string launch_options_text(const LaunchOptions& options) {
  std::string on = options.on;
  if (on.starts_with("ssh:@")) on = "ssh:@" + absolute_path(on.substr(5));
  return compact_json_text({{"on", on},
                            {"tasks", options.tasks},
                            {"tasks_at_once", options.tasks_at_once},
                            {"partition", options.partition},
                            {"time", options.time},
                            {"account", options.account},
                            {"sbatch_file", absolute_path(options.sbatch_file)},
                            {"sbatch_lines", options.sbatch_lines},
                            {"program", options.program},
                            {"ssh_config", absolute_path(options.ssh_config)}});
}

LaunchOptions launch_options_from_text(const std::string& text) {
  LaunchOptions options;
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    json.at("on").get_to(options.on);
    json.at("tasks").get_to(options.tasks);
    json.at("tasks_at_once").get_to(options.tasks_at_once);
    json.at("partition").get_to(options.partition);
    json.at("time").get_to(options.time);
    json.at("account").get_to(options.account);
    json.at("sbatch_file").get_to(options.sbatch_file);
    json.at("sbatch_lines").get_to(options.sbatch_lines);
    json.at("program").get_to(options.program);
    json.at("ssh_config").get_to(options.ssh_config);
  } catch (const nlohmann::json::exception&) {
    throw InputError({.found = text, .expected = "the options of a launcher in JSON"});
  }
  return options;
}

}  // namespace qsmpc::harness
