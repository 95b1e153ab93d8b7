#include "harness/report/contest_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/contest/sentences.hpp"
#include "harness/figures/svg_chart.hpp"
#include "harness/report/contest_charts.hpp"
#include "harness/report/page_frame.hpp"
#include "harness/report/table_page.hpp"
#include "harness/text/html.hpp"
#include "harness/text/number_format.hpp"

namespace qsmpc::harness {
namespace {

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string contest_head(const ContestResults& results) {
  const Contest& contest = results.contest;
  std::string html = "<h1>" + escape_html(contest.name) + "</h1>\n";
  html += fmt::format(
      "<p class=\"kicker\">{}{}, {}, {}, {}, seeds {}: {} of {} drives</p>\n",
      contest.description.empty() ? "" : escape_html(contest.description) + ". ",
      counted(contest.controllers.size(), "controller"), counted(contest.scenarios.size(), "map"),
      counted(contest.plants.size(), "plant"), counted(contest.noise.size(), "noise level"),
      escape_html(seeds_text(contest.seeds)), results.done, results.asked);
  return html + "<p class=\"lead\">" + escape_html(contest_headline(results)) + "</p>\n";
}

std::string share_alone_html(const EpisodeRate& rate) {
  if (!std::isfinite(rate.rate)) return "–";
  return escape_html(format_percent(rate.rate)) + " %";
}

/// Highlighted unless 0.
std::string failure_share_html(const EpisodeRate& rate) {
  const std::string share = share_alone_html(rate);
  return rate.events > 0 ? "<strong class=\"alarm\">" + share + "</strong>" : share;
}

/// "1.5 % [0.1, 6]".
std::string failure_share_with_interval_html(const EpisodeRate& rate) {
  if (!std::isfinite(rate.rate)) return "–";
  return fmt::format("{} <span class=\"soft\">[{}, {}]</span>", failure_share_html(rate),
                     escape_html(format_percent(rate.interval.lower)),
                     escape_html(format_percent(rate.interval.upper)));
}

const char* mark_of(MatchResult result) {
  switch (result) {
    case MatchResult::kWin:
      return "<span class=\"win\" title=\"better than the reference\">▲</span> ";
    case MatchResult::kLoss:
      return "<span class=\"alarm\" title=\"worse than the reference\">▼</span> ";
    case MatchResult::kTie:
      break;
  }
  return "";
}

std::string signed_short(double value) { return (value > 0.0 ? "+" : "") + number_html(value); }

/// "+3.5 [1, 6]", in percentage points.
std::string share_versus_html(const std::optional<Versus>& versus) {
  if (!versus) return "<span class=\"soft\">reference</span>";
  const ShareDifference& unsafe = versus->unsafe;
  if (unsafe.pairs == 0) return "–";
  return fmt::format("{}{} <span class=\"soft\">[{}, {}]</span>", mark_of(versus->safety()),
                     signed_short(100.0 * unsafe.mean), number_html(100.0 * unsafe.interval.lower),
                     number_html(100.0 * unsafe.interval.upper));
}

/// "−8 % [−11, −5]".
std::string ratio_html(const std::optional<Versus>& versus) {
  if (!versus) return "<span class=\"soft\">reference</span>";
  const CostDifference& cost = versus->cost;
  if (!std::isfinite(cost.ratio)) return "–";
  const auto change = [](double ratio) { return format_short(100.0 * (ratio - 1.0), 2); };
  return fmt::format("{}{}{} % <span class=\"soft\">[{}, {}]</span>", mark_of(versus->economy()),
                     cost.ratio > 1.0 ? "+" : "", change(cost.ratio),
                     change(cost.ratio_interval.lower), change(cost.ratio_interval.upper));
}

std::string sum_html(const DriveMean& mean) {
  return mean.drives == 0 ? "–" : number_html(mean.mean);
}

std::string certified_html(const Standing& standing) {
  return sum_html(standing.certified) +
         (standing.no_bound.empty() ? "" : " <strong>no bound</strong>");
}

std::vector<std::string> time_cells(const ContestTimes& times) {
  if (times.periods == 0) return {"–", "–"};
  return {format_short(times.ocp_ms.median, 2),
          format_short(times.ocp_ms.p99, 2) +
              (times.late > 0 ? fmt::format(" <strong class=\"alarm\">{} late</strong>", times.late)
                              : "")};
}

/// The first cells of a row of either table, after its header. `collided`: formats the share of
/// collisions.
std::vector<std::string> outcome_cells(const Standing& standing,
                                       std::string (*collided)(const EpisodeRate&)) {
  return {share_alone_html(standing.reached), collided(standing.collision),
          share_alone_html(standing.left_bounds), share_alone_html(standing.timeout)};
}

std::vector<std::string> outcome_heads() {
  return {"reached", "collided", "left bounds", "timeout"};
}

void append(std::vector<std::string>& row, std::vector<std::string> cells) {
  std::ranges::move(cells, std::back_inserter(row));
}

/// The last cells of a row of either table.
std::vector<std::string> merit_cells(const Standing& standing) {
  std::vector<std::string> cells = {share_versus_html(standing.versus), sum_html(standing.believed),
                                    certified_html(standing)};
  for (const auto& rate : {standing.kept, standing.promised}) {
    if (rate) cells.push_back(share_alone_html(*rate));
  }
  cells.push_back(ratio_html(standing.versus));
  append(cells, time_cells(standing.times));
  return cells;
}

std::vector<std::string> merit_heads(const ContestResults& results) {
  std::vector<std::string> heads = {"unsafe, vs reference", "believed", "certified"};
  if (results.contest.risk_limit) append(heads, {"kept", "promised"});
  append(heads, {"cost, vs reference", "ms", "99 %"});
  return heads;
}

bool has_faults(const ContestResults& results) {
  return std::ranges::any_of(results.overall,
                             [](const Standing& standing) { return standing.fault.events > 0; });
}

std::string overall_table(const ContestResults& results) {
  PageTable table{.label = "All drives, by controller", .heads = {"controller"}, .rows = {}};
  append(table.heads, outcome_heads());
  if (has_faults(results)) table.heads.emplace_back("fault");
  append(table.heads, merit_heads(results));
  for (std::size_t n = 0; n < results.overall.size(); ++n) {
    const Standing& standing = results.overall[n];
    std::vector<std::string> row = {escape_html(results.contest.controllers[n].name)};
    append(row, outcome_cells(standing, failure_share_with_interval_html));
    if (has_faults(results)) row.push_back(share_alone_html(standing.fault));
    append(row, merit_cells(standing));
    table.rows.push_back(std::move(row));
  }
  return table_html(table);
}

std::string overall_note(const ContestResults& results) {
  const std::string reference =
      escape_html(results.contest.controllers[results.contest.reference].name);
  std::string note = fmt::format(
      "<p class=\"note\">In brackets: 99 % intervals. Unsafe, vs reference: share of drives that "
      "collided or left the bounds, minus that of {0} on the same seeds, in percentage points. "
      "Believed and certified: sums over a drive of the probabilities that the next state is "
      "unsafe, according to the controller itself and to its certificates. {1}Cost: of drives that "
      "arrive, relative to {0} on the seeds on which both arrive. ",
      reference,
      results.contest.risk_limit
          ? fmt::format("Kept: drives that arrive and are certified at most {0:g} in this sum; "
                        "promised: with every plan certified at most {0:g}. ",
                        *results.contest.risk_limit)
          : "");
  note += results.timed
              ? fmt::format(
                    "ms: time to plan and certify a period, from {} driven one at a time on one "
                    "core, median and 99th percentile. ",
                    counted(static_cast<std::size_t>(std::min(results.contest.timing_seeds,
                                                              results.contest.seeds.size())),
                            "seed"))
              : "Times have not been measured yet. ";
  return note + "▲ and ▼: better and worse at the 1 % significance level.</p>\n";
}

std::string words_card(const ContestResults& results) {
  std::string html = "<div class=\"card rivals\"><h2>What the numbers say</h2>\n<ul>\n";
  for (std::size_t n = 0; n < results.overall.size(); ++n) {
    html += fmt::format("<li><strong>{}</strong>. {}</li>\n",
                        escape_html(results.contest.controllers[n].name),
                        escape_html(words_about(results, n)));
  }
  return html + "</ul></div>\n";
}

std::string first_screen(const ContestResults& results) {
  const std::vector<Chart> charts = contest_charts(results);
  const std::string figure =
      charts.empty() ? "<p class=\"note\">No drive of any controller arrives, so there is no cost "
                       "to draw.</p>\n"
                     : chart_figure(charts.front());
  return "<div class=\"contest\">\n" + figure + words_card(results) + "</div>\n" +
         overall_table(results) + overall_note(results);
}

std::string cells_section(const ContestResults& results) {
  if (results.cells.size() < 2) return {};
  PageTable table{
      .label = "By map, plant and noise", .heads = {"map"}, .rows = {}, .text_columns = {1}};
  append(table.heads, {"controller"});
  append(table.heads, outcome_heads());
  append(table.heads, merit_heads(results));
  for (const CellStandings& cell : results.cells) {
    for (std::size_t n = 0; n < cell.standings.size(); ++n) {
      const Standing& standing = cell.standings[n];
      const std::string name = escape_html(cell.name);
      std::vector<std::string> row = {n == 0 ? name : "<span class=\"soft\">" + name + "</span>",
                                      escape_html(results.contest.controllers[n].name)};
      append(row, outcome_cells(standing, failure_share_html));
      append(row, merit_cells(standing));
      table.rows.push_back(std::move(row));
    }
  }
  std::string charts;
  for (const Chart& chart : cell_charts(results)) charts += chart_figure(chart);
  return section_head(
             "Each map, plant and noise",
             "Left and down is better. Whiskers are 99 % intervals; a controller without "
             "an unsafe drive stands at 0, left of the break. Costs are means over the "
             "drives that arrive: a controller that arrives only from easy starts looks cheaper "
             "than it is, so the table compares the seeds on which both arrive. contest.csv has "
             "all intervals.") +
         fmt::format("<div class=\"grid{}\">\n", results.cells.size() % 3 == 0 ? " thirds" : "") +
         charts + "</div>\n" + table_html(table);
}

std::string settings_html(const std::vector<CampaignSetting>& settings) {
  if (settings.empty()) return "–";
  std::string html;
  for (const CampaignSetting& setting : settings) {
    html += (html.empty() ? "<code>" : "<br/><code>") + escape_html(setting.text) + "</code>";
  }
  return html;
}

/// The candidates tried for a controller with several.
std::string tried_table(const Contest& contest, const ContestController& controller,
                        const std::vector<TriedCandidate>& tried, std::size_t chosen) {
  PageTable table{.label = "Candidates of " + controller.name,
                  .heads = {"candidate", "drives", failure_words(contest), "cost, relative", ""},
                  .rows = {},
                  .text_columns = {4}};
  for (const TriedCandidate& one : tried) {
    table.rows.push_back({settings_html(controller.candidates[one.candidate].settings),
                          fmt::format("{}", one.drives), fmt::format("{}", one.failures),
                          number_html(one.relative_cost),
                          one.candidate == chosen ? "<strong>chosen</strong>" : ""});
  }
  return fmt::format("<details class=\"more\"><summary>{}: {} of {} candidates tried</summary>\n",
                     escape_html(controller.name), tried.size(), controller.grid) +
         table_html(table) + "</details>\n";
}

std::string tuning_section(const ContestResults& results) {
  const Contest& contest = results.contest;
  PageTable table{.label = "Settings of the controllers",
                  .heads = {"controller", "settings", "chosen by the search"},
                  .rows = {},
                  .text_columns = {1, 2}};
  std::string tried;
  for (std::size_t n = 0; n < contest.controllers.size(); ++n) {
    const ContestController& controller = contest.controllers[n];
    const std::size_t chosen = results.tuning.choice[n];
    table.rows.push_back({escape_html(controller.name), settings_html(controller.settings),
                          settings_html(controller.candidates[chosen].settings)});
    if (results.tuning.tried[n].empty()) continue;
    tried += tried_table(contest, controller, results.tuning.tried[n], chosen);
  }
  std::string note =
      "Every controller gets the same model, bounds, cost, horizon and time, the "
      "same starts and the same disturbances.";
  if (contest.tuning) {
    note += fmt::format(
        " For each, up to {} were tried on the seeds {}, which the table does not contain: {}.",
        counted(static_cast<std::size_t>(contest.tuning->budget), "candidate"),
        seeds_text(contest.tuning->seeds), tuning_criterion(contest));
  }
  std::string common;
  if (!contest.common.empty()) {
    common = "<p class=\"note\">Common to all: " + settings_html(contest.common) + "</p>\n";
  }
  return section_head("Settings, and how they were chosen", note) + common + table_html(table) +
         tried;
}

}  // namespace

std::string contest_page(const ContestResults& results) {
  return framed_page(
      {.title = results.contest.name, .version = results.version, .kind = PageKind::kTables},
      contest_head(results) + first_screen(results) + cells_section(results) +
          tuning_section(results) +
          "<p class=\"note\">All drives, with maps and the worst ones: "
          "<a href=\"./report.html\">report.html</a>. All numbers: "
          "<a href=\"./contest.json\">contest.json</a>, "
          "<a href=\"./contest.csv\">contest.csv</a>.</p>\n");
}

}  // namespace qsmpc::harness
