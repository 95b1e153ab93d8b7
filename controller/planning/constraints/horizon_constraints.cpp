#include "controller/planning/constraints/horizon_constraints.hpp"

#include <algorithm>

namespace qsmpc::controller {

HorizonConstraints::HorizonConstraints(HorizonCost& cost, const SafeSet& safe_set) : cost_(cost) {
  for (const StageConstraintEntry& entry : stage_constraints()) {
    std::unique_ptr<const StageConstraint> constraint = entry.make(safe_set);
    if (constraint != nullptr) constraints_.push_back(std::move(constraint));
  }
}

void HorizonConstraints::describe(const Prediction& prediction, ConstraintSet& out) {
  blocks_.clear();
  out.group.clear();
  out.count = 0;
  for (Eigen::Index stage = 1; stage < static_cast<Eigen::Index>(prediction.stages.size());
       ++stage) {
    for (const auto& constraint : constraints_) {
      const Eigen::Index size = constraint->group_size(prediction.stages[stage].size());
      for (int group = 0; group < constraint->groups(); ++group) {
        out.group.insert(out.group.end(), size, static_cast<int>(blocks_.size()));
        blocks_.push_back({out.count, stage, size, constraint.get(), group});
        out.count += size;
      }
    }
  }
  particle_count_ = out.count;
  for (Eigen::Index j = 0; risk_ != nullptr && j < risk_->count(); ++j) {
    out.group.push_back(static_cast<int>(blocks_.size() + static_cast<std::size_t>(j)));
    ++out.count;
  }
  out.values = [this](const Eigen::VectorXd& z, Eigen::VectorXd& answer) { values(z, answer); };
  out.some = [this](const Eigen::VectorXd& z, const std::vector<int>& which,
                    Eigen::VectorXd& answer,
                    Eigen::MatrixXd& gradients) { some(z, which, answer, gradients); };
}

void HorizonConstraints::values(const Eigen::VectorXd& z, Eigen::VectorXd& out) {
  cost_.rollout(z);
  for (const Block& block : blocks_) {
    auto segment = out.segment(block.begin, block.size);
    block.constraint->values(block.stage, block.group, cost_.particles(block.stage), segment);
    segment.array() += margin_;
  }
  if (risk_ != nullptr) out.tail(risk_->count()) = risk_->values(z);
}

void HorizonConstraints::some(const Eigen::VectorXd& z, const std::vector<int>& which,
                              Eigen::VectorXd& out, Eigen::MatrixXd& gradients) {
  cost_.rollout(z);
  gradient_.resize(z.size());
  for (std::size_t j = 0; j < which.size(); ++j) {
    if (which[j] >= particle_count_) {
      const Eigen::Index limit = which[j] - particle_count_;
      out[j] = risk_->values(z)[limit];
      multipliers_.setZero(risk_->count());
      multipliers_[limit] = 1.0;
      gradient_.setZero();
      risk_->add_gradient(multipliers_, gradient_);
      gradients.col(j) = gradient_;
      continue;
    }
    const auto after = std::upper_bound(
        blocks_.begin(), blocks_.end(), which[j],
        [](Eigen::Index index, const Block& block) { return index < block.begin; });
    const Block& block = *(after - 1);
    out[j] = margin_ + block.constraint->value_and_slope(block.stage, block.group,
                                                         cost_.particles(block.stage),
                                                         which[j] - block.begin, slope_);
    cost_.pull_back(block.stage, slope_, gradient_);
    gradients.col(j) = gradient_;
  }
}

}  // namespace qsmpc::controller
