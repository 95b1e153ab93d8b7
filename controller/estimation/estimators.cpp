#include <stdexcept>
#include <utility>

#include "controller/estimation/estimator.hpp"
#include "controller/named_entry.hpp"

namespace qsmpc::controller {

// Each is defined in the file of its name.
EstimatorEntry exact_estimator();
EstimatorEntry last_measurement_estimator();

const std::vector<EstimatorEntry>& estimators() {
  static const std::vector<EstimatorEntry> table = {
      exact_estimator(),
      last_measurement_estimator(),
  };
  return table;
}

const EstimatorEntry& estimator_entry(std::string_view name) {
  return named_entry(estimators(), name, "estimator");
}

std::unique_ptr<Estimator> make_estimator(std::string_view name,
                                          const EstimatorSettings& settings) {
  return estimator_entry(name).make(settings);
}

Estimator::Estimator(EstimatorSettings settings) : settings_(std::move(settings)) {
  const Eigen::Index dim = settings_.dynamics.state_dim();
  for (const Eigen::MatrixXd* const covariance :
       {&settings_.noise_covariance, &settings_.sensor_covariance}) {
    if (covariance->rows() == dim && covariance->cols() == dim) continue;
    throw std::invalid_argument("estimator: covariances must be matrices of states x states");
  }
}

Gaussian Estimator::predict(const Gaussian& posterior, const Eigen::VectorXd& input) const {
  const models::Dynamics& dynamics = settings_.dynamics;
  const models::StateBatch state = posterior.mean;
  models::StateBatch next(state.rows(), 1);
  dynamics.step(state, models::StateBatch(input), next);
  Gaussian belief{.mean = next.col(0), .covariance = settings_.noise_covariance};
  if (posterior.covariance.isZero(0.0)) return belief;
  Eigen::MatrixXd by_state(state.rows(), state.rows());
  Eigen::MatrixXd by_input(state.rows(), input.size());
  dynamics.jacobians(posterior.mean, input, by_state, by_input);
  const Eigen::MatrixXd carried = by_state * posterior.covariance * by_state.transpose();
  belief.covariance += 0.5 * (carried + carried.transpose());  // symmetric to the last bit
  return belief;
}

}  // namespace qsmpc::controller
