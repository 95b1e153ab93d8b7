#pragma once

#include <vector>

#include <Eigen/Core>

namespace qsmpc::controller {

/// The derivative of a function of the particles of one stage.
struct StageSlope {
  std::vector<Eigen::Index> particles;  ///< those on which it depends
  Eigen::MatrixXd by_particle;          ///< state_dim x as many
};

}  // namespace qsmpc::controller
