#include <cmath>
#include <stdexcept>

#include "controller/laws/law_makers.hpp"
#include "controller/laws/law_propagator.hpp"
#include "controller/named_entry.hpp"

namespace qsmpc::controller {

namespace {

constexpr int kHighestOrder = 8;

void require_setting(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(std::string("law settings: ") + message);
}

void check_problem(const LawProblem& problem) {
  const Eigen::Index dim = problem.dynamics.state_dim();
  check_gaussian(problem.belief);
  check_gaussian({.mean = Eigen::VectorXd::Zero(dim), .covariance = problem.noise_covariance});
  if (problem.belief.mean.size() != dim) {
    throw std::invalid_argument("law propagator: the belief must have the state's dimension");
  }
  const Policy& policy = problem.policy;
  if (policy.states.rows() != dim || policy.states.cols() < policy.horizon() ||
      policy.inputs.rows() != problem.dynamics.input_dim() ||
      static_cast<Eigen::Index>(policy.gains.size()) != policy.horizon()) {
    throw std::invalid_argument("law propagator: the policy does not fit these dynamics");
  }
}

}  // namespace

std::vector<StageLaw> LawPropagator::propagate(const LawProblem& problem) {
  check_problem(problem);
  std::vector<StageLaw> laws;
  laws.reserve(problem.policy.horizon() + 1);
  laws.push_back(begin(problem));
  for (Eigen::Index k = 0; k < problem.policy.horizon(); ++k) {
    const bool here = is_finite(laws.back());
    laws.push_back(here ? advance(problem, k, laws.back()) : lost_law(problem.belief.mean.size()));
    if (!is_finite(laws.back())) laws.back() = lost_law(problem.belief.mean.size());
  }
  return laws;
}

void check_law_settings(const LawSettings& settings) {
  require_setting(settings.samples >= 1, "samples must be at least 1");
  const UnscentedSettings& sigma = settings.unscented;
  require_setting(sigma.alpha > 0.0 && std::isfinite(sigma.alpha),
                  "unscented.alpha must be positive and finite");
  require_setting(std::isfinite(sigma.beta) && std::isfinite(sigma.kappa),
                  "unscented.beta and unscented.kappa must be finite");
  require_setting(settings.order >= 1 && settings.order <= kHighestOrder,
                  "order must be from 1 to 8");
  require_setting(settings.most_nodes >= 1, "most_nodes must be at least 1");
  require_setting(settings.components >= 1, "components must be at least 1");
  require_setting(settings.split == 3 || settings.split == 5, "split must be 3 or 5");
  require_setting(settings.least_bend >= 0.0, "least_bend must not be negative");
  require_setting(
      settings.state_points >= 1 && settings.noise_points >= 1 && settings.compressed_points >= 1,
      "state_points, noise_points and compressed_points must be at least 1");
}

const std::vector<LawMethod>& law_methods() {
  static const std::vector<LawMethod> table = [] {
    std::vector<LawMethod> all = {
        monte_carlo_law(),      unscented_law(),  polynomial_chaos_law(),
        gaussian_mixture_law(), linearised_law(),
    };
    for (LawMethod& method : quantised_laws()) all.push_back(std::move(method));
    return all;
  }();
  return table;
}

const LawMethod& law_method(std::string_view name) {
  return named_entry(law_methods(), name, "prediction method");
}

std::unique_ptr<LawPropagator> make_law_propagator(std::string_view name,
                                                   const LawSettings& settings) {
  const LawMethod& method = law_method(name);
  check_law_settings(settings);
  return method.make(settings);
}

}  // namespace qsmpc::controller
