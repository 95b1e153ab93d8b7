// From a campaign file's tree of keys to what it asks for, before anything is combined or looked
// up.
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

/// A scenario or plant, as the file names it.
struct CampaignChoice {
  std::string text;
  CampaignPlace place;
};

/// KEY: VALUE, of a variant or of a point of the grid.
struct CampaignSetting {
  std::string key;  ///< dotted path in the scenario
  YamlNode value{};
  std::string text{};   ///< KEY=VALUE, as after --set
  std::string owner{};  ///< dotted path of what holds it, e.g. "variants.fast" or "grid"
  std::string item{};   ///< ".2" for value 2 of the grid's key; else empty
  int line = 0;
};

/// Whether the dotted path `inner` is `outer` or within it: "controller.cost" is in "controller".
[[nodiscard]] bool is_key_within(const std::string& inner, const std::string& outer);

/// Where `key`, a dotted path in the scenario that is within `setting` or leads to it, is in the
/// campaign file: "variants.fast.controller.horizon", "grid.controller.horizon.2".
[[nodiscard]] std::string path_of(const CampaignSetting& setting, const std::string& key);

/// Settings that are applied together.
struct SettingGroup {
  std::string name{};  ///< empty where the file has no variants
  std::vector<CampaignSetting> settings{};
  CampaignPlace place{};
};

/// A key of the grid with its values; at least one.
struct GridAxis {
  std::string key;
  int line = 0;  ///< of the key
  std::vector<CampaignSetting> values;
};

/// A family of the figure of risk against cost, before its members are known to be there.
struct FamilyDraft {
  std::string name;
  std::vector<CampaignChoice> settings{};
};

struct CampaignDraft {
  std::string file;  ///< what errors call it
  std::string name;
  std::vector<CampaignChoice> scenarios;  ///< none only if a problem was noted
  std::vector<SettingGroup> variants;     ///< at least one
  std::vector<GridAxis> grid;
  std::vector<CampaignChoice> plants;  ///< at least one; an empty text is the scenario's own
  SeedSet seeds;
  TraceKeeping traces = TraceKeeping::kNone;
  std::int64_t trace_sample = 0;
  std::vector<FamilyDraft> families{};
  std::optional<StopCriterion> until{};
  std::optional<RareSettings> rare{};
};

/// Reads `tree`. Everything wrong with it is noted in `problems`, and left out of what is returned.
/// The name defaults to the stem of `file`.
[[nodiscard]] CampaignDraft read_campaign(const YamlNode& tree, const std::string& file,
                                          Problems& problems);

}  // namespace qsmpc::harness
