// The joint positions of a vehicle in a given state, for episodes that were not driven in MuJoCo.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "harness/scenario/scenario.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

class JointPose {
 public:
  /// Of the MuJoCo file `mjcf`, with the mapping of `scenario` or of the file itself; nothing where
  /// neither has one. Throws InputError where the file is not a model, or a joint is missing.
  [[nodiscard]] static std::optional<JointPose> of(const Scenario& scenario,
                                                   const models::SystemDescription& system,
                                                   const std::string& mjcf);

  /// The positions of all joints of the model; those that are not states are at its reference pose.
  [[nodiscard]] std::vector<double> qpos(const Eigen::Ref<const Eigen::VectorXd>& state) const;

 private:
  struct Joint {
    Eigen::Index state = 0;
    std::size_t place = 0;
    double gain = 1.0;  // state = gain · position + offset
    double offset = 0.0;
  };

  std::vector<double> reference_;
  std::vector<Joint> joints_;
};

}  // namespace qsmpc::harness
