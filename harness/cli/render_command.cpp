#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "harness/cli/artefacts.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/output.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/value_checks.hpp"

namespace qsmpc {
namespace {

struct RenderArguments {
  std::string folder;
  std::optional<std::string> camera;
  std::optional<std::string> size;
  std::optional<int> fps;
  bool quiet = false;
};

/// Throws InputError on what is no frame size.
void set_size(const std::string& text, EpisodeVideoOptions& options) {
  const std::optional<FrameSize> size = parse_frame_size(text);
  if (!size) throw InputError({.key = "--size", .found = text, .expected = expected_frame_size()});
  options.width = size->width;
  options.height = size->height;
}

int render(const RenderArguments& arguments) {
  const Trace trace = read_folder(arguments.folder);
  EpisodeVideoOptions options = video_options(trace.scenario);
  if (arguments.camera) options.camera = *arguments.camera;
  if (arguments.size) set_size(*arguments.size, options);
  if (arguments.fps) options.fps = *arguments.fps;
  make_video(trace, arguments.folder, options, arguments.quiet);
  print_result(arguments.folder + "/" + kVideoFile + "\n");
  return interrupts() > 0 ? kInterruptedExit : kDone;
}

}  // namespace

void add_render_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("render", "Makes the video again, from the trace.");
  command->footer("Example: qsmpc render out/dubins_obstacles-0 --camera top --size 1920x1080");
  const auto arguments = std::make_shared<RenderArguments>();
  command->add_option("folder", arguments->folder, "folder of an episode")->required();
  command->add_option("--camera", arguments->camera, "chase, top or fixed")
      ->check(CLI::IsMember(camera_names()));
  command->add_option("--size", arguments->size, "WIDTHxHEIGHT in pixels, both even");
  command->add_option("--fps", arguments->fps, "frames a second")->check(CLI::Range(1, 240));
  command->add_flag("--quiet", arguments->quiet, "no progress");
  command->callback([arguments, &exit_code] { exit_code = render(*arguments); });
}

}  // namespace qsmpc
