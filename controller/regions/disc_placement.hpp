// The centre of a disc of the body, as the state with its position moved there.
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/parallel.hpp"
#include "controller/regions/body.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// x ↦ x with p + R(φ) o in place of its position p, where φ is the heading and o the disc's
/// offset.
class DiscPlacement {
 public:
  /// The identity.
  DiscPlacement() = default;
  /// `body` names the states of position and heading; a disc with an offset needs all three.
  DiscPlacement(const Body& body, const Disc& disc);

  /// Whether the centre is the position itself, i.e. the map is the identity.
  [[nodiscard]] bool at_position() const { return reach_ == 0.0; }
  /// |o|, m
  [[nodiscard]] double reach() const { return reach_; }
  /// The angle of o in the body's frame, rad.
  [[nodiscard]] double bearing() const { return bearing_; }
  // State indices, unless at_position().
  [[nodiscard]] int x() const { return x_; }
  [[nodiscard]] int y() const { return y_; }
  [[nodiscard]] int heading() const { return heading_; }
  /// Lipschitz constant of the map in the Euclidean norm: |o|/2 + √(1 + |o|²/4), and 1 at the
  /// position.
  [[nodiscard]] double lipschitz() const;

  [[nodiscard]] Eigen::VectorXd of(const Eigen::Ref<const Eigen::VectorXd>& state) const;
  /// The same for the columns `range` of `states`, into columns 0 … of `out`, which is resized.
  void of(const Points& states, ParticleRange range, Points& out) const;
  /// Applies the chain rule to the derivatives by the moved states, in columns 0 … of
  /// `moved_adjoint`, and adds the derivatives by `states` to the columns `range` of `adjoint`.
  void pull_back(const Points& states, ParticleRange range, const Points& moved_adjoint,
                 Points& adjoint) const;

 private:
  double reach_ = 0.0;
  double bearing_ = 0.0;
  int x_ = -1;
  int y_ = -1;
  int heading_ = -1;
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
