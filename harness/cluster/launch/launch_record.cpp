#include "harness/cluster/launch/launch_record.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/files/text_file.hpp"
#include "harness/text/json_text.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<TaskCondition, const char*>, 6> kConditions = {
    {{TaskCondition::kWaiting, "waiting"},
     {TaskCondition::kRunning, "running"},
     {TaskCondition::kDone, "done"},
     {TaskCondition::kFailed, "failed"},
     {TaskCondition::kCancelled, "cancelled"},
     {TaskCondition::kLost, "lost"}}};

constexpr const char* kCancelledName = "cancelled";

std::string end_path(const LaunchRecord& record, int task) {
  return ends_folder(record.folder, record.launch) + "/" + std::to_string(task);
}

std::string cancelled_path(const LaunchRecord& record) {
  return ends_folder(record.folder, record.launch) + "/" + kCancelledName;
}

}  // namespace

const char* task_condition_name(TaskCondition condition) {
  return std::ranges::find(kConditions, condition, &decltype(kConditions)::value_type::first)
      ->second;
}

std::string task_log_path(const std::string& folder, int task) {
  return fmt::format("{}/cluster/log/{}.out", folder, task);
}

std::string launch_record_text(const LaunchRecord& record) {
  nlohmann::ordered_json json = {{"kind", record.kind},
                                 {"launch", record.launch},
                                 {"folder", record.folder},
                                 {"tasks", record.tasks}};
  if (record.kind == "slurm") {
    json["job"] = record.job;
    json["gather_job"] = record.gather_job;
  } else {
    json["where"] = record.where;
    json["conductor"] = {{"host", record.conductor.host},
                         {"boot", record.conductor.boot},
                         {"number", record.conductor.number},
                         {"started", record.conductor.started}};
  }
  return compact_json_text(json);
}

LaunchRecord launch_record_of(const std::string& text) {
  const auto refuse = [&text] {
    throw InputError({.found = text, .expected = "the record of a launch"});
  };
  LaunchRecord record;
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    json.at("kind").get_to(record.kind);
    json.at("launch").get_to(record.launch);
    json.at("folder").get_to(record.folder);
    json.at("tasks").get_to(record.tasks);
    if (record.kind == "slurm") {
      json.at("job").get_to(record.job);
      json.at("gather_job").get_to(record.gather_job);
    } else {
      json.at("where").get_to(record.where);
      const nlohmann::json& conductor = json.at("conductor");
      conductor.at("host").get_to(record.conductor.host);
      conductor.at("boot").get_to(record.conductor.boot);
      conductor.at("number").get_to(record.conductor.number);
      conductor.at("started").get_to(record.conductor.started);
    }
  } catch (const nlohmann::json::exception&) {
    refuse();
  }
  const bool here = record.kind == "local" || record.kind == "ssh";
  if (!here && record.kind != "slurm") refuse();
  if (record.tasks < 1 || record.tasks > kMostTasks) refuse();
  if (here && record.where.size() != static_cast<std::size_t>(record.tasks)) refuse();
  return record;
}

std::string begin_launch(const std::string& folder) {
  make_durable_folder(folder + "/cluster/log", folder);
  make_durable_folder(folder + "/cluster/ends", folder);
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  for (int attempt = 0;; ++attempt) {
    std::string name = fmt::format("{:%Y%m%dT%H%M%S}-{}-{}", fmt::gmtime(now), ::getpid(), attempt);
    const std::string path = ends_folder(folder, name);
    std::error_code error;
    if (fs::create_directory(path, error)) return name;
    if (error) throw IoError(fmt::format("{}: {}", path, error.message()));
  }
}

std::string ends_folder(const std::string& folder, const std::string& launch) {
  return folder + "/cluster/ends/" + launch;
}

void write_task_end(const LaunchRecord& record, const TaskState& end) {
  write_file(end_path(record, end.task),
             fmt::format("{} {}\n", task_condition_name(end.condition), end.note));
}

std::optional<TaskState> read_task_end(const LaunchRecord& record, int task) {
  const std::string path = end_path(record, task);
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  const std::string text = read_text_file(path);
  const std::string line = text.substr(0, text.find('\n'));
  const std::size_t space = std::min(line.find(' '), line.size());
  const std::string word = line.substr(0, space);
  const auto* const found = std::ranges::find_if(
      kConditions, [&word](const auto& condition) { return word == condition.second; });
  if (found == kConditions.end()) {
    throw InputError({.file = path, .line = 1, .found = word, .expected = "how a task ended"});
  }
  return TaskState{.task = task,
                   .condition = found->first,
                   .note = line.substr(std::min(space + 1, line.size()))};
}

void mark_cancelled(const LaunchRecord& record) { write_file(cancelled_path(record), ""); }

bool is_cancelled(const LaunchRecord& record) {
  std::error_code error;
  return fs::exists(cancelled_path(record), error);
}

}  // namespace qsmpc::harness
