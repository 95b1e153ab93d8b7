#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/files/file_group.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/trace/trace_csv.hpp"
#include "harness/trace/trace_file.hpp"

namespace qsmpc::harness {
namespace {

struct ExportArguments {
  std::string folder;
  std::string out;
  bool particles = false;
};

int export_episode(const ExportArguments& arguments) {
  const Trace trace = read_folder(arguments.folder);
  const EpisodeView view(trace);
  const std::string folder = arguments.out.empty() ? arguments.folder : arguments.out;
  make_output_folder(folder);
  FileGroup files;
  files.add(folder + "/episode.csv").write(episode_csv(view));
  files.add(folder + "/plan.csv").write(plan_csv(view));
  if (!controller::moving_obstacles(view.scenario().safe_set).empty()) {
    files.add(folder + "/obstacles.csv").write(obstacles_csv(view));
  }
  if (arguments.particles) files.add(folder + "/particles.csv").write(particles_csv(view));
  std::string paths;
  for (const std::string& path : files.paths()) paths += path + "\n";
  files.commit();
  print_result(paths);
  return kDone;
}

}  // namespace

void add_export_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("export",
                         "Writes an episode as CSV: episode.csv, plan.csv, obstacles.csv if "
                         "obstacles move and, on request, particles.csv.");
  command->footer("Example: qsmpc export out/dubins_obstacles-0 --particles");
  const auto arguments = std::make_shared<ExportArguments>();
  command->add_option("folder", arguments->folder, "folder of an episode")->required();
  command->add_option("--out", arguments->out, "output folder; default: the episode's");
  command->add_flag("--particles", arguments->particles,
                    "also write the particles of all stages of all plans (many lines)");
  command->callback([arguments, &exit_code] { exit_code = export_episode(*arguments); });
}

}  // namespace qsmpc::harness
