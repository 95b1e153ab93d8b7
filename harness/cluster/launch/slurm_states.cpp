#include "harness/cluster/launch/slurm_states.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/text/number_parse.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kFields = 5;

/// From squeue(1), JOB STATE CODES; in all other states a task is not running yet or again.
struct SlurmWord {
  std::string_view word;
  TaskCondition condition;
};
constexpr std::array<SlurmWord, 16> kSlurmWords = {{
    {"RUNNING", TaskCondition::kRunning},
    {"COMPLETING", TaskCondition::kRunning},
    {"STAGE_OUT", TaskCondition::kRunning},
    {"SIGNALING", TaskCondition::kRunning},
    {"SUSPENDED", TaskCondition::kRunning},
    {"STOPPED", TaskCondition::kRunning},
    {"COMPLETED", TaskCondition::kDone},
    {"CANCELLED", TaskCondition::kCancelled},
    {"REVOKED", TaskCondition::kCancelled},
    {"FAILED", TaskCondition::kFailed},
    {"TIMEOUT", TaskCondition::kFailed},
    {"DEADLINE", TaskCondition::kFailed},
    {"OUT_OF_MEMORY", TaskCondition::kFailed},
    {"NODE_FAIL", TaskCondition::kLost},
    {"BOOT_FAIL", TaskCondition::kLost},
    {"PREEMPTED", TaskCondition::kLost},
}};

[[noreturn]] void refuse_answer(std::string_view line) {
  throw IoError(fmt::format("squeue: found {}, expected {} fields of a task",
                            printable(std::string(line)), kFields));
}

TaskState slurm_task(std::string_view line) {
  std::array<std::string_view, kFields> fields;
  std::string_view rest = line;
  for (std::string_view& field : fields) {
    const std::size_t end = rest.find('|');
    if (end == std::string_view::npos) refuse_answer(line);
    field = rest.substr(0, end);
    rest.remove_prefix(end + 1);
  }
  const auto& [number, word, node, reason, restarts] = fields;
  const auto task = parse_integer<int>(number);
  const auto count = parse_integer<int>(restarts);
  if (!task || !count || word.empty()) refuse_answer(line);
  const auto* const known = std::ranges::find(kSlurmWords, word, &SlurmWord::word);
  TaskState state{.task = *task, .where = std::string(node), .note = std::string(word)};
  if (known != kSlurmWords.end()) state.condition = known->condition;
  if (!reason.empty() && reason != "None") state.note += fmt::format(" ({})", reason);
  if (*count > 0) state.note += fmt::format(", restarts: {}", *count);
  return state;
}

}  // namespace

std::vector<TaskState> slurm_tasks(const std::string& answer) {
  std::vector<TaskState> states;
  std::string_view rest = answer;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (line.find_first_not_of(' ') != std::string_view::npos) states.push_back(slurm_task(line));
  }
  return states;
}

}  // namespace qsmpc::harness
