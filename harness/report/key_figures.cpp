#include "harness/report/key_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

#include "harness/text/html.hpp"
#include "harness/text/number_format.hpp"
#include "harness/text/unit_text.hpp"
#include "harness/trace/residuals.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kNone = "–";
constexpr double kMilliseconds = 1e3;

enum class Verdict { kPlain, kGood, kWarn, kBad };

const char* verdict_class(Verdict verdict) {
  switch (verdict) {
    case Verdict::kGood:
      return " good";
    case Verdict::kWarn:
      return " warn";
    case Verdict::kBad:
      return " bad";
    case Verdict::kPlain:
      break;
  }
  return "";
}

struct Tile {
  std::string name;
  std::string value;
  std::string hint{};
  Verdict verdict = Verdict::kPlain;
};

std::string tile_html(const Tile& tile) {
  std::string html =
      fmt::format("<div class=\"tile{}\"><dt>{}</dt><dd class=\"value\">{}</dd>",
                  verdict_class(tile.verdict), escape_html(tile.name), escape_html(tile.value));
  if (!tile.hint.empty()) html += "<dd class=\"hint\">" + escape_html(tile.hint) + "</dd>";
  return html + "</div>\n";
}

bool has_true_state(const EpisodeView& view) { return view.states().cols() > 0; }

std::string seconds(double value) { return format_short(value, 4) + " s"; }

Tile time_tile(const Summary& summary) {
  const bool reached = summary.time_to_target.has_value();
  return {.name = "Time to target",
          .value = reached ? seconds(*summary.time_to_target) : "not reached",
          .hint = fmt::format("{} control step{}", summary.steps, summary.steps == 1 ? "" : "s"),
          .verdict = !reached            ? Verdict::kWarn
                     : summary.collision ? Verdict::kPlain
                                         : Verdict::kGood};
}

/// The tile of a drive along a path.
Tile path_tile(const EpisodeView& view) {
  const Summary& summary = view.summary();
  const double length = view.scenario().target.course->path->length();
  Tile tile{.name = "Along the path",
            .value = format_short(summary.distance.value_or(0.0), 4) + " m",
            .hint = fmt::format("the path is {} m long", format_short(length, 4))};
  if (!summary.laps) return tile;
  tile.hint =
      fmt::format("{} of {} lap{} of {} m", summary.laps->times.size(), summary.laps->wanted,
                  summary.laps->wanted == 1 ? "" : "s", format_short(length, 4));
  for (std::size_t n = 0; n < summary.laps->times.size(); ++n) {
    tile.hint += fmt::format("; lap {}: {}", n + 1, seconds(summary.laps->times[n]));
  }
  return tile;
}

/// The tile of a drive over waypoints.
Tile waypoints_tile(const WaypointTimes& passed) {
  Tile tile{.name = "Waypoints",
            .value = fmt::format("{} of {}", passed.times.size(), passed.wanted),
            .hint = "passed in order"};
  for (std::size_t n = 0; n < passed.times.size(); ++n) {
    tile.hint += fmt::format("; {}: {}", n + 1, seconds(passed.times[n]));
  }
  return tile;
}

Tile unsafe_tile(const EpisodeView& view) {
  const Summary& summary = view.summary();
  constexpr const char* kHint = "true state at the control instants";
  if (!has_true_state(view)) {
    return {.name = "Entered the unsafe set", .value = kNone, .hint = "no known state"};
  }
  Verdict verdict = summary.collision ? Verdict::kBad : Verdict::kGood;
  if (summary.steps == 0 && !summary.collision) verdict = Verdict::kPlain;  // nothing was risked
  return {.name = "Entered the unsafe set",
          .value = summary.collision ? "yes" : "no",
          .hint = kHint,
          .verdict = verdict};
}

/// Whether the simulator's steps between the control instants were safe, if known.
Tile between_tile(const Summary& summary) {
  const bool unsafe = summary.unsafe_between.value_or(false);
  return {.name = "Unsafe between control instants",
          .value = unsafe ? "yes" : "no",
          .hint = "true state at the simulator's steps, before the disturbance",
          .verdict = unsafe ? Verdict::kBad : Verdict::kGood};
}

