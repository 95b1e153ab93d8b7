// A campaign as CSV tables: RFC 4180 with line feeds as line ends; the header line has the keys of
// campaign.json. Numbers are written in the shortest form that reads back exactly; non-finite and
// missing values are empty fields.
#pragma once

#include <string>

#include "harness/campaign/statistics/statistics.hpp"
#include "harness/campaign/store/episode_row.hpp"
#include "harness/campaign/store/store_reader.hpp"

namespace qsmpc::harness {

/// One line per variant, per difference and quantity, or per bin, with wall-clock values in the
/// last columns. Only bins with periods are listed; `variant` is empty for all variants together.
[[nodiscard]] std::string variants_csv(const CampaignStatistics& statistics);
[[nodiscard]] std::string differences_csv(const CampaignStatistics& statistics);
[[nodiscard]] std::string calibration_csv(const CampaignStatistics& statistics);

/// The header and a line of episodes.csv, with wall-clock values in the last columns.
[[nodiscard]] std::string episodes_csv_head();
[[nodiscard]] std::string episodes_csv_line(const StoredVariant& variant, const EpisodeRow& row);

/// Writes all episodes to the file `path` atomically, ordered by variant and seed. Memory use is
/// independent of their number. Throws IoError, and what the store throws.
void write_episodes_csv(const StoreReader& store, const std::string& path);

}  // namespace qsmpc::harness
