#include "models/dynamics/double_integrator.hpp"

#include <algorithm>
#include <stdexcept>

#include "models/dynamics/parameter_checks.hpp"
#include "models/dynamics/templated_dynamics.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::models {
namespace {

// m/s². Table B-4 bounds only the speed (2 m/s); this acceleration reaches it within a second.
constexpr double kDefaultAccelerationBound = 2.0;
constexpr const char* kDoubleIntegratorName = "double_integrator";
constexpr const char* kDoubleIntegratorSummary =
    "Double integrator: position, velocity; driven by its acceleration (Eq. D-1, D-2)";

}  // namespace

SystemDescription DoubleIntegrator::description() const {
  SystemDescription description;
  description.name = kDoubleIntegratorName;
  description.summary = kDoubleIntegratorSummary;
  description.states = {{"position", "m"}, {"velocity", "m/s"}};
  description.inputs = {{"acceleration", "m/s^2"}};
  description.input_lower = Eigen::VectorXd::Constant(1, -kDefaultAccelerationBound);
  description.input_upper = Eigen::VectorXd::Constant(1, kDefaultAccelerationBound);
  return description;
}

// Where the clamp is differentiable the closed loop's Jacobian is A + s B K with the clamp's slope
// s ∈ {0, 1}, and the Lipschitz constant of a piecewise affine function is the largest norm of its
// pieces' matrices.
double DoubleIntegrator::lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const {
  if (gain.rows() != kInputDim || gain.cols() != kStateDim) {
    throw std::invalid_argument("double_integrator: the feedback gain must be 1 x 2");
  }
  const Eigen::Matrix2d saturated{{1.0, time_step}, {0.0, 1.0}};
  const Eigen::Vector2d by_input(0.5 * time_step * time_step, time_step);
  const Eigen::Matrix2d regulated = saturated + by_input * gain;
  return std::max(spectral_norm(saturated), spectral_norm(regulated));
}

std::unique_ptr<const Dynamics> make_double_integrator(const ParameterMap& /*parameters*/,
                                                       double time_step) {
  check_time_step(kDoubleIntegratorName, time_step);
  return std::make_unique<TemplatedDynamics<DoubleIntegrator>>(
      DoubleIntegrator{.time_step = time_step});
}

SystemEntry double_integrator_entry() {
  return {.name = kDoubleIntegratorName, .summary = kDoubleIntegratorSummary, .defaults = {}};
}

}  // namespace qsmpc::models
