// A contest's drives as campaigns: the search for settings, the contest itself, and the timed
// drives.
//
// The variants of each are ordered by scenario, then contender (a controller with a candidate),
// then noise, then plant.
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

/// The contenders of the search: all candidates of the controllers that have several. Empty if
/// there is nothing to choose.
[[nodiscard]] std::vector<Contender> searched_contenders(const Contest& contest);

/// The contenders of the contest: each controller with its chosen candidate.
[[nodiscard]] std::vector<Contender> chosen_contenders(const ContestChoice& choice);

/// The index of the variant for contender `contender` of `contenders` in `cell`.
[[nodiscard]] std::size_t variant_of(const Contest& contest, std::size_t contenders,
                                     std::size_t contender, const ContestCell& cell);

/// The campaign of all `contenders` in all cells with `seeds`. A contender is named after its
/// controller, with `with_candidates` also after its candidate, and after the noise if the contest
/// has several levels or one other than the scenario's. Problems are added to `problems`, as by
/// expand_campaign; the campaign is valid only if there are none.
[[nodiscard]] Campaign contest_campaign(const Contest& contest,
                                        const std::vector<Contender>& contenders,
                                        const SeedSet& seeds, bool with_candidates,
                                        Problems& problems);

/// The first `count` seeds, or all if there are fewer.
[[nodiscard]] SeedSet first_seeds(const SeedSet& seeds, std::int64_t count);

}  // namespace qsmpc::harness
