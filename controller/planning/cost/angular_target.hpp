// Targets with angular coordinates, which are meant modulo 2π.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace qsmpc::controller {

/// Writes to `out` (n) the equivalent of `target` (n) that is nearest to `state` (n): each
/// coordinate in `angles` is shifted by the multiple of 2π that leaves it within π of that of
/// `state`; the others are those of `target`. Allocates nothing.
void nearest_target(const Eigen::Ref<const Eigen::VectorXd>& target, const std::vector<int>& angles,
                    const Eigen::Ref<const Eigen::VectorXd>& state, Eigen::VectorXd& out);

/// `state` less the target nearest to it: the argument of costs and distances.
[[nodiscard]] Eigen::VectorXd target_offset(const Eigen::Ref<const Eigen::VectorXd>& target,
                                            const std::vector<int>& angles,
                                            const Eigen::Ref<const Eigen::VectorXd>& state);

}  // namespace qsmpc::controller
