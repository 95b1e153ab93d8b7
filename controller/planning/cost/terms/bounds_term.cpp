// The smooth penalties of the bounds, in expectation over the laws that particles represent.
#include <utility>
#include <vector>

#include "controller/planning/cost/cost_terms.hpp"
#include "controller/planning/cost/expected_bounds.hpp"
#include "controller/regions/unsafe_set.hpp"

namespace qsmpc::controller {
namespace {

class BoundsTerm final : public StageTerm {
 public:
  explicit BoundsTerm(const HorizonCostTerms& terms) {
    const UnsafeSet unsafe(terms.safe_set);
    for (const DiscView& disc : unsafe.discs()) {
      ExpectedBounds bounds(disc.bounds, terms.penalty);
      if (!bounds.empty()) discs_.push_back({disc.placement, std::move(bounds), {}, {}});
    }
  }

  [[nodiscard]] bool empty() const { return discs_.empty(); }
  [[nodiscard]] TermPlace place() const override { return TermPlace::kStepped; }
  [[nodiscard]] bool needs_all() const override { return true; }

  void freeze(const FrozenHorizon& frozen) override {
    noise_deviations_ = frozen.noise_covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  }

  double add(const TermBatch& batch, const Executor& run) override {
    clear_if_blank(batch);
    const double smoothing =
        batch.lone ? 0.0 : smoothing_of(batch.points.cols(), batch.points.rows());
    const ExpectedBounds::Law law{.noise_deviation = noise_deviations_, .smoothing = smoothing};
    double value = 0.0;
    for (DiscBounds& disc : discs_) {
      if (disc.placement.at_position()) {
        value += disc.bounds.add(law, batch.points, batch.weights, run, batch.gradient);
        continue;
      }
      disc.placement.of(batch.points, batch.range, disc.centres);
      disc.gradient.setZero(disc.centres.rows(), disc.centres.cols());
      value += disc.bounds.add(law, disc.centres, batch.weights, run, disc.gradient);
      disc.placement.pull_back(batch.points, batch.range, disc.gradient, batch.gradient);
    }
    return value;
  }

 private:
  /// One disc of the body, with scratch.
  struct DiscBounds {
    DiscPlacement placement;
    ExpectedBounds bounds;
    Points centres;
    Points gradient;
  };

  std::vector<DiscBounds> discs_;
  Eigen::VectorXd noise_deviations_;
};

}  // namespace

std::unique_ptr<StageTerm> make_bounds_term(const HorizonCostTerms& terms) {
  auto term = std::make_unique<BoundsTerm>(terms);
  if (term->empty()) return nullptr;
  return term;
}

}  // namespace qsmpc::controller
