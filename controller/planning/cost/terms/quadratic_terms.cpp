// The quadratic terms: states and inputs along the horizon (Eq. 4-18) and the last state (Eq.
// 4-19).
//
// States are taken after the step and before the compression, which would lose part of the second
// moment:
//     ½ E|x − r|²_Q = ½ Σ_i ρ_i |f_i − r|²_Q + ½ tr(Q Σ_w),
// and likewise the terminal cost, without the ½. No decision changes the traces and the cost of the
// belief.
#include <vector>

#include "controller/planning/cost/cost_terms.hpp"
#include "controller/planning/cost/stage_kernels.hpp"

namespace qsmpc::controller {
namespace {

/// factor · E|x − centre|²_W at one place.
class QuadraticTerm : public StageTerm {
 public:
  [[nodiscard]] TermPlace place() const override { return place_; }

  double add(const TermBatch& batch, const Executor& /*run*/) override {
    return weighted_quadratic(form_at(batch.stage), factor_, batch.points, batch.weights,
                              batch.range, batch.gradient,
                              batch.blank ? GradientUse::kOverwrite : GradientUse::kAdd);
  }

 protected:
  QuadraticTerm(TermPlace place, double factor, const Eigen::MatrixXd& weight,
                const Eigen::VectorXd& centre)
      : place_(place), factor_(factor), form_(weight, centre) {}

  [[nodiscard]] const QuadraticForm& form_at(Eigen::Index stage) const {
    return stage_forms_.empty() ? form_ : stage_forms_[static_cast<std::size_t>(stage)];
  }

  /// Takes the current targets.
  void place_at(const QuadraticCost& cost) {
    form_.centre = cost.target;
    stage_forms_.resize(static_cast<std::size_t>(cost.stage_targets.cols()), form_);
    for (std::size_t k = 0; k < stage_forms_.size(); ++k) {
      stage_forms_[k].centre = cost.target_at(static_cast<Eigen::Index>(k));
    }
  }

 private:
  TermPlace place_;
  double factor_;
  QuadraticForm form_;
  std::vector<QuadraticForm> stage_forms_;  // for a moving target
};

class InputTerm final : public QuadraticTerm {
 public:
  explicit InputTerm(const Eigen::MatrixXd& weight)
      : QuadraticTerm(TermPlace::kInputs, 1.0, weight, Eigen::VectorXd::Zero(weight.rows())) {}
};

class StateTerm final : public QuadraticTerm {
 public:
  explicit StateTerm(const QuadraticCost& cost)
      : QuadraticTerm(TermPlace::kStepped, 0.5, cost.state, cost.target), cost_(cost) {}

  [[nodiscard]] bool acts(Eigen::Index stage, Eigen::Index horizon) const override {
    return stage < horizon;
  }

  void freeze(const FrozenHorizon& frozen) override {
    place_at(cost_);
    const Points& points = frozen.belief.locations;
    unused_.resize(points.rows(), points.cols());
    double belief = 0.0;
    for (Eigen::Index i = 0; i < points.cols(); i += kChunk) {
      belief += weighted_quadratic(form_at(0), 0.5, points, frozen.belief.weights,
                                   chunk_range(static_cast<int>(i / kChunk), points.cols()),
                                   unused_, GradientUse::kOverwrite);
    }
    const double noise = cost_.state.cwiseProduct(frozen.noise_covariance).sum();
    fixed_ = belief + 0.5 * (cost_.state.cwiseProduct(frozen.within_covariance).sum() +
                             static_cast<double>(frozen.horizon - 1) * noise);
  }

  [[nodiscard]] double fixed() const override { return fixed_; }

 private:
  const QuadraticCost& cost_;
  Points unused_;  // gradient of the belief's cost
  double fixed_ = 0.0;
};

class TerminalTerm final : public QuadraticTerm {
 public:
  explicit TerminalTerm(const QuadraticCost& cost)
      : QuadraticTerm(TermPlace::kStepped, 1.0, cost.terminal, cost.target), cost_(cost) {}

  [[nodiscard]] bool acts(Eigen::Index stage, Eigen::Index horizon) const override {
    return stage == horizon;
  }

  void freeze(const FrozenHorizon& frozen) override {
    place_at(cost_);
    fixed_ = cost_.terminal.cwiseProduct(frozen.noise_covariance).sum();
  }

  [[nodiscard]] double fixed() const override { return fixed_; }

 private:
  const QuadraticCost& cost_;
  double fixed_ = 0.0;
};

}  // namespace

std::unique_ptr<StageTerm> make_state_term(const HorizonCostTerms& terms) {
  return std::make_unique<StateTerm>(terms.cost);
}

std::unique_ptr<StageTerm> make_input_term(const HorizonCostTerms& terms) {
  return std::make_unique<InputTerm>(terms.cost.input);
}

std::unique_ptr<StageTerm> make_terminal_term(const HorizonCostTerms& terms) {
  return std::make_unique<TerminalTerm>(terms.cost);
}

}  // namespace qsmpc::controller
