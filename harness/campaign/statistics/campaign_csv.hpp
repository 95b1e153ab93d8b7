// A campaign as tables for other programs: RFC 4180 with a line feed at each line's end; the head
// names the keys of campaign.json. Numbers are the shortest ones that read back as they were; what
// is not finite or not there is an empty field.
#pragma once

#include <string>

#include "harness/campaign/statistics/statistics.hpp"
#include "harness/campaign/store/episode_row.hpp"
#include "harness/campaign/store/store_reader.hpp"

namespace qsmpc::harness {

/// A line a variant, difference and quantity, or bin; wall-clock values in the last columns. Of the
/// bins, those that have periods; of all variants together, `variant` is empty.
[[nodiscard]] std::string variants_csv(const CampaignStatistics& statistics);
[[nodiscard]] std::string differences_csv(const CampaignStatistics& statistics);
[[nodiscard]] std::string calibration_csv(const CampaignStatistics& statistics);

/// The head and a line of episodes.csv, wall-clock values in the last columns.
[[nodiscard]] std::string episodes_csv_head();
[[nodiscard]] std::string episodes_csv_line(const StoredVariant& variant, const EpisodeRow& row);

/// Writes all episodes to the file `path` in one piece, variant by variant and by seed. Memory does
/// not grow with their number. Throws IoError, and what the store throws.
void write_episodes_csv(const StoreReader& store, const std::string& path);

}  // namespace qsmpc::harness
