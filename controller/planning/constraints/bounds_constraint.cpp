// Every particle's body within the bounds of the safe set (Eq. 4-8): c is the signed distance of a
// disc beyond a face, in the unit of the state.
#include <cmath>
#include <vector>

#include "controller/planning/constraints/stage_constraint.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {
namespace {

class BoundsConstraint final : public StageConstraint {
 public:
  explicit BoundsConstraint(const SafeSet& safe_set) {
    const UnsafeSet unsafe(safe_set);
    for (const DiscView& disc : unsafe.discs()) {
      const Box& bounds = disc.bounds;
      for (Eigen::Index axis = 0; axis < bounds.lower.size(); ++axis) {
        if (std::isfinite(bounds.lower[axis])) {
          faces_.push_back({disc.placement, axis, -1.0, bounds.lower[axis]});
        }
        if (std::isfinite(bounds.upper[axis])) {
          faces_.push_back({disc.placement, axis, 1.0, bounds.upper[axis]});
        }
      }
    }
  }

  [[nodiscard]] int groups() const override { return static_cast<int>(faces_.size()); }
  [[nodiscard]] Eigen::Index group_size(Eigen::Index particles) const override { return particles; }

  void values(Eigen::Index /*stage*/, int group, const Points& particles,
              Eigen::Ref<Eigen::VectorXd> values) const override {
    const Face& face = faces_[group];
    if (face.disc.at_position()) {
      values = face.sign * (particles.row(face.axis).array() - face.at);
      return;
    }
    Points centres;
    face.disc.of(particles, {.begin = 0, .end = particles.cols()}, centres);
    values = face.sign * (centres.row(face.axis).array() - face.at);
  }

  [[nodiscard]] double value_and_slope(Eigen::Index /*stage*/, int group, const Points& particles,
                                       Eigen::Index index, StageSlope& slope) const override {
    const Face& face = faces_[group];
    slope.particles.assign(1, index);
    Points by_centre = Points::Zero(particles.rows(), 1);
    by_centre(face.axis, 0) = face.sign;
    const Points particle = particles.col(index);
    Points by_particle = Points::Zero(particles.rows(), 1);
    face.disc.pull_back(particle, {.begin = 0, .end = 1}, by_centre, by_particle);
    slope.by_particle = by_particle;
    return face.sign * (face.disc.of(particle.col(0))[face.axis] - face.at);
  }

 private:
  struct Face {
    DiscPlacement disc;
    Eigen::Index axis;
    double sign;  ///< +1: x ≤ at; −1: x ≥ at
    double at;
  };

  std::vector<Face> faces_;
};

}  // namespace

std::unique_ptr<const StageConstraint> make_bounds_constraint(const SafeSet& safe_set) {
  auto constraint = std::make_unique<const BoundsConstraint>(safe_set);
  if (constraint->groups() == 0) return nullptr;
  return constraint;
}

}  // namespace qsmpc::controller
