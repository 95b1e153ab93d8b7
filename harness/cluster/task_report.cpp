#include "harness/cluster/task_report.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/cluster/lease_plan.hpp"
#include "harness/cluster/shared_files.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/text/json_text.hpp"
#include "harness/text/number_parse.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kReportFile = "task.json";
constexpr std::array kTaskWords{TaskWord::kWorking, TaskWord::kDone, TaskWord::kStopped,
                                TaskWord::kFailed};

TaskWord task_word_called(const std::string& name, const std::string& path) {
  for (const TaskWord word : kTaskWords) {
    if (name == task_word(word)) return word;
  }
  throw IoError(path + ": an unknown word: " + name);
}

TaskReport report_of(const std::string& text, const std::string& path) {
  try {
    const Json json = Json::parse(text);
    return {.holder = {.task = json.at("task"),
                       .start = json.at("start"),
                       .launch = json.at("launch"),
                       .host = json.at("host"),
                       .process = json.at("process")},
            .word = task_word_called(json.at("says"), path),
            .note = json.at("note"),
            .episodes = json.at("episodes"),
            .seconds = json.at("seconds"),
            .beat = json.at("beat")};
  } catch (const Json::exception& error) {
    throw IoError(path + ": cannot be read: " + error.what());
  }
}

std::optional<LeaseHolder> holder_named(std::string_view name) {
  const std::size_t dash = name.find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const auto task = parse_integer<int>(name.substr(0, dash));
  const auto start = parse_integer<int>(name.substr(dash + 1));
  if (!task || !start) return std::nullopt;
  return LeaseHolder{.task = *task, .start = *start};
}

std::optional<TaskReport> read_report(const std::string& folder, const LeaseHolder& holder) {
  const std::string path = task_folder(folder, holder) + "/" + kReportFile;
  const std::optional<std::string> text = read_shared_file(path);
  if (!text) return std::nullopt;
  return report_of(*text, path);
}

}  // namespace

const char* task_word(TaskWord word) {
  switch (word) {
    case TaskWord::kWorking:
      return "working";
    case TaskWord::kDone:
      return "done";
    case TaskWord::kStopped:
      return "stopped";
    case TaskWord::kFailed:
      return "failed";
  }
  throw std::invalid_argument("task: a word that has no name");
}

std::string task_folder(const std::string& folder, const LeaseHolder& holder) {
  return cluster_path(folder, kTasksFolder) + "/" + holder.name();
}

void make_task_folder(const std::string& folder, LeaseHolder& holder) {
  holder.start = 1;
  for (const std::string& name : names_in_folder(cluster_path(folder, kTasksFolder))) {
    const auto other = holder_named(name);
    if (other && other->task == holder.task)
      holder.start = std::max(holder.start, other->start + 1);
  }
  while (!create_shared_folder(task_folder(folder, holder))) ++holder.start;
}

void write_task_report(const std::string& folder, const TaskReport& report) {
  const LeaseHolder& holder = report.holder;
  const Json json = {{"task", holder.task},       {"start", holder.start},
                     {"launch", holder.launch},   {"host", holder.host},
                     {"process", holder.process}, {"says", task_word(report.word)},
                     {"note", report.note},       {"episodes", report.episodes},
                     {"seconds", report.seconds}, {"beat", report.beat}};
  write_file(task_folder(folder, holder) + "/" + kReportFile, json_text(json));
}

std::vector<TaskReport> task_reports(const std::string& folder) {
  std::vector<TaskReport> reports;
  for (const std::string& name : names_in_folder(cluster_path(folder, kTasksFolder))) {
    const std::optional<LeaseHolder> holder = holder_named(name);
    if (!holder) continue;
    if (auto report = read_report(folder, *holder)) reports.push_back(*std::move(report));
  }
  std::ranges::sort(reports, {}, [](const TaskReport& report) {
    return std::pair(report.holder.task, report.holder.start);
  });
  return reports;
}

std::vector<TaskReport> maybe_working(const std::vector<TaskReport>& reports, std::int64_t launch) {
  std::vector<TaskReport> working;
  std::ranges::copy_if(reports, std::back_inserter(working), [&](const TaskReport& report) {
    return report.word == TaskWord::kWorking && report.holder.launch >= launch;
  });
  return working;
}

std::vector<TaskReport> found_working(const std::string& folder, std::vector<TaskReport> suspects,
                                      std::chrono::steady_clock::duration patience,
                                      const std::function<void()>& sleep) {
  using Clock = std::chrono::steady_clock;
  std::vector<TaskReport> working;
  const Clock::time_point start = Clock::now();
  while (!suspects.empty() && Clock::now() - start < patience) {
    sleep();
    std::erase_if(suspects, [&](const TaskReport& suspect) {
      const std::optional<TaskReport> now = read_report(folder, suspect.holder);
      if (now && now->word == TaskWord::kWorking && now->beat == suspect.beat) return false;
      if (now && now->word == TaskWord::kWorking) working.push_back(*now);
      return true;
    });
  }
  return working;
}

}  // namespace qsmpc::harness
