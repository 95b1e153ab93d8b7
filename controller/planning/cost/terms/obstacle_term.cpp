// The smooth penalties of obstacles, at the particles of each stage.
#include "controller/planning/cost/cost_terms.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {
namespace {

class ObstacleTerm final : public StageTerm {
 public:
  ObstacleTerm(const SafeSet& safe_set, const Penalty& penalty)
      : unsafe_(safe_set), penalty_(penalty) {}

  [[nodiscard]] TermPlace place() const override { return TermPlace::kParticles; }

  double add(const TermBatch& batch, const Executor& /*run*/) override {
    clear_if_blank(batch);
    const PenaltyBatch particles{.locations = batch.points,
                                 .weights = batch.weights,
                                 .range = batch.range,
                                 .scale = penalty_.obstacle,
                                 .length = penalty_.length,
                                 .adjoint = batch.gradient};
    double value = 0.0;
    for (const RegionPointer& obstacle : unsafe_.obstacles()) {
      value += obstacle->add_penalty(batch.stage, particles);
    }
    return value;
  }

 private:
  UnsafeSet unsafe_;
  const Penalty& penalty_;
};

}  // namespace

std::unique_ptr<StageTerm> make_obstacle_term(const HorizonCostTerms& terms) {
  if (terms.penalty.shape != PenaltyShape::kSmooth || terms.safe_set.obstacles.empty()) {
    return nullptr;
  }
  return std::make_unique<ObstacleTerm>(terms.safe_set, terms.penalty);
}

}  // namespace qsmpc::controller
