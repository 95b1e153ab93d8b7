#include "harness/cluster/launch/slurm_script.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "harness/cluster/launch/launch_record.hpp"
#include "harness/cluster/launch/shell_words.hpp"
#include "harness/errors.hpp"

namespace qsmpc::harness {
namespace {

// The script gets SIGTERM 60 s before the time limit, so that the worker can finish its episodes.
constexpr const char* kWarning = "B:TERM@60";

// SIGTERM is forwarded, even if it arrives before the worker exists or handles signals. A `wait`
// interrupted by it does not mean that the worker has ended.
constexpr const char* kWorkerBody = R"(
told=
worker=
trap 'told=1; [ -z "$worker" ] || kill -s TERM "$worker"' TERM
rm -f "$end"
{} --task "$SLURM_ARRAY_TASK_ID" </dev/null &
worker=$!
[ -z "$told" ] || kill -s TERM "$worker"
wait "$worker"
status=$?
while [ -n "$told" ]; do
  told=
  wait "$worker"
  status=$?
done
case $status in
  0) word="done" ;;
  130 | 143) word="cancelled exit code $status" ;;
  *) word="failed exit code $status" ;;
esac
echo "$word" >"$end.partial" && mv "$end.partial" "$end"
exit "$status"
)";

/// A folder's name inside "#SBATCH --NAME="…"", where % begins a replacement pattern and a
/// backslash disables all of them.
std::string sbatch_path(const std::string& folder) {
  const auto is_bad = [](char c) {
    return c == '"' || c == '\\' || static_cast<unsigned char>(c) < 0x20U || c == 0x7f;
  };
  if (std::ranges::any_of(folder, is_bad)) {
    throw InputError({.file = folder,
                      .found = "a quote, a backslash or a control character in the folder's name",
                      .expected = "a name that Slurm accepts"});
  }
  std::string text;
  for (const char c : folder) text += c == '%' ? "%%" : std::string(1, c);
  return text;
}

/// The name of the job: that of the campaign's folder, with unsuitable characters replaced.
std::string job_name(const std::string& folder) {
  std::string name = "qsmpc-";
  for (const char c : std::filesystem::path(folder).filename().string()) {
    const bool is_fine = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                         (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
    name += is_fine ? c : '_';
  }
  return name;
}

std::string sbatch_lines_of(const std::string& folder, const LaunchOptions& options,
                            const std::string& name, const std::string& log) {
  const std::string path = sbatch_path(folder);
  std::string text = fmt::format(
      "#SBATCH --job-name={}\n"
      "#SBATCH --chdir=\"{}\"\n"
      "#SBATCH --output=\"{}/cluster/log/{}.out\"\n"
      "#SBATCH --open-mode=append\n"
      "#SBATCH --requeue\n"
      "#SBATCH --nodes=1\n"
      "#SBATCH --ntasks=1\n",
      name, folder, path, log);
  if (!options.partition.empty())
    text += fmt::format("#SBATCH --partition={}\n", options.partition);
  if (!options.time.empty()) text += fmt::format("#SBATCH --time={}\n", options.time);
  if (!options.account.empty()) text += fmt::format("#SBATCH --account={}\n", options.account);
  for (const std::string& line : options.sbatch_lines) text += line + "\n";
  return text;
}

std::vector<std::string> with_program(std::vector<std::string> words,
                                      const LaunchOptions& options) {
  if (!options.program.empty()) words.front() = options.program;
  return words;
}

}  // namespace

std::string worker_script(const LaunchRequest& request, const LaunchOptions& options,
                          const std::string& launch) {
  std::string text =
      "#!/bin/bash\n"
      "# A task of a campaign: drives episodes until none is left. Written by qsmpc.\n";
  text += fmt::format("#SBATCH --array=1-{}{}\n", request.tasks,
                      options.tasks_at_once == 0 ? "" : fmt::format("%{}", options.tasks_at_once));
  text += fmt::format("#SBATCH --cpus-per-task={}\n#SBATCH --signal={}\n", request.jobs, kWarning);
  text += sbatch_lines_of(request.folder, options, job_name(request.folder), "%a");
  text += fmt::format("\nend={}/\"$SLURM_ARRAY_TASK_ID\"",
                      shell_command({ends_folder(request.folder, launch)}));
  text +=
      fmt::format(fmt::runtime(kWorkerBody), shell_command(with_program(request.worker, options)));
  return text;
}

std::string gather_script(const LaunchRequest& request, const LaunchOptions& options) {
  std::string text =
      "#!/bin/bash\n"
      "# Runs after the tasks of a campaign: joins their episodes and writes the page. Written "
      "by qsmpc.\n"
      "#SBATCH --cpus-per-task=1\n";
  text += sbatch_lines_of(request.folder, options, job_name(request.folder) + "-gather", "gather");
  text += fmt::format("\nexec {}\n", shell_command(with_program(request.gather, options)));
  return text;
}

}  // namespace qsmpc::harness
