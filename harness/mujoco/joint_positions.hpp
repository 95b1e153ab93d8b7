// A model's joint positions, by name.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

struct mjModel_;

namespace qsmpc::harness {

/// The generalised coordinates of all joints at the model's reference pose.
[[nodiscard]] std::vector<double> reference_positions(const mjModel_& model);

/// The index among them of the slide or hinge joint called `name`. Throws InputError, with `file`,
/// where there is none.
[[nodiscard]] std::size_t joint_place(const mjModel_& model, const std::string& file,
                                      const std::string& name);

}  // namespace qsmpc::harness
