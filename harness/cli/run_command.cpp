#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/cli/artefacts.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/fail_on.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/output.hpp"
#include "harness/cli/progress.hpp"
#include "harness/cli/result_folder.hpp"
#include "harness/cli/scenario_arguments.hpp"
#include "harness/doctor/diagnosis.hpp"
#include "harness/episode/episode.hpp"
#include "harness/episode/trace_header.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/plant/plant_check.hpp"
#include "harness/scenario/certificate_scope.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/scenario_warnings.hpp"
#include "harness/text/printable.hpp"
#include "harness/trace/summary.hpp"
#include "harness/trace/trace_file.hpp"
#include "harness/trace/trace_writer.hpp"
#include "harness/video/episode_painter.hpp"
#include "render/gl/gl_library.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kRunHelp =
    "Runs one closed-loop episode and writes episode.h5, summary.json, scenario.yaml, episode.mp4\n"
    "and report.html.";
constexpr const char* kRunExample =
    "Example: qsmpc run dubins_obstacles --seed 3 --set controller.horizon=10 --out out/ten";

struct RunArguments {
  std::string scenario;
  std::vector<std::string> overrides;
  std::optional<std::uint64_t> seed;
  std::string out;
  bool force = false;
  bool video = true;
  std::string gl = "auto";
  bool verbose = false;
  bool quiet = false;
  bool json = false;
  std::vector<std::string> fail_on = {"collision", "left_bounds", "fault"};
};

Trace drive(const Scenario& scenario, std::uint64_t seed, const std::string& folder, bool quiet) {
  TraceWriter writer(folder + "/" + kTraceFile, trace_header(scenario, seed));
  Progress progress("driving", quiet);
  const char* certified = why_no_bound(scenario).empty() ? "P(unsafe next) <=" : "next, NO BOUND:";
  EpisodeOptions options;
  options.seed = seed;
  options.writer = &writer;
  options.should_stop = [] { return interrupts() > 0; };
  options.on_step = [&](const Trace& trace) {
    const StepRecord& step = trace.steps.back();
    progress.update(static_cast<int>(trace.steps.size()), scenario.step_limit,
                    fmt::format("t = {:.1f} s, solved in {:.0f} ms, {} {:.2g}", step.time,
                                step.timing.total, certified, step.certificates.front().value));
  };
  return run_episode(scenario, options);
}

bool asked_to_tell(const std::vector<std::string>& fail_on, const Summary& summary) {
  return std::any_of(fail_on.begin(), fail_on.end(), [&](const std::string& name) {
    return name == summary.outcome || (name == kFailOnUnsafe && summary.collision) ||
           (name == kFailOnRiskExceeded && summary.risk.exceeded_periods > 0);
  });
}

int run(const RunArguments& arguments) {
  Scenario scenario = load_scenario(arguments.scenario, arguments.overrides);
  if (arguments.video) {  // fail early, before the work
    refuse_without_memory_to_draw(video_options(scenario));
    if (arguments.gl != "auto") choose_gl(arguments.gl);
  }
  const std::uint64_t seed = arguments.seed.value_or(scenario.seed);
  scenario.seed = seed;
  refuse_beyond_memory(scenario, arguments.scenario, arguments.overrides);
  const std::string folder =
      arguments.out.empty()
          ? default_folder(scenario.name, fmt::format("{}", seed), arguments.overrides)
          : arguments.out;
  if (const auto problem = plant_problem(scenario, arguments.scenario, arguments.overrides)) {
    throw InputError(*problem);
  }
  settle_points(scenario, arguments.quiet);
  refuse_other_result(folder, scenario, arguments.force);
  print_warnings(scenario_warnings(scenario));
  print_warnings(plant_warnings(scenario));
  make_output_folder(folder);
  write_file(folder + "/" + kScenarioFile, to_yaml(scenario));

  const Trace trace = drive(scenario, seed, folder, arguments.quiet);
  discard_artefacts(folder);  // those of an earlier run do not belong to this trace
  const EpisodeView view(trace);
  write_summary(view, folder, /*with_video=*/false);
  write_controller_log(trace, folder);
  if (trace.outcome == Outcome::kFault) {
    const bool is_plant = trace.fault_of == FaultOf::kPlant;
    std::cerr << (is_plant ? "qsmpc: the plant failed: " : "qsmpc: the controller failed: ")
              << printable(trace.fault, 1000) << '\n';
  }
  // An episode that ended before it began, e.g. because its plant's file is broken, has nothing to
  // show.
  std::string no_video = why_not_drawn(view);
  if (arguments.video && no_video.empty()) no_video = why_no_gl();
  if (arguments.video && !no_video.empty()) std::cerr << "qsmpc: no video: " << no_video << '\n';
  const bool with_video = arguments.video && no_video.empty() && !trace.steps.empty();
  if (with_video) {
    make_video(view,
               {.video = folder + "/" + kVideoFile, .numbers = folder + "/" + kVideoNumbersFile},
               video_options(scenario), {.quiet = arguments.quiet, .verbose = arguments.verbose});
    write_summary(view, folder, with_video);
  }
  write_page(view, folder, with_video);

  print_result(arguments.json ? summary_json(view, {.video_file = with_video ? kVideoFile : ""})
                              : summary_table(view, folder, with_video));
  if (interrupts() > 0) return kInterruptedExit;
  return asked_to_tell(arguments.fail_on, view.summary()) ? kToldFailure : kDone;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("run", kRunHelp);
  command->footer(kRunExample);
  const auto arguments = std::make_shared<RunArguments>();
  add_scenario_argument(*command, arguments->scenario);
  add_set_option(*command, arguments->overrides);
  add_seed_option(*command, arguments->seed, "seed of all random numbers; default: the scenario's");
  command->add_option(
      "--out", arguments->out,
      "output folder; default: out/NAME-SEED, and with --set a hash of the settings after it");
  add_force_option(*command, arguments->force);
  command->add_flag("--video,!--no-video", arguments->video, "make the video (default: yes)");
  // Interrupts are not listed: they have a separate exit code.
  add_fail_on_option(*command, arguments->fail_on,
                     {"reached", "collision", "left_bounds", kFailOnUnsafe, "timeout", "fault",
                      kFailOnRiskExceeded, "none"});
  command
      ->add_option("--gl", arguments->gl,
                   "OpenGL implementation: osmesa, egl, or auto, the first that is installed")
      ->check(CLI::IsMember(render::gl_names()));
  command->add_flag("--verbose", arguments->verbose,
                    "print the OpenGL implementation and the drawing times");
  command->add_flag("--quiet", arguments->quiet, "no progress display");
  command->add_flag("--json", arguments->json, "print summary.json instead of the table");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace qsmpc::harness
