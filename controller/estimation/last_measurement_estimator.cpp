// The state is N(y, R): what the last observation y alone says of it, under a flat prior. What was
// seen before is left out, which a filter would weigh in.
#include "controller/estimation/estimator.hpp"

namespace qsmpc::controller {
namespace {

class LastMeasurementEstimator final : public Estimator {
 public:
  using Estimator::Estimator;

  [[nodiscard]] Gaussian correct(const Gaussian& /*prior*/,
                                 const Eigen::VectorXd& observation) const override {
    return {.mean = observation, .covariance = settings().sensor_covariance};
  }
};

}  // namespace

EstimatorEntry last_measurement_estimator() {
  return {.name = "last_measurement",
          .summary = "the last observation alone, with the covariance of its noise",
          .make = [](const EstimatorSettings& settings) -> std::unique_ptr<Estimator> {
            return std::make_unique<LastMeasurementEstimator>(settings);
          }};
}

}  // namespace qsmpc::controller