Tile contact_tile(const Summary& summary) {
  const int count = summary.contacts.value_or(0);
  Tile tile{.name = "Contacts",
            .value = fmt::format("{}", count),
            .hint = "of the vehicle with solid walls and obstacles",
            .verdict = count > 0 ? Verdict::kBad : Verdict::kGood};
  if (summary.first_contact) {
    tile.hint += fmt::format("; the first at {}, at most {} N", seconds(*summary.first_contact),
                             format_number(summary.largest_contact));
  }
  return tile;
}

Tile clearance_tile(const EpisodeView& view) {
  const Summary& summary = view.summary();
  Tile tile{.name = "Minimum clearance",
            .value = kNone,
            .hint = "distance to the unsafe set; negative inside"};
  if (!has_true_state(view)) return tile;
  tile.value = format_number(summary.min_clearance) + " " + view.clearance_unit();
  if (summary.collision) tile.verdict = Verdict::kBad;
  return tile;
}

/// The tile of an upper bound of a probability.
Tile bound_tile(const Summary& summary, const std::string& name, double bound,
                const std::string& hint) {
  Tile tile{.name = name, .value = kNone, .hint = hint};
  if (summary.steps == 0) return tile;
  tile.value = format_bound(bound);
  if (!summary.no_bound.empty()) {
    tile.hint = "not a bound: see above";
    tile.verdict = Verdict::kWarn;
  } else if (!(bound < 1.0)) {
    tile.hint += "; uninformative at 1 or more";
    tile.verdict = Verdict::kWarn;
  }
  return tile;
}

/// The tile of a certified value against the scenario's limit.
Tile limit_tile(const Summary& summary, const std::string& name, const CertifiedRisk& risk,
                const std::string& hint) {
  Tile tile{.name = name,
            .value = kNone,
            .hint = fmt::format("{}; limit {}", hint, format_short(risk.limit))};
  if (summary.steps == 0) return tile;
  tile.value = format_bound(risk.certified);
  tile.hint += risk.exceeded == 0
                   ? ", never exceeded"
                   : fmt::format(", exceeded in {} of {} periods", risk.exceeded, summary.steps);
  tile.verdict = risk.exceeded == 0 ? Verdict::kGood : Verdict::kBad;
  if (!summary.no_bound.empty()) {
    tile.hint += "; not a bound: see above";
    if (tile.verdict == Verdict::kGood) tile.verdict = Verdict::kWarn;
  }
  return tile;
}

void add_limit_tiles(const Summary& summary, std::vector<Tile>& tiles) {
  const RiskUse& risk = summary.risk;
  if (risk.stage.is_limited()) {
    tiles.push_back(limit_tile(summary, "Stage risk", risk.stage, "largest of a plan's stages"));
  }
  if (risk.plan.is_limited()) {
    tiles.push_back(limit_tile(summary, "Plan risk", risk.plan, "all stages of a plan together"));
  }
  if (risk.mission.is_limited()) {
    tiles.push_back(limit_tile(summary, "Mission risk spent", risk.mission,
                               "sum of next-step certificates along the drive"));
  }
}

Tile thesis_tile(const Summary& summary) {
  return {.name = "Published method, largest",
          .value = summary.steps == 0 ? kNone : format_number(summary.thesis_max),
          .hint = "for comparison: not a bound"};
}

Tile solve_tile(const Trace& trace, const Summary& summary) {
  const double period = kMilliseconds * trace.scenario.time_step;
  Tile tile{.name = "Solve time, median / 99th percentile",
            .value = kNone,
            .hint = fmt::format("control period {} ms", format_short(period, 4))};
  if (summary.steps == 0) return tile;
  tile.value = fmt::format("{} / {} ms", format_number(summary.ocp_ms.median),
                           format_number(summary.ocp_ms.p99));
  tile.hint = fmt::format("at most {} ms; ", format_number(summary.ocp_ms.max)) + tile.hint;
  return tile;
}

