#include "harness/cluster/launch/process_launcher.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>

#include "harness/cluster/launch/launch_record.hpp"
#include "harness/cluster/launch/shell_words.hpp"
#include "harness/errors.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::chrono::milliseconds kTick{100};
// The folder is checked for cancellation by another process every this many ticks.
constexpr int kTicksPerLook = 10;
// Pause between connections to one host: sshd by default refuses more than ten unauthenticated
// ones.
constexpr std::chrono::milliseconds kBetweenConnections{200};
constexpr const char* kHere = ":";

constexpr int kSshFailed = 255;
constexpr int kInterrupted = 130;  // the worker's exit code after SIGTERM
constexpr int kSignalled = 128;    // + the signal's number

/// The end state of a task, from its exit code.
TaskState end_state(int task, const LaunchHost& host, int exit_code, bool told,
                    const std::string& words) {
  TaskState state{.task = task, .condition = TaskCondition::kFailed};
  const bool by_ssh = host.login != kHere;
  if (exit_code == 0) {
    state.condition = TaskCondition::kDone;
    return state;
  }
  if (by_ssh && exit_code == kSshFailed) {
    state.condition = told ? TaskCondition::kCancelled : TaskCondition::kLost;
    state.note = words.empty() ? "the connection failed" : words;
    return state;
  }
  if (told || exit_code == kInterrupted) state.condition = TaskCondition::kCancelled;
  if (exit_code > kSignalled && exit_code != kInterrupted) {
    const char* const name = ::sigdescr_np(exit_code - kSignalled);
    state.note = fmt::format("ended by signal {} ({})", exit_code - kSignalled,
                             name == nullptr ? "unknown" : name);
    return state;
  }
  state.note = fmt::format("exit code {}{}{}", exit_code, words.empty() ? "" : ": ", words);
  return state;
}

std::string host_of_task(const LaunchHost& host, const ProcessIdentity& conductor) {
  return host.login == kHere ? conductor.host : host.login;
}

/// The hosts of tasks 1, 2, …
std::vector<LaunchHost> hosts_by_task(const std::vector<LaunchHost>& hosts) {
  std::vector<LaunchHost> all;
  for (const LaunchHost& host : hosts)
    all.insert(all.end(), static_cast<std::size_t>(host.tasks), host);
  return all;
}

}  // namespace

std::vector<std::string> task_command(const ProcessLauncherOptions& options, const LaunchHost& host,
                                      const std::vector<std::string>& worker, int task) {
  std::vector<std::string> words = worker;
  if (host.login != kHere) words.front() = options.program;
  words.insert(words.end(), {"--task", std::to_string(task)});
  words = leashed(words);
  if (host.login == kHere) return words;
  std::vector<std::string> ssh{"ssh", "-T", "-a", "-x"};
  if (!options.ssh_config.empty()) ssh.insert(ssh.end(), {"-F", options.ssh_config});
  // ssh must not prompt, and must detect an unreachable machine within about a minute.
  for (const char* const option :
       {"BatchMode=yes", "ConnectTimeout=20", "ServerAliveInterval=15", "ServerAliveCountMax=4"}) {
    ssh.insert(ssh.end(), {"-o", option});
  }
  if (host.port != 0) ssh.insert(ssh.end(), {"-p", std::to_string(host.port)});
  ssh.insert(ssh.end(), {"--", host.login, "exec " + shell_command(words)});
  return ssh;
}

std::string ProcessLauncher::start(const LaunchRequest& request) {
  const std::vector<LaunchHost> hosts = hosts_by_task(options_.hosts);
  if (hosts.size() != static_cast<std::size_t>(request.tasks)) {
    throw std::logic_error("a request whose tasks differ from the launcher's");
  }
  LaunchRecord record{.kind = options_.kind,
                      .launch = begin_launch(request.folder),
                      .folder = request.folder,
                      .tasks = request.tasks,
                      .conductor = this_process()};
  for (const LaunchHost& host : hosts) {
    record.where.push_back(host_of_task(host, record.conductor));
  }
  processes_.clear();
  processes_.resize(hosts.size());
  // One connection to each host per round.
  for (int round = 0;; ++round) {
    std::size_t index = 0;
    bool started = false;
    bool connected = false;
    for (const LaunchHost& host : options_.hosts) {
      const std::size_t at = index + static_cast<std::size_t>(round);
      index += static_cast<std::size_t>(host.tasks);
      if (at >= index) continue;
      const int task = static_cast<int>(at) + 1;
      processes_[at] = std::make_unique<TaskProcess>(
          task_command(options_, host, request.worker, task), task_log_path(request.folder, task));
      started = true;
      connected = connected || host.login != kHere;
    }
    if (!started) break;
    if (connected) std::this_thread::sleep_for(kBetweenConnections);
  }
  return launch_record_text(record);
}

std::vector<TaskState> ProcessLauncher::states(const std::string& record_text) {
  const LaunchRecord record = launch_record_of(record_text);
  // Must come first: a conductor that is found gone has written all the ends that it will ever
  // write.
  const ProcessFate conductor = fate_of(record.conductor);
  const bool cancelled = is_cancelled(record);
  std::vector<TaskState> states;
  for (int task = 1; task <= record.tasks; ++task) {
    TaskState state{.task = task, .condition = TaskCondition::kRunning};
    if (const auto end = read_task_end(record, task)) {
      state = *end;
    } else if (conductor == ProcessFate::kGone) {
      state.condition = cancelled ? TaskCondition::kCancelled : TaskCondition::kLost;
      state.note = "the process that started it has ended, and the task with it";
    } else if (conductor == ProcessFate::kElsewhere) {
      state.note =
          fmt::format("unless the process on {} that started it has ended", record.conductor.host);
    } else if (cancelled) {
      state.note = "being stopped";
    }
    state.where = record.where[static_cast<std::size_t>(task) - 1];
    states.push_back(std::move(state));
  }
  return states;
}

void ProcessLauncher::cancel(const std::string& record_text) {
  mark_cancelled(launch_record_of(record_text));
}

void ProcessLauncher::wait(const std::string& record_text, const std::function<bool()>& tick) {
  const LaunchRecord record = launch_record_of(record_text);
  const std::vector<LaunchHost> hosts = hosts_by_task(options_.hosts);
  if (processes_.size() != static_cast<std::size_t>(record.tasks) ||
      record.conductor != this_process()) {
    throw std::logic_error("waiting for workers of another process");
  }
  bool told = false;
  for (int ticks = 0;; ++ticks) {
    bool any = false;
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      if (!processes_[i]) continue;
      any = true;
      const auto exit_code = processes_[i]->exit_code();
      if (!exit_code) continue;
      write_task_end(record, end_state(static_cast<int>(i) + 1, hosts[i], *exit_code, told,
                                       processes_[i]->last_words()));
      processes_[i].reset();
    }
    if (!any) return;
    const bool cancelled = ticks % kTicksPerLook == 0 && is_cancelled(record);
    const bool asked = !tick();
    told = told || cancelled || asked;
    for (const auto& process : processes_) {
      if (process && cancelled) process->end();
      if (process && asked) process->ask_to_end();
    }
    std::this_thread::sleep_for(kTick);
  }
}

}  // namespace qsmpc::harness
