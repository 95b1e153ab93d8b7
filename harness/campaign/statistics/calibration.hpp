// Calibration of the certificates: whether periods end unsafe as seldom as certified, binned by
// certified probability.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "harness/statistics/binomial_interval.hpp"
#include "harness/statistics/exceedance.hpp"

namespace qsmpc::harness {

/// Bins of certified probabilities: [0, 1e-12), then half decades up to 1.
inline constexpr int kCalibrationBins = 25;
/// Familywise significance level: the largest probability that valid certificates are flagged as
/// exceeded in any bin.
inline constexpr double kCalibrationLevel = 0.01;

/// The 0-based bin of a probability. Values outside [0, 1] and NaN promise nothing and count as 1.
[[nodiscard]] int calibration_bin(double probability);

struct CalibrationBin {
  double lower = 0.0;  ///< probabilities in lower ≤ p < upper; the last bin includes 1
  double upper = 0.0;
  std::int64_t periods = 0;
  double mean_certified = std::numeric_limits<double>::quiet_NaN();
  std::int64_t unsafe = 0;  ///< periods that ended in the unsafe set
  double rate = std::numeric_limits<double>::quiet_NaN();
  /// 99 % Clopper–Pearson, as if periods were independent. Those of one episode are not, so it is
  /// only a guide.
  RateInterval interval{};
  double p_value = 1.0;   ///< exceedance_p_value of its periods; holds under any dependence
  bool exceeded = false;  ///< the p-value is below kCalibrationLevel / kCalibrationBins
};

/// Bins the periods of consecutive episodes. Memory use is independent of their number.
///
/// Why the p-value of a bin holds: with N events and the sum S of the certificates of a bin's
/// periods, exp(N t − S (eᵗ − 1)) is a product over all periods of one parity, in which the factors
/// of periods in other bins are 1. The bin of a period is known when its certificate is made,
/// before its event can occur. Given what is known then, each factor therefore has expectation at
/// most 1 in either case, and the product is the supermartingale of exceedance.hpp. Restricting
/// attention to a range of certified probabilities is thus no selection by outcome. The certificate
/// of the period that would have followed an episode's last one is never made; the last one's takes
/// its place, in its own bin (PeriodTallies).
///
/// The Bonferroni correction is over all kCalibrationBins bins, not only those with many periods:
/// the number of periods in a bin may depend on past events, and the p-value needs no minimum
/// number. Valid certificates are thus flagged as exceeded in any bin with probability at most
/// kCalibrationLevel.
class CalibrationTally {
 public:
  CalibrationTally();

  /// Adds period `period` of an episode, counted from 0; 0 begins the next episode.
  void add(std::int64_t period, double certified, bool unsafe);

  /// All kCalibrationBins bins.
  [[nodiscard]] std::vector<CalibrationBin> result() const;
  /// exceedance_p_value of all periods.
  [[nodiscard]] double p_value() const;

  [[nodiscard]] std::int64_t periods() const;
  [[nodiscard]] std::int64_t unsafe() const;
  [[nodiscard]] double certified() const;  ///< sum of the certified probabilities

 private:
  friend class PooledCalibration;
  struct Bin {
    std::int64_t periods = 0;
    std::int64_t unsafe = 0;
    double certified = 0.0;
    PeriodTallies tallies{};
  };
  /// A copy in which the current episode has ended.
  [[nodiscard]] CalibrationTally ended() const;
  void end_episode();

  std::vector<Bin> bins_;
  PeriodTallies all_;
  std::int64_t periods_in_episode_ = 0;
  double last_certified_ = 0.0;
};

/// The pooled calibration of several variants. They share the random numbers of their seeds, so
/// their events are dependent: the periods of each variant remain separate sequences, whose
/// evidence is averaged, not multiplied (exceedance_p_value). Memory is O(variants).
class PooledCalibration {
 public:
  void add(const CalibrationTally& variant);
  [[nodiscard]] std::vector<CalibrationBin> result() const;
  /// 1 without variants.
  [[nodiscard]] double p_value() const;

 private:
  std::vector<CalibrationTally> variants_;
};

}  // namespace qsmpc::harness
