// Reads a campaign file's key tree, before anything is combined or looked up.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {

/// A place in the campaign file, for errors.
struct CampaignPlace {
  int line = 0;
  std::string path{};  ///< dotted, e.g. "plants.1"
};

/// A scenario or plant as named in the file.
struct CampaignChoice {
  std::string text;
  CampaignPlace place;
};

/// KEY: VALUE, of a variant or of a grid point.
struct CampaignSetting {
  std::string key;  ///< dotted path in the scenario
  YamlNode value{};
  std::string text{};   ///< KEY=VALUE, as after --set
  std::string owner{};  ///< dotted path of its parent, e.g. "variants.fast" or "grid"
  std::string item{};   ///< ".2" for value 2 of a grid key; else empty
  int line = 0;
};

/// Whether the dotted path `inner` is `outer` or within it: "controller.cost" is in "controller".
[[nodiscard]] bool is_key_within(const std::string& inner, const std::string& outer);

/// The path in the campaign file of `key`, a dotted path in the scenario that is within `setting`
/// or leads to it: "variants.fast.controller.horizon", "grid.controller.horizon.2".
[[nodiscard]] std::string path_of(const CampaignSetting& setting, const std::string& key);

/// Settings that are applied together.
struct SettingGroup {
  std::string name{};  ///< empty if the file has no variants
  std::vector<CampaignSetting> settings{};
  CampaignPlace place{};
};

/// A key of the grid with its values; at least one.
struct GridAxis {
  std::string key;
  int line = 0;  ///< of the key
  std::vector<CampaignSetting> values;
};

/// A family of the risk-against-cost figure, before its members are checked.
struct FamilyDraft {
  std::string name;
  std::vector<CampaignChoice> settings{};
};

struct CampaignDraft {
  std::string file;  ///< its name in error messages
  std::string name;
  std::vector<CampaignChoice> scenarios;  ///< empty only if a problem was reported
  std::vector<SettingGroup> variants;     ///< at least one
  std::vector<GridAxis> grid;
  std::vector<CampaignChoice> plants;  ///< at least one; an empty text: the scenario's own
  SeedSet seeds;
  TraceKeeping traces = TraceKeeping::kNone;
  std::int64_t trace_sample = 0;
  std::vector<FamilyDraft> families{};
  std::optional<StopCriterion> until{};
  std::optional<RareSettings> rare{};
};

/// Reads `tree`. Invalid parts are added to `problems` and left out of the result. The name
/// defaults to the stem of `file`.
[[nodiscard]] CampaignDraft read_campaign(const YamlNode& tree, const std::string& file,
                                          Problems& problems);

}  // namespace qsmpc::harness
