// The stored form of an episode's periods: one row per episode, with JSON that SQL can read
// (json_each). One row per period would take most of the time of a large campaign.
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

/// "[[certified,published],…]" by period, with enough digits to read back exactly; null for NaN.
[[nodiscard]] std::string certificates_text(const std::vector<PeriodRow>& periods);
/// "[12,13]": the numbers of the periods that ended unsafe.
[[nodiscard]] std::string unsafe_text(const std::vector<PeriodRow>& periods);
/// "[1.5,2.25]" by period.
[[nodiscard]] std::string ocp_ms_text(const std::vector<PeriodRow>& periods);

/// Reads the periods in `certificates` and `unsafe`, without ocp_ms, into `periods`, which is
/// overwritten. Throws SQLite::Exception on texts not in the above formats.
void read_periods(std::string_view certificates, std::string_view unsafe,
                  std::vector<PeriodRow>& periods);
/// Reads the numbers of an ocp_ms_text into `values`, which is overwritten. Throws
/// SQLite::Exception on any other text.
void read_ocp_ms(std::string_view text, std::vector<double>& values);

/// Converts the per-period rows of earlier schemas, in the tables `old_period` and
/// `old_period_timing`, to rows of `episode_periods` and `episode_ocp_ms`.
void gather_periods(SQLite::Database& database);

}  // namespace qsmpc::harness
