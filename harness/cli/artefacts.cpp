#include "harness/cli/artefacts.hpp"

#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "harness/cli/interrupt.hpp"
#include "harness/cli/progress.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/report/episode_page.hpp"
#include "harness/text/printable.hpp"
#include "harness/trace/summary.hpp"
#include "harness/trace/trace_file.hpp"
#include "harness/video/drawing_memory.hpp"
#include "render/gl/gl_library.hpp"

namespace qsmpc::harness {
namespace {

std::string in_folder(const std::string& folder, const std::string& file) {
  return folder + "/" + file;
}

bool file_exists(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

std::string row(const std::string& name, const std::string& value) {
  return fmt::format("  {:<28} {}\n", name, value);
}

/// "2, the first at 1.25 s, at most 310 N"
std::string contact_words(const Summary& summary) {
  if (!summary.first_contact) return "none";
  return fmt::format("{}, the first at {:.2f} s, at most {:.0f} N", *summary.contacts,
                     *summary.first_contact, summary.largest_contact);
}

/// "0.0153 at most, limit 0.02, exceeded in 3 of 99 periods"
std::string limited_words(const CertifiedRisk& risk, int periods) {
  const std::string exceeded =
      risk.exceeded == 0 ? "never exceeded"
                         : fmt::format("exceeded in {} of {} periods", risk.exceeded, periods);
  return fmt::format("{:.3g} at most, limit {:.3g}, {}", risk.certified, risk.limit, exceeded);
}

/// What the certificates refer to.
std::string scope_words(bool has_plan, bool has_model_error) {
  const std::string holds = has_plan ? "both hold for " : "it holds for ";
  const std::string from = has_plan ? " from its belief" : " from the observed state";
  if (has_model_error) return holds + "plants within model_error," + from;
  return holds + "the planner's model" + from + (has_plan ? "; they do" : "; it does") +
         " not cover the plant's mismatch";
}

/// Rows for the certificates, and whether they are bounds.
std::string certificate_rows(const Summary& summary, bool has_model_error) {
  const bool holds = summary.no_bound.empty();
  const bool has_plan = !std::isnan(summary.horizon_max);
  std::string rows = row(holds ? "P(unsafe at next step) <=" : "next step, NO BOUND",
                         fmt::format("{:.3g} at most, {:.3g} on average", summary.next_step_max,
                                     summary.next_step_mean));
  if (has_plan) {
    rows += row(holds ? "P(unsafe over a plan) <=" : "plan, NO BOUND",
                fmt::format("{:.3g} at most", summary.horizon_max));
  }
  if (!holds) return rows + "  (no bound: " + summary.no_bound + ")\n";
  return rows + "  (" + scope_words(has_plan, has_model_error) + ")\n";
}

/// A row for each limit that is set.
std::string risk_rows(const Summary& summary) {
  const RiskUse& risk = summary.risk;
  const std::string no_bound = summary.no_bound.empty() ? "" : ", NO BOUND";
  std::string rows;
  if (risk.stage.is_limited())
    rows += row("stage risk" + no_bound, limited_words(risk.stage, summary.steps));
  if (risk.plan.is_limited())
    rows += row("plan risk" + no_bound, limited_words(risk.plan, summary.steps));
  if (risk.mission.is_limited()) {
    rows += row("mission risk spent" + no_bound,
                fmt::format("{:.3g} of {:.3g}{}", risk.mission.certified, risk.mission.limit,
                            risk.mission.exceeded > 0 ? ", exceeded" : ""));
  }
  return rows;
}

}  // namespace

void discard_artefacts(const std::string& folder) {
  std::vector<std::string> files{kSummaryFile, kVideoNumbersFile, kPageFile};
  for (const std::string& format : render::video_format_names()) {
    files.push_back("episode." + format);
  }
  for (const std::string& file : files) {
    remove_file(in_folder(folder, file));
  }
}

void choose_gl(const std::string& name) {
  try {
    render::use_gl(name);
  } catch (const std::runtime_error& error) {
    throw IoError(error.what());
  }
}

std::string why_no_gl() {
  try {
    render::use_gl("auto");
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

void refuse_without_memory_to_draw(const EpisodeVideoOptions& options) {
  if (const auto reason = why_no_memory_to_draw(options, free_address_space())) {
    throw IoError(*reason);
  }
}

EpisodeVideoOptions video_options(const Scenario& scenario) {
  EpisodeVideoOptions options;
  options.width = scenario.video.width;
  options.height = scenario.video.height;
  options.fps = scenario.video.fps;
  options.camera = scenario.video.camera;
  options.overlays = overlays_of(scenario.video.overlays);
  return options;
}

bool make_video(const EpisodeView& view, const VideoFiles& files,
                const EpisodeVideoOptions& options, const VideoTalk& talk) {
  const int before = interrupts();
  const bool is_there = file_exists(files.video);
  int all = 0;
  VideoTimings timings;
  try {
    Progress progress("rendering", talk.quiet);
    timings = write_episode_video(view, options, files.video, [&](int done, int total) {
      all = total;
      progress.update(done, total, "frames");
      const bool stopped = interrupts() != before;
      if (stopped && is_there && done < total) throw Interrupted();
      // The new video is about to get its name: the existing numbers belong to the previous one.
      if (stopped || done == total) remove_file(files.numbers);
      return !stopped;
    });
  } catch (const Interrupted&) {
    remove_file(partial_path_of(files.video));
    std::cerr << fmt::format("qsmpc: interrupted: {} is unchanged\n", printable(files.video, 400));
    return false;
  } catch (const std::runtime_error& error) {
    throw IoError(error.what());
  }
  write_file(files.numbers, video_json(timings));
  if (talk.verbose) std::cerr << fmt::format("OpenGL: {}\n{}\n", timings.gl, video_line(timings));
  if (timings.frames == all) return true;
  std::cerr << fmt::format("qsmpc: interrupted: {} ends early, after {} of {} frames\n",
                           printable(files.video, 400), timings.frames, all);
  return false;
}

void make_still(const EpisodeView& view, const std::string& path,
                const EpisodeVideoOptions& options, double time, const VideoTalk& talk) {
  try {
    write_episode_still(view, options, time, path);
  } catch (const std::runtime_error& error) {
    throw IoError(error.what());
  }
  if (talk.verbose) std::cerr << fmt::format("OpenGL: {}\n", render::gl_description());
}

void write_summary(const EpisodeView& view, const std::string& folder, bool with_video) {
  write_file(in_folder(folder, kSummaryFile),
             summary_json(view, {.video_file = with_video ? kVideoFile : ""}));
}

void write_page(const EpisodeView& view, const std::string& folder, bool with_video) {
  EpisodePageOptions options{.video_file = with_video ? kVideoFile : ""};
  const std::string numbers = in_folder(folder, kVideoNumbersFile);
  if (with_video && file_exists(numbers)) {
    const VideoTimings video = read_video_timings(numbers);
    options.video_from = video.from;
    options.video_speed = video.speed;
    options.video_note = fmt::format(
        "{} frames were made at {:.0f} per second: drawing took {:.1f} ms and encoding {:.1f} ms "
        "per frame; simulating the plant took {:.2f} ms per period.",
        video.frames, video.frames_per_second(), video.drawing_ms, video.encoding_ms,
        video.simulation_ms);
  }
  write_file(in_folder(folder, kPageFile), episode_page(view, options));
}

std::string summary_table(const EpisodeView& view, const std::string& folder, bool with_video) {
  const Trace& trace = view.trace();
  const Summary& summary = view.summary();
  std::string text = fmt::format("{} (seed {}): {}\n", printable(trace.scenario.name), trace.seed,
                                 outcome_name(trace.outcome));
  text += row("steps", fmt::format("{}", summary.steps));
  if (summary.time_to_target)
    text += row("time to target", fmt::format("{:.1f} s", *summary.time_to_target));
  if (summary.laps) {
    std::string times;
    for (const double time : summary.laps->times) times += fmt::format(", {:.2f} s", time);
    text += row("laps",
                fmt::format("{} of {}{}", summary.laps->times.size(), summary.laps->wanted, times));
  }
  const std::optional<double> unsafe = view.first_unsafe_time();
  text += row("entered the unsafe set",
              unsafe ? fmt::format("yes, first after {:.1f} s", *unsafe) : "no");
  if (summary.unsafe_between) {
    text += row("unsafe between instants", *summary.unsafe_between ? "yes" : "no");
  }
  if (summary.contacts) text += row("contacts", contact_words(summary));
  text += row("least clearance", fmt::format("{:.3f} m", summary.min_clearance));
  text += row("closed-loop cost", fmt::format("{:.1f}", summary.closed_loop_cost));
  if (!trace.steps.empty()) {
    text += row("solve time, median / p99",
                fmt::format("{:.1f} / {:.1f} ms", summary.ocp_ms.median, summary.ocp_ms.p99));
    text += row("deadline misses", fmt::format("{}", summary.deadline_misses));
    text += certificate_rows(summary, trace.scenario.model_error.has_value()) + risk_rows(summary);
  }
  text += row("numbers", in_folder(folder, kSummaryFile));
  text += row("page", in_folder(folder, kPageFile));
  if (with_video) text += row("video", in_folder(folder, kVideoFile));
  text += row("trace", in_folder(folder, kTraceFile));
  return text;
}

}  // namespace qsmpc::harness
