// Algorithm 2 and Eq. 4-10 as printed, at the particles of each stage.
#include <stdexcept>

#include "controller/planning/cost/cost_terms.hpp"
#include "controller/planning/cost/printed_penalty.hpp"

namespace qsmpc::controller {
namespace {

class PrintedBoundsTerm final : public StageTerm {
 public:
  explicit PrintedBoundsTerm(const HorizonCostTerms& terms)
      : bounds_(bounded_axes(terms.safe_set.bounds)), penalty_(terms.penalty) {}

  [[nodiscard]] TermPlace place() const override { return TermPlace::kParticles; }

  double add(const TermBatch& batch, const Executor& /*run*/) override {
    clear_if_blank(batch);
    return printed_bounds_penalty(bounds_, penalty_.box, batch);
  }

 private:
  std::vector<AxisInterval> bounds_;
  const Penalty& penalty_;
};

class PrintedObstacleTerm final : public StageTerm {
 public:
  explicit PrintedObstacleTerm(const HorizonCostTerms& terms) : penalty_(terms.penalty) {
    if (terms.safe_set.road) throw std::invalid_argument("printed penalties do not support a road");
    for (const Obstacle& obstacle : terms.safe_set.obstacles) {
      if (obstacle.box() == nullptr) {
        throw std::invalid_argument("printed penalties support only boxes");
      }
      obstacles_.push_back(bounded_axes(*obstacle.box()));
    }
  }

  [[nodiscard]] TermPlace place() const override { return TermPlace::kParticles; }

  double add(const TermBatch& batch, const Executor& /*run*/) override {
    clear_if_blank(batch);
    return printed_obstacle_penalty(obstacles_, penalty_.obstacle, batch);
  }

 private:
  std::vector<std::vector<AxisInterval>> obstacles_;
  const Penalty& penalty_;
};

}  // namespace

std::unique_ptr<StageTerm> make_printed_bounds_term(const HorizonCostTerms& terms) {
  if (terms.penalty.shape != PenaltyShape::kThesis) return nullptr;
  return std::make_unique<PrintedBoundsTerm>(terms);
}

std::unique_ptr<StageTerm> make_printed_obstacle_term(const HorizonCostTerms& terms) {
  if (terms.penalty.shape != PenaltyShape::kThesis || terms.safe_set.obstacles.empty()) {
    return nullptr;
  }
  return std::make_unique<PrintedObstacleTerm>(terms);
}

}  // namespace qsmpc::controller