Tile deadline_tile(const Summary& summary) {
  if (summary.steps == 0) return {.name = "Deadline misses", .value = kNone};
  return {.name = "Deadline misses",
          .value = fmt::format("{} of {}", summary.deadline_misses, summary.steps),
          .hint = "steps that took longer than the control period",
          .verdict = summary.deadline_misses > 0 ? Verdict::kWarn : Verdict::kGood};
}

Tile fallback_tile(const Summary& summary) {
  if (summary.steps == 0) return {.name = "Fallbacks", .value = kNone};
  return {.name = "Fallbacks",
          .value = fmt::format("{} of {}", summary.fallbacks, summary.steps),
          .hint = "steps that kept the previous plan, shifted by one",
          .verdict = summary.fallbacks > 0 ? Verdict::kWarn : Verdict::kPlain};
}

Tile evaluations_tile(const Summary& summary) {
  return {.name = "Optimiser evaluations, median",
          .value = summary.steps == 0 ? kNone : format_short(summary.iterations_median),
          .hint = "of cost and gradient, per step"};
}

Tile cost_tile(const Summary& summary) {
  return {.name = "Closed-loop cost",
          .value = summary.steps == 0 ? kNone : format_number(summary.closed_loop_cost, 4),
          .hint = "of the true states and the inputs"};
}

struct Ending {
  Verdict verdict = Verdict::kWarn;
  std::string text;
};

std::string failed_words(const EpisodeView& view) {
  return view.trace().fault_of == FaultOf::kController ? "The controller failed"
                                                       : "The simulator failed";
}

Ending ending_of(const EpisodeView& view) {
  const Summary& summary = view.summary();
  const double end = view.duration();
  const std::string after = " after " + seconds(end);
  const std::string after_unsafe = " after " + seconds(view.first_unsafe_time().value_or(end));
  switch (view.trace().outcome) {
    case Outcome::kReached:
      return {Verdict::kGood, "Target reached" + after};
    case Outcome::kCollision:
      return {Verdict::kBad, "Collision" + after_unsafe};
    case Outcome::kLeftBounds:
      return {Verdict::kBad, "Left the bounds" + after_unsafe};
    case Outcome::kTimeout:
      return {Verdict::kWarn, "Target not reached: time ran out" + after};
    case Outcome::kFault:
      return {Verdict::kBad, failed_words(view) + (summary.steps == 0 ? " at the start" : after)};
    case Outcome::kInterrupted:
      break;
  }
  return {Verdict::kWarn, "Interrupted" + after};
}

std::string safety_sentence(const EpisodeView& view) {
  const Summary& summary = view.summary();
  if (summary.steps == 0) return "No control step was made.";
  if (!has_true_state(view)) return {};
  if (const std::optional<double> unsafe = view.first_unsafe_time()) {
    std::string entered =
        fmt::format("The true state entered the unsafe set: first at {}.", seconds(*unsafe));
    if (view.scenario().stop_when_unsafe) return entered;
    return fmt::format(
        "{} The drive continued (limit.stop_when_unsafe: false) and ended after {}{}.", entered,
        seconds(view.duration()), summary.time_to_target ? " at the target" : "");
  }
  return "The true state was outside the unsafe set at every control instant.";
}

std::string outcome_html(const EpisodeView& view) {
  const Trace& trace = view.trace();
  const Ending ending = ending_of(view);
  const char* sign = ending.verdict == Verdict::kGood  ? "✓"
                     : ending.verdict == Verdict::kBad ? "✕"
                                                       : "!";
  std::string html =
      fmt::format("<section class=\"outcome{}\">\n<h1><span class=\"badge\">{} {}</span></h1>\n",
                  verdict_class(ending.verdict), sign, escape_html(ending.text));
  html += "<p>" + escape_html(safety_sentence(view)) + "</p>\n";
  if (!view.summary().no_bound.empty()) {
    html += "<p id=\"no-bound\"><strong>No certificate is a bound here:</strong> " +
            escape_html(view.summary().no_bound) + ".</p>\n";
  }
  if (!trace.fault.empty()) {
    html += "<p>Error message:</p>\n<pre>" + escape_html(trace.fault) + "</pre>\n";
  }
  return html + "</section>\n";
}

