// The body of a vehicle as the discs that cover it: what has to keep clear of the unsafe set.
#pragma once

#include <vector>

#include <Eigen/Core>

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// A disc that is fixed to the body.
struct Disc {
  double radius = 0.0;                               ///< m, ≥ 0
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< of its centre from the position, in the
                                                     ///< body's frame (forward, left), m
};

/// Which discs cover the vehicle, and which states say where it stands.
struct Body {
  std::vector<Disc> discs;  ///< none: the vehicle is the point at its position
  // Indices of states; -1 where the system has none.
  int x = -1;
  int y = -1;
  int heading = -1;

  [[nodiscard]] bool is_point() const { return discs.empty(); }
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
