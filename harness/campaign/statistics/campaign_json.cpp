#include "harness/campaign/statistics/campaign_json.hpp"

#include <cstddef>
#include <utility>

#include <nlohmann/json.hpp>

#include "harness/campaign/rare/rare_json.hpp"
#include "harness/campaign/statistics/stop_report.hpp"
#include "harness/text/json_text.hpp"
#include "harness/trace/ending.hpp"
#include "harness/trace/json_values.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

Json spread_json(const Spread& spread) {
  Json json{{"episodes", spread.count},
            {"faults", spread.worst},
            {"mean", spread.mean},
            {"standard_error", spread.standard_error}};
  for (std::size_t i = 0; i < spread_names().size(); ++i) {
    json[spread_names()[i]] = spread.quantiles[i];
  }
  return json;
}

Json bins_json(const std::vector<CalibrationBin>& bins, bool is_bound) {
  Json json = Json::array();
  for (const CalibrationBin& bin : bins) {
    if (bin.periods == 0) continue;
    Json entry{{"lower", bin.lower},
               {"upper", bin.upper},
               {"periods", bin.periods},
               {"mean_certified", bin.mean_certified},
               {"unsafe", bin.unsafe},
               {"rate", bin.rate},
               {"interval", interval_json(bin.interval)}};
    if (is_bound) {
      entry["exceedance_p_value"] = bin.p_value;
      entry["exceeded"] = bin.exceeded;
    }
    json.push_back(std::move(entry));
  }
  return json;
}

Json calibration_json(const std::vector<CalibrationBin>& certified,
                      const std::vector<CalibrationBin>& published) {
  return {{"certified", bins_json(certified, true)}, {"published", bins_json(published, false)}};
}

Json difference_json(const CampaignStatistics& statistics, const VariantDifference& difference) {
  Json json{{"baseline", statistics.variants[difference.pair.baseline].name},
            {"differs_by", differs_by_name(difference.pair.by)}};
  for (const MeanDifference& quantity : difference.quantities) {
    json[quantity.quantity] = {
        {"mean", quantity.mean},     {"interval", interval_json(quantity.interval)},
        {"pairs", quantity.pairs},   {"left_out", quantity.left_out},
        {"higher", quantity.higher}, {"lower", quantity.lower}};
  }
  return json;
}

Json differences_json(const CampaignStatistics& statistics, std::size_t variant) {
  Json json = Json::array();
  for (const VariantDifference& difference : statistics.differences) {
    if (difference.pair.variant == variant) {
      json.push_back(difference_json(statistics, difference));
    }
  }
  return json;
}

Json outcomes_json(const std::map<std::string, std::int64_t>& outcomes) {
  Json json = Json::object();
  for (const auto& [outcome, count] : in_order(outcomes)) json[outcome] = count;
  return json;
}

Json times_json(const VariantStatistics& variant) {
  const Distribution& times = variant.ocp_ms;
  return {{"median", times.median}, {"p95", times.p95},
          {"p99", times.p99},       {"max", times.max},
          {"mean", times.mean},     {"deadline_misses", variant.deadline_misses}};
}

Json variant_json(const CampaignStatistics& statistics, std::size_t number) {
  const VariantStatistics& variant = statistics.variants[number];
  Json json{{"scenario", variant.scenario}, {"settings", variant.settings},
            {"plant", variant.plant},       {"episodes", variant.episodes},
            {"done", variant.done},         {"outcomes", outcomes_json(variant.outcomes)}};
  for (const ListedOutcome& outcome : listed_outcomes()) {
    const EpisodeRate& rate = variant.*outcome.rate;
    json[outcome.name + "_rate"] = rate.rate;
    json[outcome.name + "_interval"] = interval_json(rate.interval);
  }
  json.update({{"empirical",
                {{"unsafe_rate", variant.unsafe.rate},
                 {"unsafe_interval", interval_json(variant.unsafe.interval)}}},
               {"risk_exceeded", variant.risk_exceeded},
               {"cost", spread_json(variant.cost)},
               {"min_clearance", spread_json(variant.min_clearance)},
               {"time_to_target", spread_json(variant.time_to_target)},
               {"periods", variant.periods},
               {"unsafe_periods", variant.unsafe_periods},
               {"unsafe_step_rate", variant.unsafe_step_rate()},
               {"certified_step_rate", variant.certified_step_rate()},
               {"believed_step_rate", variant.believed_step_rate()},
               {"exceedance_p_value", variant.p_value},
               {"certificate", scope_json(variant.no_bound)},
               {"calibration", calibration_json(variant.calibration, variant.published)},
               {"differences", differences_json(statistics, number)},
               {"ocp_ms", times_json(variant)}});
  if (variant.rare) json["rare"] = rare_json(*variant.rare);
  return json;
}

Json mean_json(const DriveMean& mean) {
  return {{"drives", mean.drives}, {"mean", mean.mean}, {"interval", interval_json(mean.interval)}};
}

Json point_json(const VariantStatistics& variant, const TradeoffPoint& point) {
  return {{"variant", variant.name},
          {"settings", variant.settings},
          {"done", variant.done},
          {"reached", variant.reached.events},
          {"timeout", variant.timeout.events},
          {"unsafe", variant.unsafe.events},
          {"unsafe_rate", variant.unsafe.rate},
          {"unsafe_interval", interval_json(variant.unsafe.interval)},
          {"certified", mean_json(point.certified)},
          {"reached_cost", mean_json(point.cost)}};
}

Json tradeoff_json(const CampaignStatistics& statistics) {
  Json json = Json::array();
  for (const TradeoffPanel& panel : statistics.tradeoff) {
    Json families = Json::object();
    for (const TradeoffFamily& family : panel.families) {
      Json points = Json::array();
      for (const TradeoffPoint& point : family.points) {
        points.push_back(point_json(statistics.variants[point.variant], point));
      }
      families[family.name] = std::move(points);
    }
    json.push_back(
        {{"scenario", panel.scenario}, {"plant", panel.plant}, {"families", std::move(families)}});
  }
  return json;
}

}  // namespace

std::string campaign_json(const CampaignStatistics& statistics) {
  const StoredCampaign& campaign = statistics.campaign;
  Json json{{"name", campaign.name},
            {"version", campaign.version},
            {"seeds", campaign.seeds},
            {"shard", {campaign.shard.index, campaign.shard.count}},
            {"episodes", campaign.episodes},
            {"done", statistics.done},
            {"outcomes", outcomes_json(statistics.outcomes)}};
  if (campaign.until) json["until"] = stop_json(statistics);
  json["variants"] = Json::object();
  for (std::size_t n = 0; n < statistics.variants.size(); ++n) {
    json["variants"][statistics.variants[n].name] = variant_json(statistics, n);
  }
  json["exceedance_p_value"] = statistics.p_value;
  json["calibration"] = calibration_json(statistics.calibration, statistics.published);
  if (!statistics.tradeoff.empty()) json["tradeoff"] = tradeoff_json(statistics);
  return json_text(json);
}

}  // namespace qsmpc::harness
