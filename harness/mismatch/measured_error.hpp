// Bounds of a plant's model error from samples of it, with a margin for the samples being few.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "controller/prediction/model_error.hpp"

namespace qsmpc {

/// Residuals of one kind, in units that are independent of each other: episodes or paths.
struct ResidualSample {
  std::vector<Eigen::MatrixXd> units{};  ///< each state_dim x periods; columns that are not finite
                                         ///< (of a plant that broke) do not count
  /// Whether the n-th column of all units is a sample of its own, as the periods of an ensemble
  /// are, all of which a certificate needs the bound for; else the columns of a unit are one.
  bool by_period = false;
};

/// Probability with which a bound is too small, as far as the bootstrap goes.
inline constexpr double kErrorTail = 0.01;
inline constexpr int kReplicates = 2000;

/// What `samples` say of the model error, its norms widened to upper confidence limits: of each
/// coordinate and order, the largest over the samples and, where these are `by_period`, over the
/// periods. Mean and covariance are those of all columns of the first sample.
///
/// Units are drawn with replacement, kReplicates times, from the random numbers of `seed`. With ν
/// the norm of the sample and ν* those of the replicates, the limit is ν max(ν/ν*_tail,
/// ν*_(1−tail)/ν): the basic and the percentile limit of ln ν, whichever is larger. (Davison,
/// Hinkley: "Bootstrap methods and their application", 1997, sections 5.2 and 3.8.)
/// Throws std::invalid_argument if a sample has no finite column.
[[nodiscard]] ModelError measured_model_error(const std::vector<ResidualSample>& samples,
                                              std::uint64_t seed);

}  // namespace qsmpc
