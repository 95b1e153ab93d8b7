// Bounds on a plant's model error, estimated from samples, with a margin for the sample size.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "controller/prediction/model_error.hpp"

namespace qsmpc::harness {

/// Residuals of one kind, in mutually independent units: episodes or paths.
struct ResidualSample {
  /// Each state_dim x periods, from the first period of a drive on; columns that are not finite
  /// (from a plant that failed) are ignored.
  std::vector<Eigen::MatrixXd> units{};
  /// Whether the n-th columns of all units form a separate sample for each n, like the periods of
  /// an ensemble, each of which a certificate needs the bound for; otherwise all columns of a unit
  /// are one sample.
  bool by_period = false;
  /// If so, the number of successive columns that count as one period, ≥ 1.
  Eigen::Index stretch = 1;
};

/// Probability that a bound is too small, according to the bootstrap.
inline constexpr double kErrorTail = 0.01;
inline constexpr int kReplicates = 2000;

/// The model error estimated from `samples`, with its norms widened to upper confidence limits: for
/// each coordinate and order, the largest over the samples. Mean and covariance are those of all
/// columns of the first sample.
///
/// Each of the first `first` periods has its own norms, from the columns of that number, about an
/// offset halfway between the least and the largest mean of a sample; norms about no offset, from
/// all other columns, apply to all later periods: the largest over the periods where a sample is
/// `by_period`. If no sample is that long, all columns are used. A period with a single unit has no
/// offset; otherwise norms are multiplied by √((n + 1)/(n − 1)), n the fewest units, which corrects
/// the mean square about a mean of n samples.
///
/// Units are drawn with replacement, kReplicates times, with random numbers of `seed`. With ν the
/// norm of the sample and ν* those of the replicates, the limit is ν max(ν/ν*_tail, ν*_(1−tail)/ν):
/// the larger of the basic and the percentile limit of ln ν. (Davison, Hinkley:
/// "Bootstrap methods and their application", 1997, sections 5.2 and 3.8.) Throws
/// std::invalid_argument if a sample has no finite column.
[[nodiscard]] controller::ModelError measured_model_error(
    const std::vector<ResidualSample>& samples, std::uint64_t seed, Eigen::Index first = 0);

}  // namespace qsmpc::harness
