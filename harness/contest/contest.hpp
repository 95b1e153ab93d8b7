// A contest: controllers compared on the same scenarios, plants, noise and seeds, each with
// settings chosen by the same search.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/plan/campaign_reader.hpp"

namespace qsmpc::harness {

/// One combination of settings in the search of a controller.
struct ContestCandidate {
  std::vector<CampaignSetting> settings{};  ///< in addition to the controller's and the common ones
  std::string label{};                      ///< "KEY=VALUE, …"; empty without settings
};

struct ContestController {
  std::string name;
  std::vector<CampaignSetting> settings{};  ///< its own, in addition to the common ones
  CampaignPlace place{};
  std::int64_t grid = 1;  ///< points of its search
  /// The candidates tried, at least one: all points of the grid, or as many as the budget allows.
  std::vector<ContestCandidate> candidates{};
};

struct ContestTuning {
  SeedSet seeds{};
  std::int64_t budget = 0;  ///< maximum number of candidates per controller
};

/// A comparison cell: all that defines a drive except controller and seed, as indices into the
/// contest's lists.
struct ContestCell {
  std::size_t scenario = 0;
  std::size_t plant = 0;
  std::size_t noise = 0;
};

struct Contest {
  std::string file;
  std::string name;
  std::string description{};
  std::size_t reference = 0;  ///< index of the controller that the others are compared with
  std::vector<ContestController> controllers{};  ///< at least one
  std::vector<CampaignChoice> scenarios{};
  std::vector<CampaignChoice> plants{};  ///< an empty text: the scenario's own plant
  std::vector<double> noise{};           ///< factors, at least one
  int noise_line = 0;                    ///< line of the file that sets them
  std::vector<CampaignSetting> common{};
  SeedSet seeds{};
  std::optional<ContestTuning> tuning{};
  /// Certified risk of a drive that is to be kept, between 0 and 1, see Standing::kept; none: not
  /// asked.
  std::optional<double> risk_limit{};
  std::int64_t timing_seeds = 3;  ///< number of timed seeds: the first ones of `seeds`

  /// All cells, ordered by scenario, then plant, then noise.
  [[nodiscard]] std::vector<ContestCell> cells() const;
  /// The name of a cell, e.g. "dubins_alley, mujoco_car, noise 2": only what the contest has
  /// several of, else the scenario.
  [[nodiscard]] std::string name_of(const ContestCell& cell) const;
};

/// The index of the chosen candidate of each controller.
using ContestChoice = std::vector<std::size_t>;

}  // namespace qsmpc::harness
