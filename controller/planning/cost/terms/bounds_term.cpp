// The smooth penalties of the bounds, in expectation over what particles stand for.
#include "controller/planning/cost/cost_terms.hpp"
#include "controller/planning/cost/expected_bounds.hpp"

namespace qsmpc::controller {
namespace {

class BoundsTerm final : public StageTerm {
 public:
  explicit BoundsTerm(ExpectedBounds bounds) : bounds_(std::move(bounds)) {}

  [[nodiscard]] TermPlace place() const override { return TermPlace::kStepped; }
  [[nodiscard]] bool needs_all() const override { return true; }

  void freeze(const FrozenHorizon& frozen) override {
    noise_deviations_ = frozen.noise_covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  }

  double add(const TermBatch& batch, const Executor& run) override {
    clear_if_blank(batch);
    const double smoothing =
        batch.lone ? 0.0 : smoothing_of(batch.points.cols(), batch.points.rows());
    return bounds_.add({.noise_deviation = noise_deviations_, .smoothing = smoothing}, batch.points,
                       batch.weights, run, batch.gradient);
  }

 private:
  ExpectedBounds bounds_;
  Eigen::VectorXd noise_deviations_;
};

}  // namespace

std::unique_ptr<StageTerm> make_bounds_term(const HorizonCostTerms& terms) {
  ExpectedBounds bounds(terms.safe_set, terms.penalty);
  if (bounds.empty()) return nullptr;
  return std::make_unique<BoundsTerm>(std::move(bounds));
}

}  // namespace qsmpc::controller
