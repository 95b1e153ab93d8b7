// A contest: controllers that drive the same scenarios, plants, noise and seeds, each with settings
// that were chosen by the same search.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/plan/campaign_reader.hpp"

namespace qsmpc::harness {

/// One of the settings that a controller may drive with.
struct ContestCandidate {
  std::vector<CampaignSetting> settings{};  ///< besides its own and those of all
  std::string label{};                      ///< "KEY=VALUE, …"; empty where there is no setting
};

struct ContestController {
  std::string name;
  std::vector<CampaignSetting> settings{};  ///< its own, besides those of all
  CampaignPlace place{};
  std::int64_t grid = 1;  ///< points of its search
  /// Those that are tried, at least one: all points of the grid, or as many as the budget allows.
  std::vector<ContestCandidate> candidates{};
};

struct ContestTuning {
  SeedSet seeds{};
  std::int64_t budget = 0;  ///< candidates of a controller, at most
};

/// Where drives are compared: everything but the controller. Indices of the contest's lists.
struct ContestCell {
  std::size_t scenario = 0;
  std::size_t plant = 0;
  std::size_t noise = 0;
};

struct Contest {
  std::string file;
  std::string name;
  std::string description{};
  std::size_t reference = 0;  ///< index of the controller that others are held to
  std::vector<ContestController> controllers{};  ///< at least one
  std::vector<CampaignChoice> scenarios{};
  std::vector<CampaignChoice> plants{};  ///< an empty text is the scenario's own
  std::vector<double> noise{};           ///< factors, at least one
  int noise_line = 0;                    ///< of the file, where it says them
  std::vector<CampaignSetting> common{};
  SeedSet seeds{};
  std::optional<ContestTuning> tuning{};
  std::int64_t timing_seeds = 3;  ///< of `seeds`, the first ones, that are timed

  /// By scenario, then plant, then noise.
  [[nodiscard]] std::vector<ContestCell> cells() const;
  /// What the contest has several of, else the scenario: "dubins_alley, mujoco_car, noise 2".
  [[nodiscard]] std::string name_of(const ContestCell& cell) const;
};

/// Which candidate each controller drives with, by controller.
using ContestChoice = std::vector<std::size_t>;

}  // namespace qsmpc::harness
