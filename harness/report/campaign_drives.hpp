// Maps of a campaign's drives, and distributions of their cost, clearance and time.
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/statistics/statistics.hpp"
#include "harness/figures/plane_map.hpp"
#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

struct DriveMaps {
  std::vector<PlaneMap> maps{};
  std::vector<std::string> notes{};  ///< which maps are missing, and why; plain text
};

/// A map for each of at most 12 variants, those with the most unsafe drives: the scenario's ground
/// and the drives, coloured by outcome. None for a system without map_axes, or without a path in
/// the store.
[[nodiscard]] DriveMaps drive_maps(const CampaignStatistics& statistics);

/// Distributions over the drives of cost, least clearance and time to the target: one line per
/// variant from its least to its greatest value or, for more than 6 variants, the median with the
/// 5th and 95th percentiles. Charts that would have only one place are left out.
[[nodiscard]] std::vector<Chart> distribution_charts(const CampaignStatistics& statistics);

/// Whether points or lines of `chart` occupy at least two places along x; a single place is better
/// shown in a table.
[[nodiscard]] bool has_places(const Chart& chart);

/// "2: NAME" for the variant at `place`: the number by which files and commands identify it, and at
/// most `limit` bytes of its name as plain text.
[[nodiscard]] std::string numbered_name(const CampaignStatistics& statistics, std::size_t place,
                                        std::size_t limit);

/// The numbers of all variants for the labels of an axis; of many variants, only every n-th number.
[[nodiscard]] std::vector<std::string> variant_numbers(const CampaignStatistics& statistics);

/// Whether no certificate of any variant is a bound.
[[nodiscard]] bool none_is_bound(const CampaignStatistics& statistics);

/// " No bound in variants 0, 2: WHY." if certificates of some of `statistics.variants` are not
/// bounds, " No bound: WHY." if none are; empty if all are bounds.
[[nodiscard]] std::string no_bound_words(const CampaignStatistics& statistics);

/// Every n-th of `names` such that at most `most` remain below an axis; the others become empty.
[[nodiscard]] std::vector<std::string> thinned(std::vector<std::string> names, std::size_t most);

/// The colour of drives that ended with `outcome`, as in the bars of the page.
[[nodiscard]] int outcome_colour(const std::string& outcome);

}  // namespace qsmpc::harness
