// Paired differences of two variants: the episodes of one seed have the same random numbers, so
// that most of the randomness cancels in their difference.
//
//   PairedDifference difference;
//   store.for_each_pair(baseline, variant, [&](const EpisodeRow& b, const EpisodeRow& v) {
//     difference.add(b, v);
//   });
//   const std::vector<MeanDifference> means = difference.result();
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "harness/campaign/store/episode_row.hpp"
#include "harness/statistics/binomial_interval.hpp"

namespace qsmpc::harness {

/// Bootstrap replicates: the 99 % limits are the 10th values from either end.
inline constexpr int kBootstrapReplicates = 2000;
/// Error probability of each limit of an interval: the two limits give 99 %.
inline constexpr double kCampaignTail = 0.005;

/// Bootstrap sums of one quantity over all pairs: O(replicates) memory for any number of pairs.
///
/// A streaming bootstrap: in each replicate each pair has an independent Poisson(1) weight. The
/// multinomial weights of the usual bootstrap converge to these, and these need only one pair of
/// the sample at a time. (Hanley, MacGibbon: "Creating non-parametric bootstrap samples using
/// Poisson frequencies", Computer Methods and Programs in Biomedicine 83, 2006. Chamandy,
/// Muralidharan, Najmi, Naidu: "Estimating uncertainty for massive data streams", 2012.)
class BootstrapMean {
 public:
  /// value: finite; weights: kBootstrapReplicates.
  void add(double value, const Eigen::ArrayXd& weights);

  [[nodiscard]] std::int64_t count() const { return count_; }
  /// NaN if nothing was added.
  [[nodiscard]] double mean() const;
  /// The percentile interval: for large samples the true mean is below it, and above it, with
  /// probability kCampaignTail each. NaN limits for fewer than two values.
  [[nodiscard]] RateInterval interval() const;

 private:
  std::int64_t count_ = 0;
  double sum_ = 0.0;
  Eigen::ArrayXd sums_ = Eigen::ArrayXd::Zero(kBootstrapReplicates);
  Eigen::ArrayXd weights_ = Eigen::ArrayXd::Zero(kBootstrapReplicates);
};

/// The percentile interval of Σ wₙ xₙ / Σ wₙ from the numerators `sums` and denominators `weights`
/// of the replicates; as BootstrapMean::interval.
[[nodiscard]] RateInterval bootstrap_interval(std::int64_t count, const Eigen::ArrayXd& sums,
                                              const Eigen::ArrayXd& weights);

/// The percentile interval of a statistic from its bootstrap `replicates`, in any order: a share
/// kCampaignTail of them is at or beyond each limit. NaN limits if there are none.
[[nodiscard]] RateInterval percentile_interval(std::vector<double> replicates);

/// The Poisson(1) weights of the pair with seed `seed` in each replicate. They depend only on the
/// seed: they are the same for all pairs of variants, in any order, on any shard. Overwrites `out`
/// with kBootstrapReplicates weights.
void poisson_weights(std::uint64_t seed, Eigen::ArrayXd& out);

/// The mean of (variant − baseline) of a quantity.
struct MeanDifference {
  std::string quantity;
  std::int64_t pairs = 0;
  std::int64_t left_out = 0;  ///< pairs in which the number is missing, e.g. after a fault
  std::int64_t higher = 0;    ///< pairs in which the variant's number is greater
  std::int64_t lower = 0;
  double mean = std::numeric_limits<double>::quiet_NaN();
  RateInterval interval{};  ///< 99 %
};

/// "reached", "unsafe" (shares of episodes), "cost", "min_clearance" (m), "certified" (mean of the
/// next step's certificates), "iterations" (median over the plans).
[[nodiscard]] const std::vector<std::string>& paired_quantities();

class PairedDifference {
 public:
  PairedDifference();

  /// Adds two episodes of the same seed. A faulted episode counts as not having reached the target,
  /// and its pair is kept for that; its other numbers are meaningless, and their pairs are left
  /// out.
  void add(const EpisodeRow& baseline, const EpisodeRow& variant);
  /// The same with the poisson_weights of their seed, for callers that add several pairs of it.
  void add(const EpisodeRow& baseline, const EpisodeRow& variant, const Eigen::ArrayXd& weights);

  /// The differences in the order of paired_quantities.
  [[nodiscard]] std::vector<MeanDifference> result() const;

 private:
  struct Quantity {
    std::int64_t count = 0;
    std::int64_t left_out = 0;
    std::int64_t higher = 0;
    std::int64_t lower = 0;
    double sum = 0.0;
    Eigen::ArrayXd sums = Eigen::ArrayXd::Zero(kBootstrapReplicates);
    Eigen::ArrayXd left_out_weights{};  ///< empty if none is left out
  };
  std::vector<Quantity> quantities_;
  /// Sums over all pairs. They are integers and thus exact in any order, so the weights left out of
  /// a quantity can be subtracted at the end.
  Eigen::ArrayXd all_weights_ = Eigen::ArrayXd::Zero(kBootstrapReplicates);
  Eigen::ArrayXd weights_{};  ///< of the pair being added
};

}  // namespace qsmpc::harness
