// Methods from the literature, and this program's own, that propagate the law of a state along a
// horizon. `qsmpc predict --methods` compares their laws with many simulated paths.
//
//   const LawProblem problem{.dynamics = *car, .belief = belief, …};
//   for (const LawMethod& method : law_methods()) {
//     const std::vector<StageLaw> laws = method.make({})->propagate(problem);
//   }
//
// A new method takes one file with a class and its entry, and a line in the table in
// law_methods.cpp. docs/theory/laws.md has the equations and sources.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "controller/laws/stage_law.hpp"
#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "controller/prediction/policy.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// x_0 ~ belief, x_{k+1} = f(x_k, sat(v_k + K_k (x_k − x̄_k))) + w_k, w_k ~ N(0, Σ) independent.
/// Refers to objects that must outlive it.
struct LawProblem {
  const models::Dynamics& dynamics;
  const Gaussian& belief;
  const Eigen::MatrixXd& noise_covariance;  ///< Σ, state_dim x state_dim
  const Policy& policy;
};

class LawPropagator {
 public:
  LawPropagator() = default;
  LawPropagator(const LawPropagator&) = delete;
  LawPropagator& operator=(const LawPropagator&) = delete;
  LawPropagator(LawPropagator&&) = delete;
  LawPropagator& operator=(LawPropagator&&) = delete;
  virtual ~LawPropagator() = default;

  /// The laws of the states at stages 0 … horizon. From the first stage with a non-finite law
  /// onwards, all are `lost_law`. The same call gives the same laws. Throws std::invalid_argument
  /// if belief, noise or policy do not match the dynamics' dimensions, on invalid covariances, and
  /// if the method's settings are invalid in this dimension.
  [[nodiscard]] std::vector<StageLaw> propagate(const LawProblem& problem);

 private:
  /// The law at stage 0.
  [[nodiscard]] virtual StageLaw begin(const LawProblem& problem) = 0;
  /// The law at stage + 1, from `law`, which is finite, at `stage`.
  [[nodiscard]] virtual StageLaw advance(const LawProblem& problem, Eigen::Index stage,
                                         const StageLaw& law) = 0;
};

/// Sigma points at the mean and α √(d + κ) along the columns of the covariance's root, d the
/// dimension of the state; the centre's weight in the covariance is raised by 1 − α² + β. As the
/// noise is additive, sigma points of state and noise (the augmented form) with some κ give the
/// same as these with κ + d. The common choice α = 1e-3 amplifies a clamp at the mean, where a
/// plan's inputs often are, a thousandfold.
struct UnscentedSettings {
  double alpha = 0.5;  ///< > 0
  double beta = 2.0;   ///< 2 suits Gaussians
  double kappa = 0.0;  ///< > −d
};

struct LawSettings {
  // monte_carlo
  int samples = 1000;
  std::uint64_t seed = 0;

  UnscentedSettings unscented{};  ///< of unscented and gaussian_mixture

  // polynomial_chaos
  int order = 3;          ///< total degree of the polynomials, 1 to 8
  int most_nodes = 1000;  ///< of the tensor grid; if it would have more, a sparse grid is used

  // gaussian_mixture
  int components = 27;  ///< kept after a step
  int split = 3;        ///< parts of a component that is split: 3 or 5
  /// A component is split where the map's nonlinearity along some direction, at one standard
  /// deviation, exceeds this share of the component's spread after the step (root of the
  /// covariance's trace).
  double least_bend = 1e-3;

  // quantised methods
  QuantiserKind quantiser = QuantiserKind::kProduct;  ///< of the belief
  int state_points = 100;
  int noise_points = 100;
  int compressed_points = 100;
};

/// Throws std::invalid_argument, whose message names the setting, on settings that are invalid in
/// every dimension.
void check_law_settings(const LawSettings& settings);

struct LawMethod {
  std::string name;
  std::string summary;
  std::function<std::unique_ptr<LawPropagator>(const LawSettings& settings)> make;
};

/// The table of methods: "monte_carlo", "unscented", "polynomial_chaos", "gaussian_mixture",
/// "linearised", and all of `propagators()` under their names.
[[nodiscard]] const std::vector<LawMethod>& law_methods();

/// Throws std::invalid_argument on an unknown name.
[[nodiscard]] const LawMethod& law_method(std::string_view name);

/// Throws std::invalid_argument on an unknown name, and as check_law_settings.
[[nodiscard]] std::unique_ptr<LawPropagator> make_law_propagator(std::string_view name,
                                                                 const LawSettings& settings);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
