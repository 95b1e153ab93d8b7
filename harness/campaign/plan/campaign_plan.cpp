#include "harness/campaign/plan/campaign_plan.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "harness/text/json_text.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kWidestName = 60;  // column width; longer names shift the rest of their line
constexpr std::size_t kLongestText = 1000;  // bytes of a name or its overrides in terminal output
constexpr std::size_t kSeedsShown = 10;     // of a list of seeds

std::string counted(std::int64_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string seeds_in_words(const SeedSet& seeds) {
  if (seeds.listed.empty()) {
    return fmt::format("{} to {}", seeds.first, seeds.at(seeds.size() - 1));
  }
  const auto shown = std::min(seeds.listed.size(), kSeedsShown);
  const auto end = seeds.listed.begin() + static_cast<std::ptrdiff_t>(shown);
  return fmt::format("{}{}", fmt::join(seeds.listed.begin(), end, ", "),
                     shown < seeds.listed.size() ? ", ..." : "");
}

std::string traces_in_words(const Campaign& campaign) {
  std::string text = trace_keeping_name(campaign.traces);
  if (campaign.traces == TraceKeeping::kFailures && campaign.trace_sample > 0) {
    text +=
        fmt::format(", and of each variant the first {}", counted(campaign.trace_sample, "seed"));
  }
  return text;
}

std::string row(const std::string& name, const std::string& value) {
  return fmt::format("  {:<9} {}\n", name, value);
}

}  // namespace

nlohmann::ordered_json until_json(const StopCriterion& until) {
  return {
      {"of", until.of}, {"rate_halfwidth", until.rate_halfwidth}, {"confidence", until.confidence}};
}

std::string campaign_size_text(const Campaign& campaign) {
  return fmt::format("campaign {}: {} x {} = {}", printable(campaign.name),
                     counted(static_cast<std::int64_t>(campaign.variants.size()), "variant"),
                     counted(campaign.seeds.size(), "seed"),
                     counted(campaign.episodes(), "episode"));
}

std::string campaign_plan_text(const Campaign& campaign) {
  std::string text = campaign_size_text(campaign) + "\n\n";
  std::size_t name_width = std::string("variant").size();
  std::size_t plant_width = std::string("plant").size();
  for (const CampaignVariant& variant : campaign.variants) {
    name_width = std::max(name_width, variant.name.size());
    plant_width = std::max(plant_width, variant.plant.size());
  }
  name_width = std::min(name_width, kWidestName);
  plant_width = std::min(plant_width, kWidestName);
  text += fmt::format("  {:>5}  {:<{}}  {:<{}}  overrides\n", "#", "variant", name_width, "plant",
                      plant_width);
  for (std::size_t i = 0; i < campaign.variants.size(); ++i) {
    const CampaignVariant& variant = campaign.variants[i];
    const std::string overrides = fmt::format("{}", fmt::join(variant.overrides, " "));
    text += fmt::format("  {:>5}  {:<{}}  {:<{}}  {}\n", i, printable(variant.name, kLongestText),
                        name_width,
                        variant.plant.empty() ? "-" : printable(variant.plant, kLongestText),
                        plant_width, overrides.empty() ? "-" : printable(overrides, kLongestText));
  }
  text += "\n" + row("seeds", seeds_in_words(campaign.seeds));
  text +=
      row("episodes", fmt::format("{}{}", campaign.until ? "at most " : "", campaign.episodes()));
  if (campaign.until) text += row("until", until_text(campaign.until));
  text += row("traces", traces_in_words(campaign));
  if (campaign.rare) text += row("rare", "of each seed: " + rare_text(campaign));
  return text;
}

std::string campaign_plan_json(const Campaign& campaign) {
  Json json;
  json["campaign"] = campaign.name;
  json["variants"] = Json::array();
  for (const CampaignVariant& variant : campaign.variants) {
    Json item{{"name", variant.name},
              {"scenario", variant.scenario},
              {"settings", variant.settings},
              {"overrides", variant.overrides},
              {"plant", nullptr}};
    if (!variant.plant.empty()) item["plant"] = variant.plant;
    json["variants"].push_back(std::move(item));
  }
  const SeedSet& seeds = campaign.seeds;
  json["seeds"] = seeds.listed.empty() ? Json{{"first", seeds.first}, {"count", seeds.count}}
                                       : Json(seeds.listed);
  json["episodes"] = campaign.episodes();
  if (campaign.until) json["until"] = until_json(*campaign.until);
  json["traces"] = trace_keeping_name(campaign.traces);
  json["trace_sample"] = campaign.trace_sample;
  if (campaign.rare) {
    const SplitSettings& splitting = campaign.rare->splitting;
    json["rare"] = {{"particles", splitting.particles},
                    {"killed", splitting.killed},
                    {"floor", splitting.floor},
                    {"certify", campaign.rare->certify}};
  }
  return json_text(json);
}

}  // namespace qsmpc::harness
