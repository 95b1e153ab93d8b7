// Draws of which random problems consist.
#pragma once

#include <Eigen/Core>

#include "tests/support/simulated_truth.hpp"

namespace qsmpc::testing {

/// A draw from the interval.
[[nodiscard]] double uniform(Generator& generator, double lower, double upper);

/// The same of whole numbers, both ends included.
[[nodiscard]] int uniform_int(Generator& generator, int lower, int upper);

[[nodiscard]] bool chance(Generator& generator, double probability);

/// Between 10^low and 10^high, uniform in the logarithm.
[[nodiscard]] double log_uniform(Generator& generator, double low, double high);

[[nodiscard]] Eigen::VectorXd uniform_vector(Generator& generator, Eigen::Index size, double lower,
                                             double upper);

/// Correlated (dim x dim), with deviations between 10^low and 10^high; sometimes one coordinate is
/// exactly known.
[[nodiscard]] Eigen::MatrixXd random_covariance(Generator& generator, Eigen::Index dim, double low,
                                                double high);

}  // namespace qsmpc::testing
