#include "controller/planning/solvers/box_qp.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

namespace qsmpc::controller {
namespace {

// Projected Newton steps per programme. Each identifies part of the active set; even a step that is
// not yet optimal is a descent direction.
constexpr int kMostSteps = 8;
// Halvings of one projected step.
constexpr int kMostHalvings = 8;
// Fraction of the predicted decrease that a projected step must achieve (Armijo).
constexpr double kSufficientShare = 0.1;

}  // namespace

void BoxQp::resize(Eigen::Index n) {
  if (slope_.size() == n) return;
  free_.reserve(n);
  factor_.resize(n * n);
  for (Eigen::VectorXd* vector : {&direction_, &trial_, &curved_, &slope_}) vector->resize(n);
}

bool BoxQp::collect_free(const Eigen::VectorXd& step, const Eigen::VectorXd& lower,
                         const Eigen::VectorXd& upper) {
  bool changed = false;
  std::size_t count = 0;
  for (Eigen::Index i = 0; i < step.size(); ++i) {
    const bool held =
        (step[i] <= lower[i] && slope_[i] >= 0.0) || (step[i] >= upper[i] && slope_[i] <= 0.0);
    if (held) continue;
    if (count == free_.size()) {
      free_.push_back(i);
      changed = true;
    } else if (free_[count] != i) {
      free_[count] = i;
      changed = true;
    }
    ++count;
  }
  changed = changed || count != free_.size();
  free_.resize(count);
  return changed;
}

bool BoxQp::newton_direction(const Eigen::MatrixXd& hessian) {
  const auto size = static_cast<Eigen::Index>(free_.size());
  Eigen::Map<Eigen::MatrixXd> block(factor_.data(), size, size);
  for (Eigen::Index j = 0; j < size; ++j) {
    for (Eigen::Index i = j; i < size; ++i) block(i, j) = hessian(free_[i], free_[j]);
    direction_[j] = -slope_[free_[j]];
  }
  Eigen::Ref<Eigen::MatrixXd> in_place(block);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(in_place);
  if (cholesky.info() != Eigen::Success) return false;
  auto solution = direction_.head(size);
  cholesky.matrixL().solveInPlace(solution);
  cholesky.matrixU().solveInPlace(solution);
  return true;
}

bool BoxQp::advance(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                    const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                    Eigen::VectorXd& step) {
  double length = 1.0;
  clipped_ = false;
  for (int halving = 0; halving < kMostHalvings; ++halving, length *= 0.5) {
    trial_ = step;
    double promised = 0.0;
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const Eigen::Index i = free_[k];
      const double target = step[i] + length * direction_[static_cast<Eigen::Index>(k)];
      trial_[i] = std::clamp(target, lower[i], upper[i]);
      clipped_ = clipped_ || trial_[i] != target;
      promised += slope_[i] * (trial_[i] - step[i]);
    }
    curved_.noalias() = hessian * trial_;
    const double value = trial_.dot(gradient) + 0.5 * trial_.dot(curved_);
    if (value <= value_ + kSufficientShare * promised) {
      step.swap(trial_);
      slope_ = gradient + curved_;
      value_ = value;
      return true;
    }
    clipped_ = true;
  }
  return false;
}

bool BoxQp::solve(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                  const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                  Eigen::VectorXd& step) {
  step.setZero();
  slope_ = gradient;
  value_ = 0.0;
  clipped_ = true;
  for (int k = 0; k < kMostSteps; ++k) {
    const bool changed = collect_free(step, lower, upper);
    // A full Newton step among the same free entries was the optimum.
    if (free_.empty() || (k > 0 && !changed && !clipped_)) break;
    if (!newton_direction(hessian)) return false;
    if (!advance(hessian, gradient, lower, upper, step)) break;
  }
  return true;
}

}  // namespace qsmpc::controller
