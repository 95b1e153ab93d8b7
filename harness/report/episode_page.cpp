#include "harness/report/episode_page.hpp"

#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "harness/assembly/assembly.hpp"
#include "harness/figures/plane_map.hpp"
#include "harness/figures/svg_chart.hpp"
#include "harness/report/episode_charts.hpp"
#include "harness/report/episode_data.hpp"
#include "harness/report/episode_map.hpp"
#include "harness/report/episode_scene.hpp"
#include "harness/report/key_figures.hpp"
#include "harness/report/page_frame.hpp"
#include "harness/text/html.hpp"
#include "harness/trace/map_axes.hpp"

namespace qsmpc::harness {
namespace {

/// What a certificate says: of a plan or only of the next step, for the model or for the plants
/// within a model error.
std::string meaning_of_certificates(bool has_plan, bool has_model_error) {
  std::string html = fmt::format(
      "<section class=\"card\">\n<h3>What a certificate says</h3>\n"
      "<p>A certificate is an upper bound of the probability that the state of {} is unsafe",
      has_model_error ? "any plant within the scenario’s <code>model_error</code>"
                      : "the <em>model</em>");
  html += has_plan ? ": at the next step, given the belief from which the plan was made. The "
                     "certificate of a plan is one of being unsafe at any of its stages; it holds "
                     "for the plan as made, not for the replanning at every step."
                   : " at the next step, given what was observed when the input was chosen. This "
                     "controller makes no plan, so later steps are not covered.";
  if (!has_model_error) {
    html += has_plan ? " Neither covers" : " Nor is";
    html += " the plant’s mismatch to the model, which is measured below.";
  }
  return html + "</p>\n</section>\n";
}

constexpr std::string_view kMismatchNote =
    "<h3>Mismatch of the plant against the planner’s model</h3>\n"
    "<p class=\"note\">The plant’s next state minus the model’s prediction and the disturbance, "
    "over all steps. For an exact model, all values are 0.</p>\n";

std::string introduction(const Trace& trace) {
  const Scenario& scenario = trace.scenario;
  std::string html = fmt::format(
      "<p class=\"kicker\"><strong>{}</strong> · model {} · plant {} · {} · seed {}</p>\n",
      escape_html(scenario.name), escape_html(scenario.model.system),
      escape_html(scenario.plant.kind), escape_html(controller_words(scenario)), trace.seed);
  if (!scenario.description.empty()) {
    html += "<p class=\"soft\">" + escape_html(scenario.description) + "</p>\n";
  }
  return html;
}

std::string video(const EpisodePageOptions& options) {
  if (options.video_file.empty()) return {};
  const std::string url = url_beside(options.video_file);
  return fmt::format(
      "<figure class=\"card\">\n<figcaption>Video</figcaption>\n"
      "<video controls muted playsinline preload=\"auto\" src=\"{}\"></video>\n"
      "<p class=\"note\">The file <a href=\"{}\">{}</a>, beside this page. {}</p>\n</figure>\n",
      url, url, escape_html(options.video_file), escape_html(options.video_note));
}

constexpr std::string_view kMapOfPlans =
    "; the vehicle and, dashed, where the model without noise would be; the plan with its belief, "
    "stage by stage from <span class=\"first\">now</span> to <span class=\"last\">its end</span>";
constexpr std::string_view kMapOfParticles =
    ": particles, and ellipses that contain 50 and (dashed) 95 % of a normal distribution with "
    "their mean and covariance";

constexpr std::string_view kMapOfMoving = "; in blue, the moving obstacles";
constexpr std::string_view kMapOfForecasts =
    "; in blue, the moving obstacles and, as ellipses of two standard deviations, the plan’s "
    "forecast of their centres, fainter the later and the less probable";

std::string layer_box(std::string_view layer, std::string_view words) {
  return fmt::format(
      "<label><input type=\"checkbox\" checked=\"checked\" data-layer=\"{}\"/>{}</label>", layer,
      words);
}

std::string live_map(const PlaneMap* map, const controller::DecisionParts& parts, bool has_moving) {
  if (map == nullptr) return {};
  std::string html =
      "<figure class=\"card\" id=\"live-map\" hidden>\n<figcaption>The map at this moment"
      "</figcaption>\n<p class=\"note\">The driven path, from <span class=\"near\">near</span> the "
      "unsafe set to <span class=\"far\">1 m and more</span> from it";
  html += parts.stages > 0 ? kMapOfPlans : "; the vehicle";
  if (parts.particles) html += kMapOfParticles;
  if (has_moving) html += parts.stages > 0 ? kMapOfForecasts : kMapOfMoving;
  html += ".</p>\n<div class=\"layers\">";
  if (parts.particles) {
    html += layer_box("particles", "particles") + layer_box("ellipses", "ellipses");
  }
  if (parts.stages > 0) html += layer_box("plan", "plan") + layer_box("ghost", "model’s vehicle");
  if (has_moving && parts.stages > 0) html += layer_box("forecast", "forecasts");
  html += "<label><input type=\"checkbox\" id=\"near-view\"/>near view</label>";
  return html + "</div>\n" + map_drawing(*map) + "</figure>\n";
}

std::string scene_box(std::string_view layer, std::string_view words) {
  return fmt::format(
      "<label><input type=\"checkbox\" checked=\"checked\" data-scene=\"{}\"/>{}</label>", layer,
      words);
}

/// The view in three dimensions, which the scene's script fills, or why there is none.
std::string scene_figure(const EpisodeScene& scene, bool in_plane,
                         const controller::DecisionParts& parts, bool has_moving) {
  std::string note =
      scene.note.empty() ? "" : "<p class=\"note\">" + escape_html(scene.note) + "</p>\n";
  if (scene.data.empty()) return note;
  std::string html =
      "<figure class=\"card\" id=\"scene\" hidden>\n<figcaption>The drive in three dimensions"
      "</figcaption>\n<p class=\"note how\">Drag to rotate; drag with the right button or two "
      "fingers to move. After a click, the wheel and the plus and minus keys zoom, and the arrow "
      "keys rotate.</p>\n"
      "<div class=\"layers\">" +
      scene_box("follow", "follow the vehicle");
  if (in_plane) {
    if (parts.particles) html += scene_box("particles", "particles");
    if (parts.stages > 0) html += scene_box("plan", "plan") + scene_box("ghost", "model’s vehicle");
    if (has_moving && parts.stages > 0) html += scene_box("forecast", "forecasts");
    html += scene_box("way", "driven path");
  }
  return html + "<button type=\"button\" class=\"whole\">Show all</button></div>\n" +
         "<div class=\"scene\"></div>\n" + note + "</figure>\n";
}

std::string player(const Trace& trace) {
  return fmt::format(
      "<div class=\"card player needs-script\" role=\"group\" aria-label=\"Moment of the drive\" "
      "hidden>\n<button type=\"button\" id=\"play\" aria-pressed=\"false\">Play</button>\n"
      "<button type=\"button\" id=\"back\" aria-label=\"One period back\">−1</button>\n"
      "<input type=\"range\" id=\"time\" min=\"0\" max=\"{}\" value=\"0\" step=\"{}\" "
      "aria-label=\"Time in seconds\"/>\n"
      "<button type=\"button\" id=\"forward\" aria-label=\"One period forward\">+1</button>\n"
      "<output id=\"clock\" for=\"time\">0 s</output>\n</div>\n",
      static_cast<double>(trace.steps.size()) * trace.scenario.time_step, trace.scenario.time_step);
}

constexpr std::string_view kMoment =
    "<section class=\"card needs-script\" hidden>\n<h3>At this moment</h3>\n"
    "<dl class=\"now\" id=\"now\"></dl>\n{}<ul class=\"why\" id=\"why\"></ul>\n</section>\n";

constexpr std::string_view kWhy =
    "<h3>What the plan pays for</h3>\n"
    "<p class=\"note\">Parts of the plan’s expected cost; the largest matters most to the "
    "controller.</p>\n";

constexpr std::string_view kStageCharts =
    "<figure class=\"card\" id=\"stage-certificates\" hidden>\n<figcaption>Certificates of this "
    "plan, stage by stage</figcaption>\n<p class=\"note\">{} of the probability of being "
    "unsafe at each stage; values up to 10⁻⁹ are drawn at the bottom.</p>\n</figure>\n"
    "<figure class=\"card\" id=\"stage-budgets\" hidden>\n<figcaption>Error budget of this plan, "
    "stage by stage</figcaption>\n<p class=\"note\">Bound of the distance between the model’s law "
    "and "
    "its particles, and what each source alone would give.</p>\n</figure>\n";

std::string columns(const std::string& left, const std::string& right) {
  return fmt::format(
      "<div class=\"grid drive\">\n<div class=\"stack\">\n{}</div>\n<div "
      "class=\"stack\">\n{}</div>\n</div>\n",
      left, right);
}

/// Views of the drive come first, side by side; charts that explain it follow below, in both
/// columns.
std::string drive(const EpisodeView& view, const PlaneMap* map, const EpisodeScene& scene,
                  const EpisodePageOptions& options) {
  const Trace& trace = view.trace();
  const controller::DecisionParts& parts = view.parts();
  const std::string head = "<h2 class=\"drive-head\">The drive</h2>\n";
  const std::string film = video(options);
  const std::string meaning =
      meaning_of_certificates(parts.stages > 0, trace.scenario.model_error.has_value());
  if (trace.steps.empty()) return head + film + meaning;
  const std::string moment = fmt::format(kMoment, parts.cost ? kWhy : std::string_view());
  const bool has_moving = !controller::moving_obstacles(view.scenario().safe_set).empty();
  const std::string plane = live_map(map, parts, has_moving);
  std::string html = head + player(trace);
  if (!film.empty() && !plane.empty()) {
    html += columns(film + moment, plane + meaning);
  } else if (film.empty() && plane.empty()) {
    html += columns(moment, meaning);
  } else {
    html += columns(film + plane, moment + meaning);
  }
  if (parts.stages > 0) {
    const char* const what =
        view.summary().no_bound.empty() ? "Upper bounds" : "Estimates (not bounds)";
    html += "<div class=\"grid drive below\">\n" + fmt::format(kStageCharts, what) + "</div>\n";
  }
  return html +
         scene_figure(scene, map != nullptr && has_position(view.system()), parts, has_moving);
}

std::string charts_html(const std::vector<Chart>& charts) {
  std::string html = "<h2>Along the drive</h2>\n";
  if (!charts.empty()) {
    html +=
        "<p class=\"note needs-script\" hidden>Click to select a moment, drag to zoom in, "
        "double-click to zoom out.</p>\n<div class=\"grid\" id=\"charts\">\n";
    for (const Chart& chart : charts) html += chart_figure(chart);
    html += "</div>\n";
  }
  return html;
}

std::string ending(const Trace& trace) {
  std::string html =
      "<details>\n<summary>The scenario, with every default filled in</summary>\n<pre>" +
      escape_html(trace.scenario_text) + "</pre>\n</details>\n";
  return html;
}

}  // namespace

std::string episode_page(const EpisodeView& view, const EpisodePageOptions& options) {
  // First compute the content, then assemble the page.
  const Trace& trace = view.trace();
  const bool moves = !trace.steps.empty();
  const KeyFigures figures = key_figures(view);
  const std::vector<Chart> charts = moves ? episode_charts(view) : std::vector<Chart>{};
  const std::optional<EpisodeMaps> maps = episode_maps(view);
  const PlaneMap* const ground = maps ? &maps->ground : nullptr;
  const std::string data = moves ? episode_data(view, {.charts = charts,
                                                       .map = ground,
                                                       .video_from = options.video_from,
                                                       .video_speed = options.video_speed})
                                 : std::string();
  // For a system without a position in the plane, the map shows two of its states and is not a
  // ground.
  const bool in_plane = has_position(view.system());
  const EpisodeScene scene = episode_scene(view, in_plane ? ground : nullptr);

  std::string html = introduction(trace) + figures.outcome + figures.tiles;
  html += drive(view, ground, scene, options);
  html += charts_html(charts) + "<div class=\"grid below\">\n";
  if (maps) html += map_figure(maps->drive);
  if (maps) {
    for (const PlaneMap& map : maps->coloured) html += map_figure(map);
  }
  html += "<section class=\"card mismatch\">\n" + std::string(kMismatchNote) + figures.mismatch +
          "</section>\n</div>\n" + ending(trace);
  if (moves) {
    html += "<script type=\"application/json\" id=\"episode-data\">" + data + "</script>\n";
  }
  if (!scene.data.empty()) {
    html += "<script type=\"application/json\" id=\"scene-data\">" + scene.data + "</script>\n";
  }
  return framed_page({.title = trace.scenario.name + ": episode",
                      .version = trace.version,
                      .kind = !moves               ? PageKind::kPlain
                              : scene.data.empty() ? PageKind::kEpisode
                                                   : PageKind::kEpisodeScene},
                     html);
}

}  // namespace qsmpc::harness
