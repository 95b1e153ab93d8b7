#include "harness/campaign/statistics/stop_report.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/campaign/plan/campaign_plan.hpp"
#include "harness/statistics/confidence_sequence.hpp"
#include "harness/trace/json_values.hpp"

namespace qsmpc::harness {
namespace {

/// The rate to which the rule applies.
const EpisodeRate& rate_of_rule(const VariantStatistics& variant, const StopCriterion& until) {
  if (until.of == kUnsafeEvent) return variant.unsafe;
  const auto outcome = std::ranges::find(listed_outcomes(), until.of, &ListedOutcome::name);
  return variant.*outcome->rate;
}

}  // namespace

std::string stop_sentence(const CampaignStatistics& statistics) {
  const StoredCampaign& campaign = statistics.campaign;
  if (!campaign.until) return {};
  const StopCriterion& until = *campaign.until;
  const std::int64_t seeds = seeds_from_text(campaign.seeds).size();
  const std::string aim = fmt::format("{} in every variant", until_text(until));
  if (campaign.stopped_after) {
    return fmt::format("Stopped by its rule after {} of at most {} seeds: {}.",
                       *campaign.stopped_after, seeds, aim);
  }
  return fmt::format("At most {} seeds; its stopping rule, {}, has not stopped it.", seeds, aim);
}

std::string interval_words(const CampaignStatistics& statistics) {
  return statistics.campaign.until ? "99 % intervals valid at any number of seeds"
                                   : "99 % intervals";
}

nlohmann::ordered_json stop_json(const CampaignStatistics& statistics) {
  const StopCriterion& until = statistics.campaign.until.value();
  nlohmann::ordered_json json = until_json(until);
  json["stopped_after"] = nullptr;
  if (statistics.campaign.stopped_after) {
    json["stopped_after"] = *statistics.campaign.stopped_after;
  }
  json["variants"] = nlohmann::ordered_json::object();
  for (const VariantStatistics& variant : statistics.variants) {
    const EpisodeRate& rate = rate_of_rule(variant, until);
    json["variants"][variant.name] = {
        {"rate", rate.rate},
        {"interval",
         interval_json(confidence_sequence(rate.events, variant.done, until.confidence))}};
  }
  return json;
}

}  // namespace qsmpc::harness
