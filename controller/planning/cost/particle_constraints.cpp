#include "controller/planning/cost/particle_constraints.hpp"

#include <algorithm>
#include <cmath>

namespace qsmpc::controller {

ParticleConstraints::ParticleConstraints(HorizonCost& cost, const SafeSet& safe_set) : cost_(cost) {
  const Box& bounds = safe_set.bounds;
  for (Eigen::Index axis = 0; axis < bounds.lower.size(); ++axis) {
    if (std::isfinite(bounds.lower[axis])) faces_.push_back({axis, -1.0, bounds.lower[axis]});
    if (std::isfinite(bounds.upper[axis])) faces_.push_back({axis, 1.0, bounds.upper[axis]});
  }
}

void ParticleConstraints::describe(const Prediction& prediction, ConstraintSet& out) {
  blocks_.clear();
  out.group.clear();
  out.count = 0;
  for (Eigen::Index stage = 1; stage < static_cast<Eigen::Index>(prediction.stages.size());
       ++stage) {
    const Eigen::Index particles = prediction.stages[stage].size();
    for (int face = 0; face < static_cast<int>(faces_.size()); ++face) {
      out.group.insert(out.group.end(), particles, static_cast<int>(blocks_.size()));
      blocks_.push_back({out.count, stage, particles, face});
      out.count += particles;
    }
  }
  out.values = [this](const Eigen::VectorXd& z, Eigen::VectorXd& answer) { values(z, answer); };
  out.some = [this](const Eigen::VectorXd& z, const std::vector<int>& which,
                    Eigen::VectorXd& answer,
                    Eigen::MatrixXd& gradients) { some(z, which, answer, gradients); };
}

void ParticleConstraints::values(const Eigen::VectorXd& z, Eigen::VectorXd& out) {
  cost_.rollout(z);
  for (const Block& block : blocks_) {
    const Face& face = faces_[block.face];
    out.segment(block.begin, block.particles) =
        face.sign * (cost_.particles(block.stage).row(face.axis).array() - face.at) + margin_;
  }
}

void ParticleConstraints::some(const Eigen::VectorXd& z, const std::vector<int>& which,
                               Eigen::VectorXd& out, Eigen::MatrixXd& gradients) {
  cost_.rollout(z);
  gradient_.resize(z.size());
  for (std::size_t j = 0; j < which.size(); ++j) {
    const auto after = std::upper_bound(
        blocks_.begin(), blocks_.end(), which[j],
        [](Eigen::Index index, const Block& block) { return index < block.begin; });
    const Block& block = *(after - 1);
    const Face& face = faces_[block.face];
    const Eigen::Index particle = which[j] - block.begin;
    out[j] = face.sign * (cost_.particles(block.stage)(face.axis, particle) - face.at) + margin_;
    cost_.particle_gradient(block.stage, particle, face.axis, gradient_);
    gradients.col(j) = face.sign * gradient_;
  }
}

}  // namespace qsmpc::controller
