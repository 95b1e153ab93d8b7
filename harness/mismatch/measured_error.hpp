// Bounds of a plant's model error from samples of it, with a margin for the samples being few.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "controller/prediction/model_error.hpp"

namespace qsmpc::harness {

/// Residuals of one kind, in units that are independent of each other: episodes or paths.
struct ResidualSample {
  /// Each state_dim x periods, from the first period of a drive on; columns that are not finite (of
  /// a plant that broke) do not count.
  std::vector<Eigen::MatrixXd> units{};
  /// Whether the n-th column of all units is a sample of its own, as the periods of an ensemble
  /// are, all of which a certificate needs the bound for; else the columns of a unit are one.
  bool by_period = false;
  /// Where it is: how many columns in a row count as one period, ≥ 1.
  Eigen::Index stretch = 1;
};

/// Probability with which a bound is too small, as far as the bootstrap goes.
inline constexpr double kErrorTail = 0.01;
inline constexpr int kReplicates = 2000;

/// What `samples` say of the model error, its norms widened to upper confidence limits: of each
/// coordinate and order, the largest over the samples. Mean and covariance are those of all columns
/// of the first sample.
///
/// Each of the first `first` periods has norms of its own, from the columns of that number, about
/// an offset halfway between the least and the largest mean of a sample; those about no offset,
/// from all other columns, stand for all later periods: the largest over the periods where a sample
/// is `by_period`. Where no sample is that long, all columns do. A period of a single unit has no
/// offset; else norms are √((n + 1)/(n − 1)) times larger, n the fewest units: this is what the
/// mean square about a mean of n is too small by.
///
/// Units are drawn with replacement, kReplicates times, from the random numbers of `seed`. With ν
/// the norm of the sample and ν* those of the replicates, the limit is ν max(ν/ν*_tail,
/// ν*_(1−tail)/ν): the basic and the percentile limit of ln ν, whichever is larger. (Davison,
/// Hinkley: "Bootstrap methods and their application", 1997, sections 5.2 and 3.8.)
/// Throws std::invalid_argument if a sample has no finite column.
[[nodiscard]] controller::ModelError measured_model_error(
    const std::vector<ResidualSample>& samples, std::uint64_t seed, Eigen::Index first = 0);

}  // namespace qsmpc::harness
