// Estimators: map the belief of the state before an observation, and the observation, to the belief
// of the next state before its observation.
//
//   const std::unique_ptr<Estimator> estimator = make_estimator("exact", {.dynamics = *car, …});
//   belief = estimator->predict(estimator->correct(belief, observation), input);
//
// A new estimator takes one file with a class and its entry, and a line in the table in
// estimators.cpp.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

struct EstimatorSettings {
  const models::Dynamics& dynamics;  ///< must outlive the estimator
  Eigen::MatrixXd noise_covariance;  ///< Σ_w of a period, state_dim x state_dim
  Eigen::MatrixXd
      sensor_covariance;  ///< R, of the observation minus the state, state_dim x state_dim
};

class Estimator {
 public:
  /// Throws std::invalid_argument if a covariance does not match the dynamics' dimension.
  explicit Estimator(EstimatorSettings settings);
  Estimator(const Estimator&) = delete;
  Estimator& operator=(const Estimator&) = delete;
  Estimator(Estimator&&) = delete;
  Estimator& operator=(Estimator&&) = delete;
  virtual ~Estimator() = default;

  /// The law of the state given the observation y = `observation` (state_dim); `prior` is its law
  /// before.
  [[nodiscard]] virtual Gaussian correct(const Gaussian& prior,
                                         const Eigen::VectorXd& observation) const = 0;

  /// The law of the next state if the current one has the law `posterior` and `input` (input_dim)
  /// is applied. By default, linearises about the mean m:
  /// N(f(m, u), A P Aᵀ + Σ_w), A = ∂f/∂x at (m, u), which is exact where P = 0.
  [[nodiscard]] virtual Gaussian predict(const Gaussian& posterior,
                                         const Eigen::VectorXd& input) const;

 protected:
  [[nodiscard]] const EstimatorSettings& settings() const { return settings_; }

 private:
  EstimatorSettings settings_;
};

struct EstimatorEntry {
  std::string name;
  std::string summary;
  bool needs_exact_sensor = false;  ///< whether it is wrong unless R is zero
  std::unique_ptr<Estimator> (*make)(const EstimatorSettings& settings) = nullptr;
};

/// The table of estimators.
[[nodiscard]] const std::vector<EstimatorEntry>& estimators();

/// Throws std::invalid_argument on an unknown name.
[[nodiscard]] const EstimatorEntry& estimator_entry(std::string_view name);

/// Throws std::invalid_argument on an unknown name, and as the estimator.
[[nodiscard]] std::unique_ptr<Estimator> make_estimator(std::string_view name,
                                                        const EstimatorSettings& settings);

}  // namespace qsmpc::controller
