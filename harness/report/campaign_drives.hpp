// Where the drives of a campaign went, and how cost, clearance and time are distributed.
#pragma once

#include <string>
#include <vector>

#include "harness/campaign/statistics/statistics.hpp"
#include "harness/figures/plane_map.hpp"
#include "harness/figures/svg_chart.hpp"

namespace qsmpc::harness {

struct DriveMaps {
  std::vector<PlaneMap> maps{};
  std::vector<std::string> notes{};  ///< about maps that are not there, and why; plain text
};

/// A map of each of at most 12 variants, those with the most unsafe drives: the ground of its
/// scenario and its drives, coloured by outcome. None of a system without map_axes,
/// or without a path in the store.
[[nodiscard]] DriveMaps drive_maps(const CampaignStatistics& statistics);

/// Distributions over the drives of cost, least clearance and time to the target: a line a variant
/// from its least to its greatest value, or of more than 6 variants the median and the 5th and 95th
/// percentiles. Without those that would have a single place.
[[nodiscard]] std::vector<Chart> distribution_charts(const CampaignStatistics& statistics);

/// Whether points or lines of `chart` stand at two places across at least: one alone is better said
/// by a table.
[[nodiscard]] bool has_places(const Chart& chart);

/// "2: NAME", with the number by which files and commands name the variant at `place`, as plain
/// text of at most `limit` bytes of the name.
[[nodiscard]] std::string numbered_name(const CampaignStatistics& statistics, std::size_t place,
                                        std::size_t limit);

/// The numbers of all variants, as they stand below an axis: of many, every so many.
[[nodiscard]] std::vector<std::string> variant_numbers(const CampaignStatistics& statistics);

/// Whether no certificate of any variant is a bound.
[[nodiscard]] bool none_is_bound(const CampaignStatistics& statistics);

/// " No bound in variants 0, 2: WHY." where certificates of some of `statistics.variants` are none,
/// " No bound: WHY." where they are of all; empty where all are bounds.
[[nodiscard]] std::string no_bound_words(const CampaignStatistics& statistics);

/// Of `names`, what has room below an axis: every so many, the others empty.
[[nodiscard]] std::vector<std::string> thinned(std::vector<std::string> names, std::size_t most);

/// The colour of what ended with `outcome`, as in the bars of the page.
[[nodiscard]] int outcome_colour(const std::string& outcome);

}  // namespace qsmpc::harness
