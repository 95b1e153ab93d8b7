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

/// The ellipse around the mean that contains `probability` in (0, 1) of the Gaussian with these
/// moments; its first axis is the longer one.
[[nodiscard]] render::PlanarEllipse probability_ellipse(const PlanarMoments& moments,
                                                        double probability);

/// The ellipse of points `deviations` standard deviations from the mean; its first axis is the
/// longer one.
[[nodiscard]] render::PlanarEllipse deviation_ellipse(const PlanarMoments& moments,
                                                      double deviations);

/// The 50 % and 95 % ellipses of each stage.
[[nodiscard]] std::vector<render::BeliefEllipses> belief_ellipses(
    const std::vector<PlanarMoments>& stages);

/// Sections of a tube's round end, at either end, in addition to those of the stages.
inline constexpr int kTubeEndSections = 8;

/// A tube through the stages: as wide across the path as the 95 % ellipses, with ends rounded like
/// the first and the last ellipse, so that it covers both. Stage k has `bounds[k - 1]` (stage 0 has
/// that of stage 1: there is none for the present) and is section k + kTubeEndSections. Empty
/// unless there is a bound for each later stage.
[[nodiscard]] std::vector<render::TubeSection> belief_tube(const std::vector<PlanarMoments>& stages,
                                                           const std::vector<double>& bounds);

}  // namespace qsmpc::harness
