// Where the joints of a vehicle are in a state, for episodes that were not driven in MuJoCo.
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
  /// Of the MuJoCo file `mjcf`, as `scenario` or the file itself says how the system appears in it;
  /// nothing where neither does. Throws InputError where the file is no model, or a joint is
  /// missing.
  [[nodiscard]] static std::optional<JointPose> of(const Scenario& scenario,
                                                   const models::SystemDescription& system,
                                                   const std::string& mjcf);

  /// Values of all joints of the model; those that are no state are at its reference pose.
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
