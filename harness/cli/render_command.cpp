#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/cli/artefacts.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/output.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/value_checks.hpp"
#include "harness/trace/trace_file.hpp"
#include "harness/trace/vehicle_change.hpp"
#include "render/gl/gl_library.hpp"

namespace qsmpc::harness {
namespace {

// Suits a page of documentation; animated pictures grow large.
constexpr int kPictureWidth = 640;
constexpr int kPictureHeight = 360;
constexpr int kPictureFps = 12;

struct RenderArguments {
  std::string folder;
  std::string out;
  std::optional<std::string> format;
  std::optional<std::string> camera;
  std::optional<std::string> overlays;
  std::optional<std::string> beside;
  std::optional<std::string> size;
  std::optional<int> fps;
  std::optional<double> still;
  EpisodeVideoOptions video;  // options with one default for all formats
  std::string gl = "auto";
  bool verbose = false;
  bool quiet = false;
};

/// Sets the size from `text`. Throws InputError if it is not a frame size.
void set_size(const std::string& text, EpisodeVideoOptions& options) {
  const std::optional<FrameSize> size = parse_frame_size(text);
  if (!size) throw InputError({.key = "--size", .found = text, .expected = expected_frame_size()});
  options.width = size->width;
  options.height = size->height;
}

render::VideoFormat chosen_format(const RenderArguments& arguments) {
  if (arguments.format)
    return render::video_format(*arguments.format).value();  // validated by its option
  if (arguments.out.empty()) return render::VideoFormat::kMp4;
  const std::optional<render::VideoFormat> format = render::video_format_of(arguments.out);
  if (!format) {
    throw InputError({.key = "--out",
                      .found = arguments.out,
                      .expected = fmt::format("a file name that ends with .{}, or --format",
                                              fmt::join(render::video_format_names(), ", ."))});
  }
  return *format;
}

void set_format(const RenderArguments& arguments, EpisodeVideoOptions& options) {
  const render::VideoFormat format = chosen_format(arguments);
  options.format = format;
  if (render::is_animated_picture(format)) {
    options.width = kPictureWidth;
    options.height = kPictureHeight;
    options.fps = kPictureFps;
  }
  const int most = render::most_frames_per_second(format);
  if (arguments.fps.value_or(1) > most) {
    throw InputError(
        {.key = "--fps",
         .found = fmt::format("{}", *arguments.fps),
         .expected = fmt::format("at most {} for {}", most, render::video_format_name(format))});
  }
}

EpisodeVideoOptions chosen_options(const RenderArguments& arguments, const Scenario& scenario) {
  EpisodeVideoOptions options = arguments.video;
  const EpisodeVideoOptions usual = video_options(scenario);
  options.camera = arguments.camera.value_or(usual.camera);
  options.overlays =
      arguments.overlays ? parse_overlays(*arguments.overlays, "--overlays") : usual.overlays;
  options.width = usual.width;
  options.height = usual.height;
  options.fps = usual.fps;
  if (!arguments.still) set_format(arguments, options);
  if (arguments.fps) options.fps = *arguments.fps;
  if (arguments.size) set_size(*arguments.size, options);
  return options;
}

/// Throws InputError if --from, --to or --still lie outside the longer episode.
void check_times(const RenderArguments& arguments, const EpisodeView& view,
                 const EpisodeView* beside) {
  const double end = std::max(view.duration(), beside == nullptr ? 0.0 : beside->duration());
  const auto check = [end](const char* key, double time, double first) {
    if (time >= first && time <= end) return;
    throw InputError({.key = key,
                      .found = fmt::format("{:g}", time),
                      .expected = fmt::format("a time from {:g} s to {:g} s", first, end)});
  };
  check("--from", arguments.video.from, 0.0);
  if (std::isfinite(arguments.video.to)) check("--to", arguments.video.to, arguments.video.from);
  if (arguments.still) check("--still", *arguments.still, 0.0);
}

std::string output_path(const RenderArguments& arguments, const EpisodeVideoOptions& options) {
  if (!arguments.out.empty()) return arguments.out;
  if (arguments.still) return fmt::format("{}/still-{:g}.png", arguments.folder, *arguments.still);
  // A video of two episodes must not replace that of either.
  return fmt::format("{}/{}.{}", arguments.folder, arguments.beside ? "beside" : "episode",
                     render::video_format_name(*options.format));
}

/// Throws InputError if a still picture would not be a PNG.
void check_still(const RenderArguments& arguments) {
  if (!arguments.still || arguments.out.empty() || arguments.out.ends_with(".png")) return;
  throw InputError(
      {.key = "--out", .found = arguments.out, .expected = "a file name that ends with .png"});
}

/// Warns on standard error if the vehicle's file has changed.
void warn_of_changes(const Trace& trace) {
  if (const std::string change = vehicle_change(trace); !change.empty()) print_warnings({change});
}

int render(const RenderArguments& arguments) {
  check_still(arguments);
  const Trace trace = read_folder(arguments.folder);
  const EpisodeView view(trace);
  std::optional<Trace> other;
  std::optional<EpisodeView> beside;
  if (arguments.beside) beside.emplace(other.emplace(read_folder(*arguments.beside)));
  EpisodeVideoOptions options = chosen_options(arguments, view.scenario());
  if (beside) options.beside = &*beside;
  check_times(arguments, view, options.beside);
  warn_of_changes(trace);
  if (other) warn_of_changes(*other);
  refuse_without_memory_to_draw(options);
  choose_gl(arguments.gl);
  const std::string path = output_path(arguments, options);
  const VideoTalk talk{.quiet = arguments.quiet, .verbose = arguments.verbose};
  if (arguments.still) {
    make_still(view, path, options, *arguments.still, talk);
  } else {
    const bool is_the_episodes = path == arguments.folder + "/" + kVideoFile;
    const std::string numbers =
        is_the_episodes ? arguments.folder + "/" + kVideoNumbersFile : path + ".json";
    check_interrupts();
    if (!make_video(view, {.video = path, .numbers = numbers}, options, talk)) {
      return kInterruptedExit;
    }
  }
  print_result(path + "\n");
  return interrupts() > 0 ? kInterruptedExit : kDone;
}

void add_video_options(CLI::App& command, RenderArguments& arguments) {
  EpisodeVideoOptions& video = arguments.video;
  command
      .add_option("--camera", arguments.camera,
                  "chase, top, fixed, or split: chase and top side by side")
      ->check(CLI::IsMember(camera_names()));
  command.add_option("--beside", arguments.beside, "folder of another episode, shown on the right");
  command.add_option("--overlays", arguments.overlays,
                     "overlays drawn over the scene, e.g. particles,tube, or all or none; default: "
                     "the scenario's");
  command.add_option("--size", arguments.size,
                     "WIDTHxHEIGHT in pixels, both even; default: the scenario's, 640x360 for gif "
                     "and webp");
  command
      .add_option("--fps", arguments.fps,
                  "frames per second; default: the scenario's, 12 for gif and webp")
      ->check(CLI::Range(1, 240));
  command
      .add_option("--speed", video.speed, "seconds of the episode per second of video; default: 1")
      ->check(CLI::Range(0.1, 100.0));
  command
      .add_option("--quality", video.quality,
                  "from 0 (smallest file) to 100 (best picture); default: 60")
      ->check(CLI::Range(0, render::kBestQuality));
  command.add_option("--from", video.from, "start of the video, in seconds of the episode");
  command.add_option("--to", video.to, "end of the video, in seconds of the episode");
  command.add_option("--threads", video.threads, "number of drawing threads; default: 2")
      ->check(CLI::Range(1, 64));
}

}  // namespace

void add_render_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("render", "Renders the video again, or a still picture, from the trace.");
  command->footer(
      "Examples: qsmpc render out/dubins_obstacles-0 --camera top --size 1920x1080\n"
      "          qsmpc render out/dubins_obstacles-0 --out drive.gif --speed 2");
  const auto arguments = std::make_shared<RenderArguments>();
  command->add_option("folder", arguments->folder, "folder of an episode")->required();
  command->add_option("--out", arguments->out, "file to write; default: episode.mp4 in the folder");
  add_video_options(*command, *arguments);
  command
      ->add_option("--format", arguments->format,
                   "mp4, webm, gif or webp; default: by the ending of --out")
      ->check(CLI::IsMember(render::video_format_names()));
  command
      ->add_option("--still", arguments->still,
                   "write one picture (PNG) at this second of the episode instead of a video")
      ->excludes("--format")
      ->excludes("--from")
      ->excludes("--to")
      ->excludes("--speed")
      ->excludes("--quality")
      ->excludes("--fps");
  command
      ->add_option("--gl", arguments->gl,
                   "OpenGL implementation: osmesa, egl, or auto, the first that is installed")
      ->check(CLI::IsMember(render::gl_names()));
  command->add_flag("--verbose", arguments->verbose,
                    "print the OpenGL implementation and the drawing times");
  command->add_flag("--quiet", arguments->quiet, "no progress display");
  command->callback([arguments, &exit_code] { exit_code = render(*arguments); });
}

}  // namespace qsmpc::harness
