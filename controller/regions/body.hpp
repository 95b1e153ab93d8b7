// The body of a vehicle, covered by discs, which must keep clear of the unsafe set.
#pragma once

#include <vector>

#include <Eigen/Core>

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// A disc fixed to the body.
struct Disc {
  double radius = 0.0;                               ///< m, ≥ 0
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< of its centre from the position, in the
                                                     ///< body's frame (forward, left), m
};

/// The discs that cover the vehicle, and the states that give its pose.
struct Body {
  std::vector<Disc> discs;  ///< if empty, the vehicle is the point at its position
  // State indices; -1 if the system has no such state.
  int x = -1;
  int y = -1;
  int heading = -1;

  [[nodiscard]] bool is_point() const { return discs.empty(); }
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
