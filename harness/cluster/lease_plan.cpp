#include "harness/cluster/lease_plan.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/campaign/runner.hpp"
#include "harness/cluster/shared_files.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/files/text_file.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/text/json_text.hpp"
#include "harness/version.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kPlanFormat = 1;

Json families_json(const std::vector<VariantFamily>& families) {
  Json json = Json::array();
  for (const VariantFamily& family : families) {
    json.push_back({{"name", family.name}, {"settings", family.settings}});
  }
  return json;
}

Json variant_json(const StoredVariant& variant, const std::vector<std::string>& overrides) {
  return {{"name", variant.name},
          {"scenario", variant.scenario},
          {"settings", variant.settings},
          {"overrides", overrides},
          {"plant", variant.plant},
          {"plant_digest", variant.plant_digest},
          {"resolved", variant.scenario_text}};
}

Json until_json(const std::optional<StopCriterion>& until) {
  if (!until) return nullptr;
  return {{"of", until->of},
          {"rate_halfwidth", until->rate_halfwidth},
          {"confidence", until->confidence}};
}

std::optional<StopCriterion> until_of(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return StopCriterion{.of = json.at("of"),
                       .rate_halfwidth = json.at("rate_halfwidth"),
                       .confidence = json.at("confidence")};
}

Json plan_json(const LeasePlan& plan) {
  const StoredCampaign& campaign = plan.identity.campaign;
  Json variants = Json::array();
  for (std::size_t n = 0; n < plan.identity.variants.size(); ++n) {
    variants.push_back(variant_json(plan.identity.variants[n], plan.overrides[n]));
  }
  return {{"format", kPlanFormat},
          {"version", campaign.version},
          {"name", campaign.name},
          {"seeds", campaign.seeds},
          {"lease_seeds", plan.lease_seeds},
          {"leases", plan.leases()},
          {"episodes", campaign.episodes},
          {"traces", trace_keeping_name(plan.traces)},
          {"trace_sample", plan.trace_sample},
          {"until", until_json(campaign.until)},
          {"risk_against_cost", families_json(campaign.risk_against_cost)},
          {"variants", std::move(variants)}};
}

TraceKeeping trace_keeping_called(const std::string& name) {
  for (const TraceKeeping keeping :
       {TraceKeeping::kNone, TraceKeeping::kFailures, TraceKeeping::kAll}) {
    if (name == trace_keeping_name(keeping)) return keeping;
  }
  throw std::invalid_argument("traces: " + name);
}

LeasePlan plan_of(const Json& json) {
  LeasePlan plan;
  for (const Json& variant : json.at("variants")) {
    plan.identity.variants.push_back({.id = std::ssize(plan.identity.variants),
                                      .name = variant.at("name"),
                                      .scenario = variant.at("scenario"),
                                      .settings = variant.at("settings"),
                                      .plant = variant.at("plant"),
                                      .scenario_text = variant.at("resolved"),
                                      .plant_digest = variant.at("plant_digest")});
    plan.overrides.push_back(variant.at("overrides"));
  }
  plan.traces = trace_keeping_called(json.at("traces"));
  plan.trace_sample = json.at("trace_sample");
  plan.seeds = seeds_from_text(json.at("seeds"));
  plan.lease_seeds = json.at("lease_seeds");
  if (plan.lease_seeds < 1) throw std::invalid_argument("lease_seeds: less than 1");
  StoredCampaign& campaign = plan.identity.campaign;
  campaign.name = json.at("name");
  for (const Json& family : json.at("risk_against_cost")) {
    campaign.risk_against_cost.push_back(
        {.name = family.at("name"), .settings = family.at("settings")});
  }
  campaign.until = until_of(json.at("until"));
  campaign = stored_campaign(campaign_outline(plan), {});
  campaign.version = json.at("version");
  return plan;
}

}  // namespace

