#include "harness/campaign/statistics/campaign_csv.hpp"

#include <cmath>
#include <concepts>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

#include "harness/text/csv.hpp"

namespace qsmpc::harness {
namespace {

std::string field(const std::string& text) { return csv_field(text); }
std::string field(const char* text) { return csv_field(text); }
std::string field(bool value) { return value ? "1" : "0"; }
std::string field(std::integral auto value) { return fmt::format("{}", value); }
std::string field(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }
template <class Value>
std::string field(const std::optional<Value>& value) {
  return value ? field(*value) : "";
}

/// A line of comma-separated values.
template <class First, class... Rest>
std::string line_of(const First& first, const Rest&... rest) {
  std::string line = field(first);
  ((line += "," + field(rest)), ...);
  return line + "\n";
}

std::string without_end(std::string line) {
  line.pop_back();
  return line;
}

std::string spread_head(const std::string& name) {
  std::string head = fmt::format(",{0}.episodes,{0}.faults,{0}.mean,{0}.standard_error", name);
  for (const std::string& quantile : spread_names()) head += fmt::format(",{}.{}", name, quantile);
  return head;
}

std::string spread_fields(const Spread& spread) {
  std::string fields =
      "," + without_end(line_of(spread.count, spread.worst, spread.mean, spread.standard_error));
  for (const double quantile : spread.quantiles) fields += "," + field(quantile);
  return fields;
}

std::string rate_head(const std::string& name) {
  return fmt::format(",{0},{0}_rate,{0}_interval.lower,{0}_interval.upper", name);
}

std::string rate_fields(const EpisodeRate& rate) {
  return "," +
         without_end(line_of(rate.events, rate.rate, rate.interval.lower, rate.interval.upper));
}

std::string variant_line(const VariantStatistics& variant) {
  const Distribution& times = variant.ocp_ms;
  std::string line = without_end(line_of(variant.name, variant.scenario, variant.settings,
                                         variant.plant, variant.episodes, variant.done));
  for (const ListedOutcome& outcome : listed_outcomes()) line += rate_fields(variant.*outcome.rate);
  return line + rate_fields(variant.unsafe) + "," + field(variant.risk_exceeded) +
         spread_fields(variant.cost) + spread_fields(variant.min_clearance) +
         spread_fields(variant.time_to_target) + "," +
         line_of(variant.periods, variant.unsafe_periods, variant.unsafe_step_rate(),
                 variant.certified_step_rate(), variant.believed_step_rate(), variant.p_value,
                 times.median, times.p95, times.p99, times.max, times.mean,
                 variant.deadline_misses);
}

std::string bin_lines(const std::string& variant, const char* what,
                      const std::vector<CalibrationBin>& bins, bool is_bound) {
  std::string lines;
  for (const CalibrationBin& bin : bins) {
    if (bin.periods == 0) continue;
    lines +=
        without_end(line_of(variant, what, bin.lower, bin.upper, bin.periods, bin.mean_certified,
                            bin.unsafe, bin.rate, bin.interval.lower, bin.interval.upper));
    lines += is_bound ? "," + line_of(bin.p_value, bin.exceeded) : ",,\n";
  }
  return lines;
}

std::string calibration_lines(const std::string& variant,
                              const std::vector<CalibrationBin>& certified,
                              const std::vector<CalibrationBin>& published) {
  return bin_lines(variant, "certified", certified, true) +
         bin_lines(variant, "published", published, false);
}

}  // namespace

std::string variants_csv(const CampaignStatistics& statistics) {
  std::string csv = "variant,scenario,settings,plant,episodes,done";
  for (const ListedOutcome& outcome : listed_outcomes()) csv += rate_head(outcome.name);
  csv += rate_head("unsafe") + ",risk_exceeded";
  csv += spread_head("cost") + spread_head("min_clearance") + spread_head("time_to_target");
  csv +=
      ",periods,unsafe_periods,unsafe_step_rate,certified_step_rate,believed_step_rate,"
      "exceedance_p_value,"
      "ocp_ms.median,ocp_ms.p95,ocp_ms.p99,ocp_ms.max,ocp_ms.mean,ocp_ms.deadline_misses\n";
  for (const VariantStatistics& variant : statistics.variants) csv += variant_line(variant);
  return csv;
}

std::string differences_csv(const CampaignStatistics& statistics) {
  std::string csv =
      "variant,baseline,differs_by,quantity,mean,interval.lower,interval.upper,pairs,left_out,"
      "higher,lower\n";
  for (const VariantDifference& difference : statistics.differences) {
    for (const MeanDifference& quantity : difference.quantities) {
      csv += line_of(statistics.variants[difference.pair.variant].name,
                     statistics.variants[difference.pair.baseline].name,
                     differs_by_name(difference.pair.by), quantity.quantity, quantity.mean,
                     quantity.interval.lower, quantity.interval.upper, quantity.pairs,
                     quantity.left_out, quantity.higher, quantity.lower);
    }
  }
  return csv;
}

std::string calibration_csv(const CampaignStatistics& statistics) {
  std::string csv =
      "variant,value,lower,upper,periods,mean_certified,unsafe,rate,interval.lower,interval.upper,"
      "exceedance_p_value,exceeded\n";
  csv += calibration_lines("", statistics.calibration, statistics.published);
  for (const VariantStatistics& variant : statistics.variants) {
    csv += calibration_lines(variant.name, variant.calibration, variant.published);
  }
  return csv;
}

std::string episodes_csv_head() {
  return "variant,seed,outcome,fault,steps,time_to_target,unsafe,min_clearance,cost,next_step_max,"
         "next_step_sum,horizon_max,thesis_max,iterations_median,fallbacks,risk_exceeded,"
         "believed_max,believed_sum,trace,version,"
         "finished_at,wall_ms,deadline_misses\n";
}

std::string episodes_csv_line(const StoredVariant& variant, const EpisodeRow& row) {
  return line_of(variant.name, row.seed, row.outcome, row.fault, row.steps, row.time_to_target,
                 row.unsafe, row.min_clearance, row.cost, row.next_step_max, row.next_step_sum,
                 row.horizon_max, row.thesis_max, row.iterations_median, row.fallbacks,
                 row.risk_exceeded, row.believed_max, row.believed_sum, row.trace, row.version,
                 row.timing.finished_at, row.timing.wall_ms, row.timing.deadline_misses);
}

}  // namespace qsmpc::harness
