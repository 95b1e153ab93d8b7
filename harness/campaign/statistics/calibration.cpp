#include "harness/campaign/statistics/calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "harness/campaign/statistics/paired_difference.hpp"

namespace qsmpc::harness {
namespace {

/// Lower ends of the bins after the first, and the upper end of the last: powers of √10.
constexpr std::array<double, kCalibrationBins> kEdges = {
    1e-12, 3.1622776601683795e-12, 1e-11, 3.1622776601683795e-11, 1e-10, 3.1622776601683795e-10,
    1e-9,  3.1622776601683795e-9,  1e-8,  3.1622776601683795e-8,  1e-7,  3.1622776601683795e-7,
    1e-6,  3.1622776601683795e-6,  1e-5,  3.1622776601683795e-5,  1e-4,  3.1622776601683795e-4,
    1e-3,  3.1622776601683795e-3,  1e-2,  3.1622776601683795e-2,  0.1,   0.31622776601683795,
    1.0};

/// Values outside [0, 1] and NaN count as 1.
double as_probability(double value) { return value >= 0.0 && value <= 1.0 ? value : 1.0; }

struct Counts {
  std::int64_t periods = 0;
  std::int64_t unsafe = 0;
  double certified = 0.0;
};

CalibrationBin finished_bin(int number, const Counts& counts,
                            const std::vector<EventTally>& tallies) {
  const auto n = static_cast<std::size_t>(number);
  CalibrationBin bin{.lower = number == 0 ? 0.0 : kEdges[n - 1],
                     .upper = kEdges[n],
                     .periods = counts.periods,
                     .unsafe = counts.unsafe};
  if (counts.periods == 0) return bin;
  const auto periods = static_cast<double>(counts.periods);
  bin.mean_certified = counts.certified / periods;
  bin.rate = static_cast<double>(counts.unsafe) / periods;
  bin.interval = clopper_pearson(counts.unsafe, counts.periods, kCampaignTail);
  bin.p_value = exceedance_p_value(tallies);
  bin.exceeded = bin.p_value < kCalibrationLevel / kCalibrationBins;
  return bin;
}

}  // namespace

int calibration_bin(double probability) {
  const auto* const above = std::ranges::upper_bound(kEdges, as_probability(probability));
  return std::min(static_cast<int>(above - kEdges.begin()), kCalibrationBins - 1);
}

CalibrationTally::CalibrationTally() : bins_(kCalibrationBins) {}

void CalibrationTally::add(std::int64_t period, double certified, bool unsafe) {
  if (period == 0) end_episode();
  const double probability = as_probability(certified);
  Bin& bin = bins_[static_cast<std::size_t>(calibration_bin(probability))];
  ++bin.periods;
  bin.unsafe += unsafe ? 1 : 0;
  bin.certified += probability;
  bin.tallies.add(period, probability, unsafe);
  all_.add(period, probability, unsafe);
  periods_in_episode_ = period + 1;
  last_certified_ = probability;
}

void CalibrationTally::end_episode() {
  if (periods_in_episode_ == 0) return;
  Bin& bin = bins_[static_cast<std::size_t>(calibration_bin(last_certified_))];
  bin.tallies.end_episode(periods_in_episode_, last_certified_);
  all_.end_episode(periods_in_episode_, last_certified_);
  periods_in_episode_ = 0;
}

CalibrationTally CalibrationTally::ended() const {
  CalibrationTally tally = *this;
  tally.end_episode();
  return tally;
}

std::vector<CalibrationBin> CalibrationTally::result() const {
  const CalibrationTally tally = ended();
  std::vector<CalibrationBin> bins;
  for (int n = 0; n < kCalibrationBins; ++n) {
    const Bin& bin = tally.bins_[static_cast<std::size_t>(n)];
    bins.push_back(
        finished_bin(n, {.periods = bin.periods, .unsafe = bin.unsafe, .certified = bin.certified},
                     bin.tallies.tallies()));
  }
  return bins;
}

double CalibrationTally::p_value() const { return exceedance_p_value(ended().all_.tallies()); }

std::int64_t CalibrationTally::periods() const {
  std::int64_t sum = 0;
  for (const Bin& bin : bins_) sum += bin.periods;
  return sum;
}

std::int64_t CalibrationTally::unsafe() const {
  std::int64_t sum = 0;
  for (const Bin& bin : bins_) sum += bin.unsafe;
  return sum;
}

double CalibrationTally::certified() const {
  double sum = 0.0;
  for (const Bin& bin : bins_) sum += bin.certified;
  return sum;
}

void PooledCalibration::add(const CalibrationTally& variant) {
  variants_.push_back(variant.ended());
}

std::vector<CalibrationBin> PooledCalibration::result() const {
  std::vector<CalibrationBin> bins;
  for (int n = 0; n < kCalibrationBins; ++n) {
    Counts counts;
    std::vector<EventTally> tallies;
    for (const CalibrationTally& variant : variants_) {
      const CalibrationTally::Bin& bin = variant.bins_[static_cast<std::size_t>(n)];
      counts.periods += bin.periods;
      counts.unsafe += bin.unsafe;
      counts.certified += bin.certified;
      tallies.insert(tallies.end(), bin.tallies.tallies().begin(), bin.tallies.tallies().end());
    }
    bins.push_back(finished_bin(n, counts, tallies));
  }
  return bins;
}

double PooledCalibration::p_value() const {
  if (variants_.empty()) return 1.0;
  std::vector<EventTally> tallies;
  for (const CalibrationTally& variant : variants_) {
    const std::vector<EventTally>& own = variant.all_.tallies();
    tallies.insert(tallies.end(), own.begin(), own.end());
  }
  return exceedance_p_value(tallies);
}

}  // namespace qsmpc::harness
