// The periods of an episode as the store keeps them: one row an episode, with JSON that SQLite
// reads (json_each), for a row a period would take most of the time of a large campaign.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "harness/campaign/store/episode_row.hpp"

// NOLINTNEXTLINE(readability-identifier-naming): the name that its library gives it
namespace SQLite {
class Database;
}

namespace qsmpc::harness {

/// "[[certified,published],…]" by period, with as many digits as read back exactly; null for what
/// is not a number.
[[nodiscard]] std::string certificates_text(const std::vector<PeriodRow>& periods);
/// "[12,13]": the periods that ended unsafe, by number.
[[nodiscard]] std::string unsafe_text(const std::vector<PeriodRow>& periods);
/// "[1.5,2.25]" by period.
[[nodiscard]] std::string ocp_ms_text(const std::vector<PeriodRow>& periods);

/// The periods in `certificates` and `unsafe`, without ocp_ms, into `periods`, which is
/// overwritten. Throws SQLite::Exception on texts that are none of the above.
void read_periods(std::string_view certificates, std::string_view unsafe,
                  std::vector<PeriodRow>& periods);
/// The numbers in an ocp_ms_text, into `values`, which is overwritten. Throws SQLite::Exception on
/// another text.
void read_ocp_ms(std::string_view text, std::vector<double>& values);

/// Turns the rows of earlier schemas, a period each, in the tables `old_period` and
/// `old_period_timing`, into rows of `episode_periods` and `episode_ocp_ms`.
void gather_periods(SQLite::Database& database);

}  // namespace qsmpc::harness
