#include "harness/cluster/cluster_status.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/cluster/lease_plan.hpp"
#include "harness/cluster/lease_queue.hpp"
#include "harness/errors.hpp"
#include "harness/text/json_text.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

/// The report of the last start of each task in `launch`.
std::vector<TaskReport> last_reports(const std::string& folder, std::int64_t launch) {
  std::map<int, TaskReport> last;
  for (TaskReport& report : task_reports(folder)) {
    if (report.holder.launch == launch) last[report.holder.task] = std::move(report);
  }
  std::vector<TaskReport> reports;
  reports.reserve(last.size());
  for (auto& [task, report] : last) reports.push_back(std::move(report));
  return reports;
}

void ask_launcher(ClusterStatus& status) {
  if (!status.launch || status.launch->record.empty()) return;
  try {
    status.states = launcher_of(status.launch->record)->states(status.launch->record);
  } catch (const std::exception& error) {
    status.trouble = error.what();
  }
}

const TaskState* state_of(const ClusterStatus& status, int task) {
  const auto found = std::ranges::find(status.states, task, &TaskState::task);
  return found == status.states.end() ? nullptr : &*found;
}

/// Whether a task is at work, as far as the launcher knows.
bool is_at_work(const ClusterStatus& status, const TaskReport& report) {
  if (report.word != TaskWord::kWorking) return false;
  const TaskState* state = state_of(status, report.holder.task);
  return state == nullptr || state->condition == TaskCondition::kRunning;
}

/// Total episodes per second of the tasks at work, each by its own clock.
double rate_of(const ClusterStatus& status) {
  double rate = 0.0;
  for (const TaskReport& report : status.tasks) {
    if (is_at_work(status, report) && report.seconds > 0.0) {
      rate += static_cast<double>(report.episodes) / report.seconds;
    }
  }
  return rate;
}

std::string report_text(const TaskReport& report) {
  std::string text = fmt::format("{}, {} episodes", task_word(report.word), report.episodes);
  if (report.seconds > 0.0) text += " in " + duration_text(report.seconds);
  if (report.holder.start > 1) text += fmt::format(", start {}", report.holder.start);
  if (!report.note.empty()) text += ": " + printable(report.note, 200);
  return text;
}

std::string state_text(const TaskState& state) {
  std::string text = task_condition_name(state.condition);
  if (!state.where.empty()) text += " on " + printable(state.where);
  if (!state.note.empty()) text += " (" + printable(state.note, 200) + ")";
  return text;
}

std::set<int> all_tasks(const ClusterStatus& status) {
  std::set<int> tasks;
  for (const TaskState& state : status.states) tasks.insert(state.task);
  for (const TaskReport& report : status.tasks) tasks.insert(report.holder.task);
  return tasks;
}

const TaskReport* report_of_task(const ClusterStatus& status, int task) {
  const auto found = std::ranges::find(status.tasks, task,
                                       [](const TaskReport& report) { return report.holder.task; });
  return found == status.tasks.end() ? nullptr : &*found;
}

Json task_json(const ClusterStatus& status, int task) {
  Json json = {{"task", task}};
  const TaskState* state = state_of(status, task);
  json["condition"] = nullptr;
  json["where"] = nullptr;
  json["launcher_note"] = nullptr;
  if (state != nullptr) {
    json["condition"] = task_condition_name(state->condition);
    json["where"] = state->where;
    json["launcher_note"] = state->note;
  }
  const TaskReport* report = report_of_task(status, task);
  json["says"] = nullptr;
  if (report == nullptr) return json;
  json["says"] = task_word(report->word);
  json["note"] = report->note;
  json["start"] = report->holder.start;
  json["host"] = report->holder.host;
  json["process"] = report->holder.process;
  json["episodes"] = report->episodes;
  json["seconds"] = report->seconds;
  return json;
}

}  // namespace

void FinishedEpisodes::look(const std::string& folder) {
  for (const std::int64_t lease : finished_leases(folder)) {
    if (!leases_.insert(lease).second) continue;
    for (const SeedOutcomes& seed : finished_outcomes(folder, lease)) {
      for (const std::string& outcome : seed.outcomes) ++outcomes_[outcome];
      count_ += std::ssize(seed.outcomes);
    }
  }
}

ClusterStatus cluster_status(const std::string& folder) {
  const LeasePlan plan = read_lease_plan(folder);
  ClusterStatus status{.campaign = {.campaign = plan.identity.campaign}, .leases = plan.leases()};
  for (const LeaseClaim& claim : open_claims(folder)) {
    ++(claim.given_back ? status.given_back : status.held);
  }
  FinishedEpisodes finished;
  finished.look(folder);
  status.finished = finished.leases();
  status.free =
      std::max<std::int64_t>(0, status.leases - status.finished - status.held - status.given_back);
  status.launch = read_task_launch(folder);
  status.tasks = last_reports(folder, status.launch ? status.launch->launch : 0);
  ask_launcher(status);
  CampaignStatus& campaign = status.campaign;
  campaign.done = finished.count();
  campaign.outcomes = finished.outcomes();
  campaign.running = lock_holder(folder + "/" + kClusterFolder);
  campaign.rate = rate_of(status);
  if (campaign.rate > 0.0) {
    campaign.left = static_cast<double>(campaign.campaign.episodes - campaign.done) / campaign.rate;
  }
  return status;
}

std::string cluster_status_table(const ClusterStatus& status) {
  std::string text = done_text(status.campaign);
  if (status.campaign.rate > 0.0) text += rate_text(status.campaign);
  text += fmt::format("  leases    {}: {} finished, {} held, {} given back, {} free\n",
                      status.leases, status.finished, status.held, status.given_back, status.free);
  if (status.launch) {
    text += fmt::format("  launch    {}: --on {}\n", status.launch->launch,
                        printable(launch_options_from_text(status.launch->options).on, 200));
  }
  if (!status.trouble.empty()) text += "  trouble   " + printable(status.trouble, 400) + "\n";
  for (const int task : all_tasks(status)) {
    const TaskState* state = state_of(status, task);
    const TaskReport* report = report_of_task(status, task);
    text += fmt::format("  task {:<4} {}{}{}\n", task, state == nullptr ? "" : state_text(*state),
                        state != nullptr && report != nullptr ? "; says " : "",
                        report == nullptr ? "" : report_text(*report));
  }
  return text;
}

std::string cluster_status_json(const ClusterStatus& status) {
  Json json = Json::parse(status_json(status.campaign));
  Json tasks = Json::array();
  for (const int task : all_tasks(status)) tasks.push_back(task_json(status, task));
  Json& cluster = json["cluster"];
  cluster["on"] = nullptr;
  cluster["launch"] = nullptr;
  if (status.launch) {
    cluster["on"] = launch_options_from_text(status.launch->options).on;
    cluster["launch"] = status.launch->launch;
  }
  cluster["leases"] = {{"total", status.leases},
                       {"finished", status.finished},
                       {"held", status.held},
                       {"given_back", status.given_back},
                       {"free", status.free}};
  cluster["trouble"] = nullptr;
  if (!status.trouble.empty()) cluster["trouble"] = status.trouble;
  cluster["tasks"] = std::move(tasks);
  return json_text(json);
}

}  // namespace qsmpc::harness
