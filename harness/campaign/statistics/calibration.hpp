// Whether periods end unsafe as seldom as certified: by how probable their certificate calls it.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "harness/statistics/binomial_interval.hpp"
#include "harness/statistics/exceedance.hpp"

namespace qsmpc::harness {

/// Bins of certified probabilities: [0, 1e-12), then half decades up to 1.
inline constexpr int kCalibrationBins = 25;
/// How often valid certificates are called exceeded, in any of their bins, at most.
inline constexpr double kCalibrationLevel = 0.01;

/// The bin of a probability, from 0. What is above 1 or not a number promises nothing, like 1.
[[nodiscard]] int calibration_bin(double probability);

struct CalibrationBin {
  double lower = 0.0;  ///< its probabilities: lower ≤ p < upper; the last bin has 1, too
  double upper = 0.0;
  std::int64_t periods = 0;
  double mean_certified = std::numeric_limits<double>::quiet_NaN();
  std::int64_t unsafe = 0;  ///< periods that ended in the unsafe set
  double rate = std::numeric_limits<double>::quiet_NaN();
  /// 99 % Clopper–Pearson, as if periods were independent. Those of one episode are not: a guide.
  RateInterval interval{};
  double p_value = 1.0;   ///< exceedance_p_value of its periods; that one holds for any dependence
  bool exceeded = false;  ///< the p-value is below kCalibrationLevel / kCalibrationBins
};

/// Periods of episodes, one after the other, in bins. Memory does not grow with their number.
///
/// Why the p-value of a bin holds: with N events and the sum S of the certificates of a bin's
/// periods, exp(N t − S (eᵗ − 1)) is a product over all periods of one parity, in which those of
/// other bins are a factor 1. Which bin a period is in is known when its certificate is made,
/// before its event can happen; so each factor has, given what is known then, an expectation of at
/// most 1 in either case, and the product is the supermartingale of exceedance.hpp. To look only at
/// what happened to be certified in a range is thus no selection by outcome. The certificate of the
/// period that would have followed an episode's last one is not made; that of the last one stands
/// for it, in its own bin (PeriodTallies).
///
/// Bonferroni over all kCalibrationBins bins, not over those with many periods only: how many
/// periods a bin gets may depend on what happened, and the p-value needs no least number of them.
/// So valid certificates are called exceeded, in whatever bin, with a probability of at most
/// kCalibrationLevel.
class CalibrationTally {
 public:
  CalibrationTally();

  /// Period number `period` of an episode, from 0; 0 begins the next episode.
  void add(std::int64_t period, double certified, bool unsafe);

  /// All kCalibrationBins bins.
  [[nodiscard]] std::vector<CalibrationBin> result() const;
  /// exceedance_p_value of all periods.
  [[nodiscard]] double p_value() const;

  [[nodiscard]] std::int64_t periods() const;
  [[nodiscard]] std::int64_t unsafe() const;
  [[nodiscard]] double certified() const;  ///< the sum

 private:
  friend class PooledCalibration;
  struct Bin {
    std::int64_t periods = 0;
    std::int64_t unsafe = 0;
    double certified = 0.0;
    PeriodTallies tallies{};
  };
  /// With the last episode ended: the one that is going on goes on.
  [[nodiscard]] CalibrationTally ended() const;
  void end_episode();

  std::vector<Bin> bins_;
  PeriodTallies all_;
  std::int64_t periods_in_episode_ = 0;
  double last_certified_ = 0.0;
};

/// The calibration of several variants together. They share the random numbers of their seeds, so
/// that their events depend on each other: each variant's periods remain sequences of their own,
/// whose evidence is averaged and not multiplied (exceedance_p_value). O(variants).
class PooledCalibration {
 public:
  void add(const CalibrationTally& variant);
  [[nodiscard]] std::vector<CalibrationBin> result() const;
  /// 1 without a variant.
  [[nodiscard]] double p_value() const;

 private:
  std::vector<CalibrationTally> variants_;
};

}  // namespace qsmpc::harness