Campaign campaign_outline(const LeasePlan& plan) {
  const StoredCampaign& stored = plan.identity.campaign;
  Campaign campaign{.name = stored.name,
                    .variants = {},
                    .seeds = plan.seeds,
                    .traces = plan.traces,
                    .trace_sample = plan.trace_sample,
                    .risk_against_cost = stored.risk_against_cost,
                    .until = stored.until};
  for (std::size_t n = 0; n < plan.identity.variants.size(); ++n) {
    const StoredVariant& variant = plan.identity.variants[n];
    campaign.variants.push_back({.name = variant.name,
                                 .scenario = variant.scenario,
                                 .settings = variant.settings,
                                 .overrides = plan.overrides[n],
                                 .plant = variant.plant,
                                 .resolved = {}});
  }
  return campaign;
}

std::string cluster_path(const std::string& folder, const std::string& name) {
  return fmt::format("{}/{}/{}", folder, kClusterFolder, name);
}

std::int64_t default_lease_seeds(std::int64_t seeds, std::int64_t at_once) {
  constexpr std::int64_t kLeasesEach = 16;
  constexpr std::int64_t kMostSeeds = 64;
  constexpr std::int64_t kManyLeases = kMostLeases / 10;
  const std::int64_t fair = seeds / (kLeasesEach * std::max<std::int64_t>(at_once, 1));
  return std::max(std::clamp<std::int64_t>(fair, 1, kMostSeeds),
                  (seeds + kManyLeases - 1) / kManyLeases);
}

LeasePlan lease_plan(const Campaign& campaign, std::int64_t lease_seeds) {
  LeasePlan plan{.identity = {.campaign = stored_campaign(campaign, {}),
                              .variants = stored_variants(campaign, plant_digests(campaign))},
                 .traces = campaign.traces,
                 .trace_sample = campaign.trace_sample,
                 .seeds = campaign.seeds,
                 .lease_seeds = lease_seeds};
  for (const CampaignVariant& variant : campaign.variants) {
    plan.overrides.push_back(variant.overrides);
  }
  if (plan.leases() > kMostLeases) {
    throw InputError(
        {.key = "--lease",
         .found = fmt::format("{} seeds in leases of {}", plan.seeds.size(), plan.lease_seeds),
         .expected = fmt::format("at most {} leases", kMostLeases)});
  }
  return plan;
}

Campaign planned_campaign(const LeasePlan& plan, const std::string& folder) {
  const std::string path = cluster_path(folder, kPlanFile);
  Campaign campaign = campaign_outline(plan);
  for (std::size_t n = 0; n < campaign.variants.size(); ++n) {
    const StoredVariant& variant = plan.identity.variants[n];
    campaign.variants[n].resolved = parse_scenario(
        variant.scenario_text, {.file = path + ", variant " + variant.name, .folder = folder});
  }
  refuse_other_campaign(path, plan.identity,
                        {.campaign = stored_campaign(campaign, {}),
                         .variants = stored_variants(campaign, plant_digests(campaign))},
                        " on this machine");
  return campaign;
}

void write_lease_plan(const LeasePlan& plan, const std::string& folder) {
  for (const char* name : {kClaimsFolder, kFinishedFolder, kTasksFolder}) {
    make_durable_folder(cluster_path(folder, name), folder);
  }
  write_file(cluster_path(folder, kPlanFile), json_text(plan_json(plan)));
}

bool has_lease_plan(const std::string& folder) { return is_file(cluster_path(folder, kPlanFile)); }

LeasePlan read_lease_plan(const std::string& folder) {
  const std::string path = cluster_path(folder, kPlanFile);
  const std::optional<std::string> text = read_shared_file(path);
  if (!text) {
    throw InputError({.file = path,
                      .found = "no task plan",
                      .expected = "the folder that qsmpc campaign FILE --on … writes"});
  }
  try {
    const Json json = Json::parse(*text);
    if (json.at("format") != kPlanFormat) {
      throw InputError({.file = path,
                        .found = "a task plan of format " + json.at("format").dump(),
                        .expected = fmt::format("format {}", kPlanFormat)});
    }
    return plan_of(json);
  } catch (const Json::exception& error) {
    throw InputError({.file = path, .found = error.what(), .expected = "a task plan"});
  } catch (const std::invalid_argument& error) {
    throw InputError({.file = path, .found = error.what(), .expected = "a task plan"});
  }
}

}  // namespace qsmpc::harness
