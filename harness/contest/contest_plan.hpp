// A contest's drives as campaigns: the search for settings, the contest itself, and the drives that
// are timed.
//
// The variants of each are by scenario, then contender (a controller with a candidate), then noise,
// then plant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "harness/campaign/campaign.hpp"
#include "harness/contest/contest.hpp"
#include "harness/scenario/yaml_section.hpp"

namespace qsmpc::harness {

/// A controller with one of its candidates.
struct Contender {
  std::size_t controller = 0;
  std::size_t candidate = 0;

  friend bool operator==(const Contender&, const Contender&) = default;
};

/// What the search drives: all candidates of the controllers that have several. Empty where there
/// is nothing to choose.
[[nodiscard]] std::vector<Contender> searched_contenders(const Contest& contest);

/// What the contest drives: each controller with the candidate that was chosen.
[[nodiscard]] std::vector<Contender> chosen_contenders(const ContestChoice& choice);

/// The place of the variant in which contender number `contender` of `contenders` drives in `cell`.
[[nodiscard]] std::size_t variant_of(const Contest& contest, std::size_t contenders,
                                     std::size_t contender, const ContestCell& cell);

/// Each of `contenders` in all cells with `seeds`. A contender is called by its controller, where
/// `with_candidates` by its candidate as well, and by the noise where the contest has several or
/// another than the scenario's. Everything wrong is noted in `problems`, as expand_campaign does;
/// the campaign is valid only if nothing was.
[[nodiscard]] Campaign contest_campaign(const Contest& contest,
                                        const std::vector<Contender>& contenders,
                                        const SeedSet& seeds, bool with_candidates,
                                        Problems& problems);

/// The first `count` seeds, or all where there are fewer.
[[nodiscard]] SeedSet first_seeds(const SeedSet& seeds, std::int64_t count);

}  // namespace qsmpc::harness
