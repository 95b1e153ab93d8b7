// The bounds of the safe set as inequality constraints on every particle (Eq. 4-8).
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/planning/cost/horizon_cost.hpp"
#include "controller/planning/safe_set.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"

namespace qsmpc::controller {

/// constraint c + margin ≤ 0 for each particle of the stages 1 … horizon against each finite face
/// of the bounds; c is how far the particle is beyond the face, in the unit of the state. Refers to
/// both arguments.
class ParticleConstraints {
 public:
  ParticleConstraints(HorizonCost& cost, const SafeSet& safe_set);

  /// Makes `out` the constraints of the prediction that the cost holds now. To be called again
  /// whenever it holds another one; `out` refers to this object.
  void describe(const Prediction& prediction, ConstraintSet& out);

  /// Particles are asked to stay this far within the faces (≥ 0, in the unit of the state).
  void set_margin(double margin) { margin_ = margin; }
  [[nodiscard]] double margin() const { return margin_; }

 private:
  struct Face {
    Eigen::Index axis;
    double sign;  ///< +1: x ≤ at; −1: x ≥ at
    double at;
  };
  /// One face at one stage: as many constraints as particles.
  struct Block {
    Eigen::Index begin;
    Eigen::Index stage;
    Eigen::Index particles;
    int face;
  };

  void values(const Eigen::VectorXd& z, Eigen::VectorXd& out);
  void some(const Eigen::VectorXd& z, const std::vector<int>& which, Eigen::VectorXd& out,
            Eigen::MatrixXd& gradients);

  HorizonCost& cost_;
  double margin_ = 0.0;
  std::vector<Face> faces_;
  std::vector<Block> blocks_;
  Eigen::VectorXd gradient_;
};

}  // namespace qsmpc::controller
