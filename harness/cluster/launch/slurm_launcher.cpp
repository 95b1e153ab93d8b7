#include "harness/cluster/launch/slurm_launcher.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "harness/cluster/launch/command.hpp"
#include "harness/cluster/launch/launch_record.hpp"
#include "harness/cluster/launch/slurm_script.hpp"
#include "harness/cluster/launch/slurm_states.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

/// The message of Slurm's commands about a job that ended some minutes ago.
constexpr const char* kUnknownJob = "Invalid job id";

/// Submits a script. Returns the job's number.
std::string submit(const std::vector<std::string>& options, const std::string& script) {
  std::vector<std::string> words{"sbatch", "--parsable"};
  words.insert(words.end(), options.begin(), options.end());
  words.push_back(script);
  const std::string answer = command_output(words);
  // JOB, or JOB;CLUSTER
  std::string job = answer.substr(0, answer.find_first_of(";\n"));
  if (job.empty() || job.find_first_not_of("0123456789") != std::string::npos) {
    throw IoError(fmt::format("sbatch: found {}, expected a job's number", printable(answer)));
  }
  return job;
}

/// Cancels a job unless it has ended. Throws IoError.
void cancel_job(const std::string& job) {
  const CommandResult result = run_command({"scancel", job});
  if (result.exit_code == 0 || result.errors.find(kUnknownJob) != std::string::npos) return;
  throw IoError(
      fmt::format("scancel {}: exit code {}: {}", job, result.exit_code, last_line(result.errors)));
}

std::map<int, TaskState> known_tasks(const std::string& job) {
  const std::vector<std::string> words{"squeue",
                                       "--noheader",
                                       "--array",
                                       "--states=all",
                                       "--jobs",
                                       job,
                                       std::string("--Format=") + kSqueueFormat};
  const CommandResult result = run_command(words);
  if (result.exit_code != 0 && result.errors.find(kUnknownJob) != std::string::npos) return {};
  if (result.exit_code != 0) {
    throw IoError(fmt::format("squeue --jobs {}: exit code {}: {}", job, result.exit_code,
                              last_line(result.errors)));
  }
  std::map<int, TaskState> tasks;
  for (TaskState& state : slurm_tasks(result.output)) {
    const int task = state.task;
    tasks.insert_or_assign(task, std::move(state));
  }
  return tasks;
}

/// The state of a task that Slurm has forgotten.
TaskState forgotten_task(const LaunchRecord& record, int task, bool cancelled) {
  if (auto end = read_task_end(record, task)) return *end;
  return {.task = task,
          .condition = cancelled ? TaskCondition::kCancelled : TaskCondition::kLost,
          .note = fmt::format("Slurm no longer knows job {}_{}, and it left no record of its end",
                              record.job, task)};
}

}  // namespace

std::string SlurmLauncher::start(const LaunchRequest& request) {
  LaunchRecord record{.kind = "slurm",
                      .launch = begin_launch(request.folder),
                      .folder = request.folder,
                      .tasks = request.tasks};
  const std::string scripts = request.folder + "/cluster/slurm";
  make_durable_folder(scripts, request.folder);
  const std::string worker = scripts + "/" + record.launch + ".sh";
  write_file(worker, worker_script(request, options_, record.launch));
  record.job = submit({}, worker);
  if (!request.gather.empty()) {
    try {
      const std::string gather = scripts + "/" + record.launch + "-gather.sh";
      write_file(gather, gather_script(request, options_));
      record.gather_job = submit({"--dependency=afterany:" + record.job}, gather);
    } catch (...) {
      // Without a record the array could not be found again.
      (void)run_command({"scancel", record.job});
      throw;
    }
  }
  return launch_record_text(record);
}

std::vector<TaskState> SlurmLauncher::states(const std::string& record_text) {
  const LaunchRecord record = launch_record_of(record_text);
  const bool cancelled = is_cancelled(record);
  std::map<int, TaskState> known = known_tasks(record.job);
  std::vector<TaskState> states;
  for (int task = 1; task <= record.tasks; ++task) {
    const auto found = known.find(task);
    if (found == known.end()) {
      states.push_back(forgotten_task(record, task, cancelled));
      continue;
    }
    TaskState state = std::move(found->second);
    if (state.condition == TaskCondition::kFailed) {
      if (const auto end = read_task_end(record, task)) state.note += ", " + end->note;
    }
    states.push_back(std::move(state));
  }
  return states;
}

void SlurmLauncher::cancel(const std::string& record_text) {
  const LaunchRecord record = launch_record_of(record_text);
  mark_cancelled(record);
  // First the job that would start once the array has ended.
  if (!record.gather_job.empty()) cancel_job(record.gather_job);
  cancel_job(record.job);
}

void SlurmLauncher::wait(const std::string& /*record*/, const std::function<bool()>& /*tick*/) {
  throw std::logic_error("waiting for workers that Slurm started");
}

}  // namespace qsmpc::harness
