// By how much two variants differ, pair by pair: the episodes of one seed have the same random
// numbers, so that most of what is random cancels in their difference.
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

/// Replicates of the bootstrap: the limits of 99 % are its 10th values from either end.
inline constexpr int kBootstrapReplicates = 2000;
/// How often a limit of an interval is wrong, at most: two of them make 99 %.
inline constexpr double kCampaignTail = 0.005;

/// What of one quantity is drawn in all pairs: sums over O(replicates), whatever their number.
///
/// A streaming bootstrap: in each replicate each pair counts as often as a Poisson(1) number says.
/// The multinomial weights of the usual bootstrap tend to these, and these need no more of the
/// sample than one pair at a time. (Hanley, MacGibbon: "Creating non-parametric bootstrap samples
/// using Poisson frequencies", Computer Methods and Programs in Biomedicine 83, 2006. Chamandy,
/// Muralidharan, Najmi, Naidu: "Estimating uncertainty for massive data streams", 2012.)
class BootstrapMean {
 public:
  /// value: finite; weights: kBootstrapReplicates.
  void add(double value, const Eigen::ArrayXd& weights);

  [[nodiscard]] std::int64_t count() const { return count_; }
  /// Not a number where nothing was added.
  [[nodiscard]] double mean() const;
  /// The percentile interval: that the mean is below it, or above it, is each as probable as
  /// kCampaignTail, for large samples. Not numbers for fewer than two values.
  [[nodiscard]] RateInterval interval() const;

 private:
  std::int64_t count_ = 0;
  double sum_ = 0.0;
  Eigen::ArrayXd sums_ = Eigen::ArrayXd::Zero(kBootstrapReplicates);
  Eigen::ArrayXd weights_ = Eigen::ArrayXd::Zero(kBootstrapReplicates);
};

/// The percentile interval of Σ wₙ xₙ / Σ wₙ, of `sums` and `weights` in each replicate; as
/// BootstrapMean::interval.
[[nodiscard]] RateInterval bootstrap_interval(std::int64_t count, const Eigen::ArrayXd& sums,
                                              const Eigen::ArrayXd& weights);

/// The percentile interval of a statistic of which `replicates` are the bootstrap replicates, in
/// any order: each limit is outside of as many of them as kCampaignTail says. Not numbers without
/// any.
[[nodiscard]] RateInterval percentile_interval(std::vector<double> replicates);

/// The Poisson(1) weights of the pair of seed `seed` in each replicate, from that seed alone: the
/// same for all pairs of variants, in any order, on any shard. Overwrites `out`,
/// kBootstrapReplicates long.
void poisson_weights(std::uint64_t seed, Eigen::ArrayXd& out);

/// A quantity's mean of (variant − baseline).
struct MeanDifference {
  std::string quantity;
  std::int64_t pairs = 0;
  std::int64_t left_out = 0;  ///< pairs of which one has no such number, as after a fault
  std::int64_t higher = 0;    ///< pairs in which the variant has the greater number
  std::int64_t lower = 0;
  double mean = std::numeric_limits<double>::quiet_NaN();
  RateInterval interval{};  ///< 99 %
};

/// "reached", "unsafe" (shares of episodes), "cost", "min_clearance" (m), "certified" (mean of the
/// next step's certificates), "iterations" (median of a plan).
[[nodiscard]] const std::vector<std::string>& paired_quantities();

class PairedDifference {
 public:
  PairedDifference();

  /// Episodes of the same seed. One that faulted did not reach the target, which drops no pair;
  /// its other numbers say nothing, and their pair is left out.
  void add(const EpisodeRow& baseline, const EpisodeRow& variant);
  /// The same with the poisson_weights of their seed, for those who add several pairs of it.
  void add(const EpisodeRow& baseline, const EpisodeRow& variant, const Eigen::ArrayXd& weights);

  /// By quantity, in the order of paired_quantities.
  [[nodiscard]] std::vector<MeanDifference> result() const;

 private:
  struct Quantity {
    std::int64_t count = 0;
    std::int64_t left_out = 0;
    std::int64_t higher = 0;
    std::int64_t lower = 0;
    double sum = 0.0;
    Eigen::ArrayXd sums = Eigen::ArrayXd::Zero(kBootstrapReplicates);
    Eigen::ArrayXd left_out_weights{};  ///< empty where none is left out
  };
  std::vector<Quantity> quantities_;
  /// Of all pairs. Sums of whole numbers, exact in any order: what is left out of a quantity is
  /// subtracted in the end.
  Eigen::ArrayXd all_weights_ = Eigen::ArrayXd::Zero(kBootstrapReplicates);
  Eigen::ArrayXd weights_{};  ///< of the pair that is added
};

}  // namespace qsmpc::harness
