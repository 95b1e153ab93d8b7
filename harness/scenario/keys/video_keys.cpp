// The keys of the video.
#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/value_checks.hpp"

namespace qsmpc::harness {
namespace {

constexpr WholeValue kFpsRange{1, 240};

std::string size_text(const Scenario::Video& video) {
  return fmt::format("{}x{}", video.width, video.height);
}

void read_size(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  Scenario::Video& video = reading.scenario.video;
  const std::string text = section.text(about.name, about.fallback, kLongestName);
  if (const auto size = parse_frame_size(text)) {
    video.width = size->width;
    video.height = size->height;
  } else {
    section.note(about.name, expected_frame_size());
  }
}

void read_overlays(ScenarioReading& reading, Section& section, const KeyDescription& about) {
  const std::vector<std::string>& known = overlay_names();
  std::vector<std::string> wanted;
  for (const std::string& name : section.texts(about.name, kLongestName)) {
    if (std::ranges::find(known, name) == known.end()) {
      section.note(about.name, expected_names(name, known), name);
    } else if (std::ranges::find(wanted, name) != wanted.end()) {
      section.note(about.name, "each overlay once", name + " a second time");
    } else {
      wanted.push_back(name);
    }
  }
  if (section.has(about.name)) reading.scenario.video.overlays = wanted;
}

std::string overlays_text(const Scenario::Video& video) {
  return fmt::format("[{}]", fmt::join(video.overlays, ", "));
}

ScenarioKey size_key() {
  return {.about = {.name = "size",
                    .values = {TextValue{.longest = kLongestName, .pattern = "^[0-9]+x[0-9]+$"}},
                    .words = fmt::format("`WIDTHxHEIGHT`, both even, {0}x{0} to {1}x{2}",
                                         kLeastFrameSide, kMostFrameWidth, kMostFrameHeight),
                    .unit = "pixels",
                    .fallback = size_text({})},
          .read = read_size,
          .write = [](const Scenario& scenario, const models::SystemDescription& /*system*/) {
            return std::optional(size_text(scenario.video));
          }};
}

ScenarioKey overlays_key() {
  return {.about = {.name = "overlays",
                    .values = {list_of_values(NameValue{overlay_names()}, {.once = true})},
                    .words = "a list of {names}; `[]` for none",
                    .see = "[what they show](video.md#what-is-drawn)",
                    .fallback = overlays_text({}),
                    .fallback_words = "all but `raw`"},
          .read = read_overlays,
          .write = [](const Scenario& scenario, const models::SystemDescription& /*system*/) {
            return std::optional(overlays_text(scenario.video));
          }};
}

}  // namespace

ScenarioKey video_key() {
  return {
      .about = {.name = "video"},
      .keys = {{.about = {.name = "camera",
                          .values = {NameValue{camera_names()}},
                          .words = "`chase`, `top`, `fixed`, or `split`: chase and top side by "
                                   "side"},
                .member = [](Scenario& scenario) -> std::string& { return scenario.video.camera; }},
               size_key(),
               {.about = {.name = "fps",
                          .values = {kFpsRange},
                          .words = "frames per second",
                          .unit = "1/s"},
                .member = [](Scenario& scenario) -> int& { return scenario.video.fps; }},
               overlays_key()},
      .layout = SectionLayout::kFlow,
      .table = "video"};
}

}  // namespace qsmpc::harness
