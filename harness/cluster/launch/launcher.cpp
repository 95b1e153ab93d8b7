#include "harness/cluster/launch/launcher.hpp"

#include <string_view>

#include "harness/cluster/launch/host_list.hpp"
#include "harness/cluster/launch/launch_record.hpp"
#include "harness/cluster/launch/process_launcher.hpp"
#include "harness/cluster/launch/slurm_launcher.hpp"

namespace qsmpc::harness {

std::unique_ptr<Launcher> make_launcher(const LaunchOptions& options) {
  check_launch_options(options);
  if (options.on == "slurm") return std::make_unique<SlurmLauncher>(options);
  if (options.on == "local") {
    return std::make_unique<ProcessLauncher>(ProcessLauncherOptions{
        .kind = "local", .hosts = {{.login = ":", .tasks = launch_tasks(options)}}});
  }
  constexpr std::string_view kPrefix = "ssh:";
  return std::make_unique<ProcessLauncher>(
      ProcessLauncherOptions{.kind = "ssh",
                             .hosts = parse_hosts(options.on.substr(kPrefix.size())),
                             .program = options.program.empty() ? "qsmpc" : options.program,
                             .ssh_config = options.ssh_config});
}

std::unique_ptr<Launcher> launcher_of(const std::string& record) {
  const std::string kind = launch_record_of(record).kind;
  if (kind == "slurm") return std::make_unique<SlurmLauncher>(LaunchOptions{.on = kind});
  return std::make_unique<ProcessLauncher>(ProcessLauncherOptions{.kind = kind});
}

}  // namespace qsmpc::harness
