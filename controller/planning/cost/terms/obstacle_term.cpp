// The smooth penalties of obstacles and of a road's edges, at the particles of each stage.
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
    double value = 0.0;
    for (const DiscView& disc : unsafe_.discs()) {
      value += disc.placement.at_position() ? penalty(disc, batch, batch.gradient)
                                            : penalty_of_moved(disc, batch);
    }
    return value;
  }

 private:
  [[nodiscard]] double penalty(const DiscView& disc, const TermBatch& batch,
                               Points& gradient) const {
    const PenaltyBatch particles{.locations = batch.points,
                                 .weights = batch.weights,
                                 .range = batch.range,
                                 .scale = penalty_.obstacle,
                                 .length = penalty_.length,
                                 .adjoint = gradient};
    double value = 0.0;
    for (const RegionPointer& region : disc.within_walls()) {
      value += region->add_penalty(batch.stage, particles);
    }
    return value;
  }

  [[nodiscard]] double penalty_of_moved(const DiscView& disc, const TermBatch& batch) const {
    // Per thread, as chunks are processed concurrently; allocates only for the largest one.
    thread_local Points centres;
    thread_local Points gradient;
    thread_local Eigen::VectorXd weights;
    const Eigen::Index count = batch.range.end - batch.range.begin;
    disc.placement.of(batch.points, batch.range, centres);
    gradient.setZero(centres.rows(), count);
    weights = batch.weights.segment(batch.range.begin, count);
    const TermBatch moved{.stage = batch.stage,
                          .points = centres,
                          .weights = weights,
                          .range = {.begin = 0, .end = count},
                          .gradient = gradient};
    const double value = penalty(disc, moved, gradient);
    if (value != 0.0) {
      disc.placement.pull_back(batch.points, batch.range, gradient, batch.gradient);
    }
    return value;
  }

  UnsafeSet unsafe_;
  const Penalty& penalty_;
};

}  // namespace

std::unique_ptr<StageTerm> make_obstacle_term(const HorizonCostTerms& terms) {
  const bool has_any = !terms.safe_set.obstacles.empty() || terms.safe_set.road != nullptr;
  const bool costs = terms.penalty.obstacle != 0.0 && has_any;
  if (terms.penalty.shape != PenaltyShape::kSmooth || !costs) return nullptr;
  return std::make_unique<ObstacleTerm>(terms.safe_set, terms.penalty);
}

}  // namespace qsmpc::controller
