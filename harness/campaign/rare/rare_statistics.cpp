#include "harness/campaign/rare/rare_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "harness/campaign/store/store_reader.hpp"
#include "harness/statistics/sample_statistics.hpp"
#include "harness/statistics/skewed_mean.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kRareTail = 0.005;  // of each limit: 99 % between them

std::vector<double> column_of(const std::vector<RareRow>& rows, double RareRow::*column) {
  std::vector<double> values;
  values.reserve(rows.size());
  for (const RareRow& row : rows) values.push_back(row.*column);
  return values;
}

void add_counts(const std::vector<RareRow>& rows, RareStatistics& statistics) {
  for (const RareRow& row : rows) {
    statistics.drives += row.drives;
    statistics.periods += row.periods;
    if (row.extinct) ++statistics.extinct;
    if (row.below_floor) ++statistics.below_floor;
    statistics.plain_drives += row.particles;
    statistics.plain_unsafe += row.plain_unsafe;
    statistics.plain_periods += row.plain_periods;
    statistics.plain_faults += row.plain_faults;
  }
}

void set_limits(const std::vector<RareRow>& rows, const std::vector<double>& estimates,
                RareStatistics& statistics) {
  const bool none_split =
      std::ranges::all_of(rows, [](const RareRow& row) { return row.levels == 0; });
  const auto found = std::ranges::count_if(estimates, [](double value) { return value > 0.0; });
  if (none_split || found < 2) {
    statistics.limits = RareLimits::kPlain;
    statistics.interval =
        clopper_pearson(statistics.plain_unsafe, statistics.plain_drives, kRareTail);
    return;
  }
  statistics.interval = skewed_mean_interval(estimates, kRareTail);
  // A run that ended at the floor may have missed events of at most that probability.
  if (statistics.below_floor > 0) statistics.interval.upper += rows.front().floor;
  statistics.interval.upper = std::min(1.0, statistics.interval.upper);
}

void set_worth(RareStatistics& statistics) {
  const double variance = std::pow(statistics.standard_error, 2.0);
  if (!(variance > 0.0)) return;
  const double p = statistics.probability;
  statistics.worth_drives = p * (1.0 - p) / variance;
  statistics.worth_periods = statistics.worth_drives * statistics.periods_per_drive();
}

void set_certified(const std::vector<RareRow>& rows, RareStatistics& statistics) {
  const std::vector<double> sums = column_of(rows, &RareRow::certified);
  if (!std::ranges::all_of(sums, [](double sum) { return std::isfinite(sum); })) return;
  statistics.certified = mean_of(sums);
  statistics.certified_interval = skewed_mean_interval(sums, kRareTail);
}

}  // namespace

double RareStatistics::periods_per_drive() const {
  return static_cast<double>(plain_periods) / static_cast<double>(plain_drives);
}

double RareStatistics::gain() const { return worth_periods / static_cast<double>(periods); }

bool RareStatistics::exceeds_certified() const {
  return std::isfinite(certified) && interval.lower > certified_interval.upper;
}

RareStatistics rare_statistics(const std::vector<std::uint64_t>& seeds,
                               const std::vector<RareRow>& rows) {
  if (rows.empty() || seeds.size() != rows.size()) {
    throw std::invalid_argument("rare outcomes: no runs, or different numbers of runs and seeds");
  }
  RareStatistics statistics{.particles = rows.front().particles};
  for (std::size_t n = 0; n < rows.size(); ++n) {
    statistics.runs.push_back(
        {.seed = seeds[n], .probability = rows[n].probability, .found = rows[n].found});
  }
  add_counts(rows, statistics);
  const std::vector<double> estimates = column_of(rows, &RareRow::probability);
  statistics.probability = mean_of(estimates);
  statistics.standard_error = standard_error_of(estimates);
  statistics.collision = mean_of(column_of(rows, &RareRow::collision));
  statistics.left_bounds = mean_of(column_of(rows, &RareRow::left_bounds));
  set_limits(rows, estimates, statistics);
  set_worth(statistics);
  set_certified(rows, statistics);
  return statistics;
}

std::optional<RareStatistics> rare_statistics(const StoreReader& store, std::int64_t variant) {
  std::vector<std::uint64_t> seeds;
  std::vector<RareRow> rows;
  store.for_each_rare(variant, [&](std::uint64_t seed, const RareRow& row) {
    seeds.push_back(seed);
    rows.push_back(row);
  });
  if (rows.empty()) return std::nullopt;
  return rare_statistics(seeds, rows);
}

}  // namespace qsmpc::harness
