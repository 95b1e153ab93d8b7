#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "harness/contest/contest_results.hpp"
#include "harness/text/csv.hpp"

namespace qsmpc::harness {
namespace {

using RateMember = EpisodeRate Standing::*;
constexpr std::array<std::pair<const char*, RateMember>, 6> kRates{
    {{"reached", &Standing::reached},
     {"collision", &Standing::collision},
     {"left_bounds", &Standing::left_bounds},
     {"timeout", &Standing::timeout},
     {"fault", &Standing::fault},
     {"unsafe", &Standing::unsafe}}};
using MeanMember = DriveMean Standing::*;
constexpr std::array<std::pair<const char*, MeanMember>, 3> kMeans{
    {{"believed", &Standing::believed},
     {"certified", &Standing::certified},
     {"cost", &Standing::cost}}};
constexpr std::array kShareColumns{"pairs",          "mean",    "interval.lower",
                                   "interval.upper", "p_value", "result"};
constexpr std::array kCostColumns{"pairs",
                                  "mean",
                                  "interval.lower",
                                  "interval.upper",
                                  "ratio",
                                  "ratio_interval.lower",
                                  "ratio_interval.upper",
                                  "result"};

std::string cell_of(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

std::string limits_of(const RateInterval& interval) {
  return cell_of(interval.lower) + "," + cell_of(interval.upper);
}

std::string rate_heads(const char* name) {
  return fmt::format(",{0}.drives,{0}.rate,{0}.interval.lower,{0}.interval.upper", name);
}

std::string head_line() {
  std::string head = "scenario,plant,noise,controller,drives";
  for (const auto& [name, member] : kRates) head += rate_heads(name);
  for (const char* name : {"kept", "promised"}) head += rate_heads(name);
  for (const auto& [name, member] : kMeans) {
    head += fmt::format(",{0}.drives,{0}.mean,{0}.interval.lower,{0}.interval.upper", name);
  }
  for (const char* share : {"reached", "unsafe"}) {
    for (const char* column : kShareColumns) head += fmt::format(",versus.{}.{}", share, column);
  }
  for (const char* column : kCostColumns) head += fmt::format(",versus.cost.{}", column);
  return head +
         ",ocp_ms.periods,ocp_ms.late,ocp_ms.median,ocp_ms.p95,ocp_ms.p99,ocp_ms.max,"
         "ocp_ms.mean\n";
}

std::string rate_cells(const EpisodeRate& rate) {
  return fmt::format(",{},{},{}", rate.events, cell_of(rate.rate), limits_of(rate.interval));
}

std::string share_cells(const ShareDifference& share, MatchResult result) {
  return fmt::format(",{},{},{},{},{}", share.pairs, cell_of(share.mean), limits_of(share.interval),
                     cell_of(share.p_value), match_result_name(result));
}

std::string versus_cells(const std::optional<Versus>& versus) {
  if (!versus) return std::string(2 * kShareColumns.size() + kCostColumns.size(), ',');
  const CostDifference& cost = versus->cost;
  return share_cells(versus->reached, versus->arrival()) +
         share_cells(versus->unsafe, versus->safety()) +
         fmt::format(",{},{},{},{},{},{}", cost.pairs, cell_of(cost.mean), limits_of(cost.interval),
                     cell_of(cost.ratio), limits_of(cost.ratio_interval),
                     match_result_name(versus->economy()));
}

std::string times_cells(const ContestTimes& times) {
  if (times.periods == 0) return ",,,,,,,";
  const Distribution& ms = times.ocp_ms;
  return fmt::format(",{},{},{},{},{},{},{}", times.periods, times.late, cell_of(ms.median),
                     cell_of(ms.p95), cell_of(ms.p99), cell_of(ms.max), cell_of(ms.mean));
}

std::string standing_line(const std::string& where, const std::string& controller,
                          const Standing& standing) {
  std::string line = fmt::format("{},{},{}", where, csv_field(controller), standing.drives);
  for (const auto& [name, member] : kRates) line += rate_cells(standing.*member);
  for (const auto& rate : {standing.kept, standing.promised}) {
    line += rate ? rate_cells(*rate) : ",,,,";
  }
  for (const auto& [name, member] : kMeans) {
    const DriveMean& mean = standing.*member;
    line += fmt::format(",{},{},{}", mean.drives, cell_of(mean.mean), limits_of(mean.interval));
  }
  return line + versus_cells(standing.versus) + times_cells(standing.times) + "\n";
}

}  // namespace

std::string contest_csv(const ContestResults& results) {
  const Contest& contest = results.contest;
  std::string csv = head_line();
  for (std::size_t n = 0; n < results.overall.size(); ++n) {
    csv += standing_line(",,", contest.controllers[n].name, results.overall[n]);
  }
  for (const CellStandings& cell : results.cells) {
    const std::string where = fmt::format(
        "{},{},{}", csv_field(contest.scenarios[cell.cell.scenario].text),
        csv_field(contest.plants[cell.cell.plant].text), contest.noise[cell.cell.noise]);
    for (std::size_t n = 0; n < cell.standings.size(); ++n) {
      csv += standing_line(where, contest.controllers[n].name, cell.standings[n]);
    }
  }
  return csv;
}

}  // namespace qsmpc::harness
