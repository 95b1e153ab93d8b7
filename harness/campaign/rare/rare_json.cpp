#include "harness/campaign/rare/rare_json.hpp"

#include <nlohmann/json.hpp>

#include "harness/trace/json_values.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

/// A probability per drive and the corresponding rate per period.
Json rate_json(double of_drive, const RateInterval& interval, double periods) {
  return {{"mean", of_drive},
          {"interval", interval_json(interval)},
          {"per_period", of_drive / periods},
          {"per_period_interval",
           interval_json({.lower = interval.lower / periods, .upper = interval.upper / periods})}};
}

Json runs_json(const RareStatistics& statistics) {
  Json json = Json::array();
  for (const RareEstimate& run : statistics.runs) {
    json.push_back({{"seed", run.seed}, {"probability", run.probability}});
  }
  return json;
}

}  // namespace

Json rare_json(const RareStatistics& statistics) {
  const double periods = statistics.periods_per_drive();
  return {{"unsafe", rate_json(statistics.probability, statistics.interval, periods)},
          {"standard_error", statistics.standard_error},
          {"confidence", 0.99},
          {"limits_of", statistics.limits == RareLimits::kPlain ? "plain_drives" : "estimates"},
          {"collision", statistics.collision},
          {"left_bounds", statistics.left_bounds},
          {"certified", rate_json(statistics.certified, statistics.certified_interval, periods)},
          {"exceeds_certified", statistics.exceeds_certified()},
          {"particles", statistics.particles},
          {"drives", statistics.drives},
          {"periods", statistics.periods},
          {"extinct", statistics.extinct},
          {"below_floor", statistics.below_floor},
          {"plain",
           {{"drives", statistics.plain_drives},
            {"unsafe", statistics.plain_unsafe},
            {"periods", statistics.plain_periods},
            {"faults", statistics.plain_faults}}},
          {"worth",
           {{"plain_drives", statistics.worth_drives},
            {"plain_periods", statistics.worth_periods},
            {"gain", statistics.gain()}}},
          {"runs", runs_json(statistics)}};
}

}  // namespace qsmpc::harness
