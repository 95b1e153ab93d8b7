#include "harness/mujoco/joint_positions.hpp"

#include <mujoco/mujoco.h>

#include "harness/mujoco/named_model.hpp"

namespace qsmpc::harness {

std::vector<double> reference_positions(const mjModel_& model) {
  return {model.qpos0, model.qpos0 + model.nq};
}

std::size_t joint_place(const mjModel_& model, const std::string& file, const std::string& name) {
  const int joint = scalar_joint({.model = model, .file = file}, name);
  return static_cast<std::size_t>(model.jnt_qposadr[joint]);
}

}  // namespace qsmpc::harness
