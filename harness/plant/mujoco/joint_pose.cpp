#include "harness/plant/mujoco/joint_pose.hpp"

#include "harness/mujoco/joint_positions.hpp"
#include "harness/mujoco/mujoco_model.hpp"
#include "harness/scenario/plant_mapping_reader.hpp"

namespace qsmpc::harness {

std::optional<JointPose> JointPose::of(const Scenario& scenario,
                                       const models::SystemDescription& system,
                                       const std::string& mjcf) {
  const MujocoModelPtr model = load_mujoco_model(mjcf);
  const std::optional<std::string> own = custom_text(*model, kMappingText);
  if (!scenario.plant.mapping && !own) return std::nullopt;
  const PlantMapping mapping =
      scenario.plant.mapping
          ? *scenario.plant.mapping
          : own_plant_mapping(own, mjcf,
                              {.description = system, .parameters = scenario.model.parameters});
  JointPose pose;
  pose.reference_ = reference_positions(*model);
  for (std::size_t i = 0; i < system.states.size(); ++i) {
    const auto found = mapping.states.find(system.states[i].name);
    if (found == mapping.states.end()) continue;
    const PlantQuantity& quantity = found->second;
    const bool is_position = quantity.source == QuantitySource::kJoint &&
                             quantity.quantity == joint_quantities().front();
    if (!is_position) continue;
    pose.joints_.push_back({.state = static_cast<Eigen::Index>(i),
                            .place = joint_place(*model, mjcf, quantity.element),
                            .gain = quantity.gain,
                            .offset = quantity.offset});
  }
  return pose;
}

std::vector<double> JointPose::qpos(const Eigen::Ref<const Eigen::VectorXd>& state) const {
  std::vector<double> values = reference_;
  for (const Joint& joint : joints_) {
    values[joint.place] = (state[joint.state] - joint.offset) / joint.gain;
  }
  return values;
}

}  // namespace qsmpc::harness
