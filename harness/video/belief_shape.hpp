// The shape of a stage's distribution in the plane: ellipses, and the tube along the plan.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "render/frame.hpp"

namespace qsmpc::harness {

/// Mean and covariance of weighted points in the plane.
struct PlanarMoments {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

/// The weighted moments of `stage`, which has points.
[[nodiscard]] PlanarMoments planar_moments(const render::ParticleStage& stage);

/// The ellipse about the mean that holds `probability` in (0, 1) of the Gaussian with these
/// moments; its first axis is the longer one.
[[nodiscard]] render::PlanarEllipse probability_ellipse(const PlanarMoments& moments,
                                                        double probability);

/// The ellipse of what is `deviations` standard deviations from the mean; its first axis is the
/// longer one.
[[nodiscard]] render::PlanarEllipse deviation_ellipse(const PlanarMoments& moments,
                                                      double deviations);

/// 50 % and 95 % of each stage.
[[nodiscard]] std::vector<render::BeliefEllipses> belief_ellipses(
    const std::vector<PlanarMoments>& stages);

/// Sections of a tube's round end besides those of the stages, at either end.
inline constexpr int kTubeEndSections = 8;

/// A tube through the stages, as wide across the way as the ellipses of 95 %, and at its ends as
/// round as those of the first and the last: it covers both. With `bounds[k - 1]` at stage k (and
/// at stage 0 the one of stage 1: there is none for the present). Stage k is section
/// k + kTubeEndSections. Empty without a bound for each later stage.
[[nodiscard]] std::vector<render::TubeSection> belief_tube(const std::vector<PlanarMoments>& stages,
                                                           const std::vector<double>& bounds);

}  // namespace qsmpc::harness
