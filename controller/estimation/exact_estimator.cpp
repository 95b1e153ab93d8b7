// The observation is the state.
#include "controller/estimation/estimator.hpp"

namespace qsmpc::controller {
namespace {

class ExactEstimator final : public Estimator {
 public:
  using Estimator::Estimator;

  [[nodiscard]] Gaussian correct(const Gaussian& /*prior*/,
                                 const Eigen::VectorXd& observation) const override {
    return {.mean = observation,
            .covariance = Eigen::MatrixXd::Zero(observation.size(), observation.size())};
  }
};

}  // namespace

EstimatorEntry exact_estimator() {
  return {.name = "exact",
          .summary = "the observation is the state; for drives without measurement noise",
          .needs_exact_sensor = true,
          .make = [](const EstimatorSettings& settings) -> std::unique_ptr<Estimator> {
            return std::make_unique<ExactEstimator>(settings);
          }};
}

}  // namespace qsmpc::controller
