// Monte Carlo with frozen noise: the same draws in every call.
#include <memory>
#include <utility>

#include "controller/laws/closed_loop_step.hpp"
#include "controller/laws/covariance_root.hpp"
#include "controller/laws/law_makers.hpp"
#include "controller/laws/law_propagator.hpp"
#include "models/random/random_numbers.hpp"

namespace qsmpc::controller {
namespace {

class MonteCarloLaw final : public LawPropagator {
 public:
  explicit MonteCarloLaw(const LawSettings& settings)
      : samples_(settings.samples), seed_(settings.seed) {}

 private:
  [[nodiscard]] StageLaw begin(const LawProblem& problem) override {
    noise_root_ = covariance_root(problem.noise_covariance);
    const Points spread = covariance_root(problem.belief.covariance) * normals(problem, 0);
    return DiscreteMeasure{.locations = spread.colwise() + problem.belief.mean,
                           .weights = Eigen::VectorXd::Constant(samples_, 1.0 / samples_)};
  }

  [[nodiscard]] StageLaw advance(const LawProblem& problem, Eigen::Index stage,
                                 const StageLaw& law) override {
    const auto& points = std::get<DiscreteMeasure>(law);
    Points next = closed_loop_step(problem, stage, points.locations);
    next += noise_root_ * normals(problem, stage + 1);
    return DiscreteMeasure{.locations = std::move(next), .weights = points.weights};
  }

  /// Standard normals for the belief at stage 0, otherwise for the noise that leads to the stage:
  /// drawn once, so that the laws of two policies differ only by the policies.
  [[nodiscard]] const Points& normals(const LawProblem& problem, Eigen::Index stage) {
    const Eigen::Index dim = problem.belief.mean.size();
    if (!frozen_.empty() && frozen_.front().rows() != dim) frozen_.clear();
    while (static_cast<Eigen::Index>(frozen_.size()) <= stage) {
      Points drawn(dim, samples_);
      for (Eigen::Index i = 0; i < samples_; ++i) {
        drawn.col(i) = models::standard_normal_sample(
            dim, {.seed = seed_,
                  .episode = kFirstMethodPath + static_cast<std::uint64_t>(i),
                  .stream = models::RandomStream::kPrediction,
                  .step = frozen_.size()});
      }
      frozen_.push_back(std::move(drawn));
    }
    return frozen_[stage];
  }

  int samples_;
  std::uint64_t seed_;
  Eigen::MatrixXd noise_root_;
  std::vector<Points> frozen_;
};

}  // namespace

LawMethod monte_carlo_law() {
  return {.name = "monte_carlo",
          .summary = "Random paths with the same draws in every call",
          .make = [](const LawSettings& settings) {
            return std::make_unique<MonteCarloLaw>(settings);
          }};
}

}  // namespace qsmpc::controller
