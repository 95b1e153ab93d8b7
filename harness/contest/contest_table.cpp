#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "harness/contest/contest_results.hpp"
#include "harness/contest/sentences.hpp"
#include "harness/text/number_format.hpp"
#include "harness/text/printable.hpp"
#include "harness/text/text_width.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kControllerWidth = 13;
constexpr std::size_t kLineWidth = 106;
constexpr std::size_t kKeptWidth = 7;
constexpr std::size_t kPromisedWidth = 10;
constexpr std::size_t kBelievedWidth = 9;
constexpr std::size_t kLeftWidth = 6;
constexpr std::size_t kTimeoutWidth = 8;

std::string short_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.2g}", value) : "-";
}

/// "-4 % [-6, -2]": change of the cost relative to the reference; "reference" for the reference
/// itself.
std::string cost_cell(const Standing& standing) {
  if (!standing.versus) return "reference";
  const CostDifference& cost = standing.versus->cost;
  if (!std::isfinite(cost.ratio)) return "-";
  const auto change = [](double ratio) { return format_short(100.0 * (ratio - 1.0), 2); };
  return fmt::format("{} % [{}, {}]", change(cost.ratio), change(cost.ratio_interval.lower),
                     change(cost.ratio_interval.upper));
}

std::string rate_cell(const EpisodeRate& rate) {
  if (!std::isfinite(rate.rate)) return "-";
  return fmt::format("{} [{}, {}]", format_percent(rate.rate), format_percent(rate.interval.lower),
                     format_percent(rate.interval.upper));
}

/// `text`, right-aligned; each character takes one column.
std::string right(const std::string& text, std::size_t width) {
  const auto columns = static_cast<std::size_t>(std::ranges::count_if(
      text, [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; }));
  return (columns < width ? std::string(width - columns, ' ') : "") + text;
}

std::string table_row(const std::string& name, const Standing& standing) {
  const ContestTimes& times = standing.times;
  std::string row = "  " + padded(printable(name, kControllerWidth - 2), kControllerWidth);
  row += right(format_percent(standing.reached.rate), 8);
  row += right(rate_cell(standing.collision), 18);
  if (standing.kept && standing.promised) {
    row += right(format_percent(standing.kept->rate), kKeptWidth);
    row += right(format_percent(standing.promised->rate), kPromisedWidth);
  } else {
    row += right(format_percent(standing.left_bounds.rate), kLeftWidth);
    row += right(format_percent(standing.timeout.rate), kTimeoutWidth);
    row += right(standing.believed.drives == 0 ? "-" : short_number(standing.believed.mean),
                 kBelievedWidth);
  }
  row += right(short_number(standing.certified.mean), 10);
  row += right(cost_cell(standing), 23);
  row += right(times.periods == 0 ? "-" : format_short(times.ocp_ms.median, 2), 6);
  return row + right(times.periods == 0 ? "-" : format_short(times.ocp_ms.p99, 2), 7) + "\n";
}

/// `text`, wrapped and indented by two spaces.
std::string indented(const std::string& text) {
  std::string lines;
  for (const std::string& line : wrapped(text, kLineWidth)) lines += "  " + line + "\n";
  return lines;
}

}  // namespace

std::string contest_table(const ContestResults& results) {
  const Contest& contest = results.contest;
  std::string text = fmt::format("{}: {} of {} drives\n{}\n\n", printable(contest.name, 60),
                                 results.done, results.asked, contest_headline(results));
  // With a limit there is no room for the ways in which drives end without a collision, nor for
  // what controllers believe.
  const std::string judged = contest.risk_limit
                                 ? right("kept", kKeptWidth) + right("promised", kPromisedWidth)
                                 : right("left", kLeftWidth) + right("timeout", kTimeoutWidth) +
                                       right("believed", kBelievedWidth);
  text += "  " + padded("controller", kControllerWidth) + right("reached", 8) +
          right("collided [99 %]", 18) + judged + right("certified", 10) + right("cost", 23) +
          right("ms", 6) + right("99 %", 7) + "\n";
  for (std::size_t n = 0; n < contest.controllers.size(); ++n) {
    text += table_row(contest.controllers[n].name, results.overall[n]);
  }
  text += "\n";
  for (std::size_t n = 0; n < contest.controllers.size(); ++n) {
    text += indented(printable(contest.controllers[n].name, 60) + ": " + words_about(results, n));
  }
  const std::string limit =
      contest.risk_limit
          ? fmt::format(
                "kept: that arrive and are certified at most {0:g} in total. promised: that "
                "arrive, with every plan certified at most {0:g}. certified: its sum",
                *contest.risk_limit)
          : "believed, certified: sums";
  return text + "\n" +
         indented("Shares of drives in %. " + limit +
                  " over a drive. cost: of the drives that arrive, relative to the reference's on "
                  "the same seeds. ms: planning and certifying, one drive at a time.");
}

}  // namespace qsmpc::harness
