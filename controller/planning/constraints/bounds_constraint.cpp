// Every particle within the bounds of the safe set (Eq. 4-8): c is how far it is beyond a face, in
// the unit of the state.
#include <cmath>

#include "controller/planning/constraints/stage_constraint.hpp"

namespace qsmpc::controller {
namespace {

class BoundsConstraint final : public StageConstraint {
 public:
  explicit BoundsConstraint(const Box& bounds) {
    for (Eigen::Index axis = 0; axis < bounds.lower.size(); ++axis) {
      if (std::isfinite(bounds.lower[axis])) faces_.push_back({axis, -1.0, bounds.lower[axis]});
      if (std::isfinite(bounds.upper[axis])) faces_.push_back({axis, 1.0, bounds.upper[axis]});
    }
  }

  [[nodiscard]] int groups() const override { return static_cast<int>(faces_.size()); }
  [[nodiscard]] Eigen::Index group_size(Eigen::Index particles) const override { return particles; }

  void values(Eigen::Index /*stage*/, int group, const Points& particles,
              Eigen::Ref<Eigen::VectorXd> values) const override {
    const Face& face = faces_[group];
    values = face.sign * (particles.row(face.axis).array() - face.at);
  }

  [[nodiscard]] double value_and_slope(Eigen::Index /*stage*/, int group, const Points& particles,
                                       Eigen::Index index, StageSlope& slope) const override {
    const Face& face = faces_[group];
    slope.particles.assign(1, index);
    slope.by_particle.setZero(particles.rows(), 1);
    slope.by_particle(face.axis, 0) = face.sign;
    return face.sign * (particles(face.axis, index) - face.at);
  }

 private:
  struct Face {
    Eigen::Index axis;
    double sign;  ///< +1: x ≤ at; −1: x ≥ at
    double at;
  };

  std::vector<Face> faces_;
};

}  // namespace

std::unique_ptr<const StageConstraint> make_bounds_constraint(const SafeSet& safe_set) {
  auto constraint = std::make_unique<const BoundsConstraint>(safe_set.bounds);
  if (constraint->groups() == 0) return nullptr;
  return constraint;
}

}  // namespace qsmpc::controller
