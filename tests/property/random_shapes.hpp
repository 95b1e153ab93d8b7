// Random planar shapes beside a path, at rest or in motion.
#pragma once

#include <string>

#include <Eigen/Core>

#include "controller/regions/safe_set.hpp"
#include "tests/support/simulated_truth.hpp"

namespace qsmpc::testing {

/// A set without bounds, with 1 to 4 shapes of a kind (one half plane or road) beside `path`
/// (state_dim x stages), of the size of `spread` (state_dim), roughly the deviation of the state
/// from the path.
[[nodiscard]] controller::SafeSet random_shapes(Generator& generator, const std::string& kind,
                                                const Eigen::MatrixXd& path,
                                                const Eigen::VectorXd& spread);

/// Makes the shapes move, about as far as they are away from the path.
void set_in_motion(Generator& generator, const Eigen::VectorXd& spread, int horizon,
                   controller::SafeSet& safe_set);

}  // namespace qsmpc::testing