/// Number of tiles per row of a wide page, such that the last row is at least half full.
std::size_t tile_columns(std::size_t tiles) {
  constexpr std::array<std::size_t, 3> kColumns{6, 5, 7};
  for (const std::size_t columns : kColumns) {
    const std::size_t last = tiles % columns;
    if (last == 0 || 2 * last >= columns) return columns;
  }
  return kColumns.front();
}

std::string tiles_html(const EpisodeView& view) {
  const Trace& trace = view.trace();
  const Summary& summary = view.summary();
  const controller::DecisionParts& parts = view.parts();
  std::vector<Tile> tiles = {time_tile(summary), unsafe_tile(view), clearance_tile(view),
                             bound_tile(summary, "Largest next-step certificate",
                                        summary.next_step_max, "upper bound of a probability"),
                             bound_tile(summary, "Sum of next-step certificates",
                                        summary.next_step_sum, "along the drive")};
  if (summary.distance) tiles.insert(tiles.begin() + 1, path_tile(view));
  if (summary.waypoints) tiles.insert(tiles.begin() + 1, waypoints_tile(*summary.waypoints));
  if (parts.stages > 0) {
    tiles.push_back(bound_tile(summary, "Largest plan certificate", summary.horizon_max,
                               "all stages of a plan together"));
  }
  add_limit_tiles(summary, tiles);
  if (summary.unsafe_between) tiles.push_back(between_tile(summary));
  if (summary.contacts) tiles.push_back(contact_tile(summary));
  tiles.push_back(thesis_tile(summary));
  tiles.push_back(solve_tile(trace, summary));
  tiles.push_back(deadline_tile(summary));
  if (parts.status) {
    tiles.push_back(fallback_tile(summary));
    tiles.push_back(evaluations_tile(summary));
  }
  tiles.push_back(cost_tile(summary));
  std::string html = fmt::format("<dl class=\"tiles of-{}\">\n", tile_columns(tiles.size()));
  for (const Tile& tile : tiles) html += tile_html(tile);
  return html + "</dl>\n";
}

/// Whether everything that the plant adds to the model in a period is rounding.
bool is_the_model(const EpisodeView& view) {
  const Eigen::VectorXd magnitude = view.states().cwiseAbs().rowwise().maxCoeff();
  const Eigen::VectorXd& rmse = view.summary().mismatch_rmse;
  return rmse.size() == magnitude.size() &&
         (rmse.array() <= residual_rounding(magnitude).array()).all();
}

std::string mismatch_html(const EpisodeView& view) {
  const Summary& summary = view.summary();
  const models::SystemDescription& system = view.system();
  if (summary.steps == 0) return "<p class=\"empty\">No step was made.</p>\n";
  if (is_the_model(view)) {
    return fmt::format(
        "<p>The plant matches the model except for rounding, which is at most {} in any state "
        "(root mean square).</p>\n",
        format_number(summary.mismatch_rmse.maxCoeff()));
  }
  std::string html =
      "<div class=\"scroll\"><table>\n<thead><tr><th scope=\"col\">state</th>"
      "<th scope=\"col\">RMS</th><th scope=\"col\">mean</th>"
      "<th scope=\"col\">standard deviation</th><th "
      "scope=\"col\">unit</th></tr></thead>\n<tbody>\n";
  const Eigen::Index rows =
      std::min({std::ssize(system.states), summary.mismatch_rmse.size(),
                summary.mismatch_mean.size(), summary.mismatch_covariance.rows()});
  for (Eigen::Index i = 0; i < rows; ++i) {
    const models::Coordinate& state = system.states[static_cast<std::size_t>(i)];
    html += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        escape_html(state.name), format_number(summary.mismatch_rmse[i]),
        format_number(summary.mismatch_mean[i]),
        format_number(std::sqrt(summary.mismatch_covariance(i, i))),
        escape_html(printed_unit(state.unit)));
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace

KeyFigures key_figures(const EpisodeView& view) {
  return {
      .outcome = outcome_html(view), .tiles = tiles_html(view), .mismatch = mismatch_html(view)};
}

}  // namespace qsmpc::harness
