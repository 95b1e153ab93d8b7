// The state is N(y, R): its law given only the last observation y, under a flat prior. Unlike a
// filter, this ignores earlier observations.
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
