#include "harness/campaign/stopping.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "harness/errors.hpp"

namespace qsmpc::harness {

StopRule stop_rule_of(const Campaign& campaign, const Store& store, const std::string& forgotten) {
  if (!campaign.until) throw std::invalid_argument("stop rule: a campaign without one");
  StopRule rule(*campaign.until, campaign.variants.size(), campaign.seeds.size());
  const SeedPlaces places(campaign.seeds);
  std::unordered_map<std::int64_t, std::size_t> variants;
  for (std::size_t v = 0; v < store.variant_ids().size(); ++v) {
    variants.emplace(store.variant_ids()[v], v);
  }
  store.for_each_outcome(
      [&](std::int64_t variant, std::uint64_t seed, const std::string& outcome, bool unsafe) {
        const std::optional<std::int64_t> place = places.of(seed);
        if (!place || (!forgotten.empty() && outcome == forgotten)) return;
        rule.add(*place, variants.at(variant), is_stop_event(*campaign.until, outcome, unsafe));
      });
  return rule;
}

std::optional<std::int64_t> stop_where_known(const Campaign& campaign, Store& store,
                                             const std::string& folder) {
  if (!campaign.until) return std::nullopt;
  const std::optional<std::int64_t> seeds = stop_rule_of(campaign, store).stops_after();
  if (seeds) remove_traces(folder, store.stop_after(campaign.seeds, *seeds));
  return seeds;
}

void remove_traces(const std::string& folder, const std::vector<std::string>& traces) {
  for (const std::string& trace : traces) {
    std::error_code error;
    const std::filesystem::path path = std::filesystem::path(folder) / trace;
    std::filesystem::remove_all(path, error);
    if (error) throw IoError(path.string() + ": cannot be removed: " + error.message());
  }
}

void refuse_shard_of_rule(const Campaign& campaign, const Shard& shard) {
  if (!campaign.until || shard.count == 1) return;
  throw InputError({.key = "--shard",
                    .found = fmt::format("{}/{}", shard.index, shard.count),
                    .expected = "all seeds in one folder, because the campaign's until checks "
                                "them in order"});
}

}  // namespace qsmpc::harness
