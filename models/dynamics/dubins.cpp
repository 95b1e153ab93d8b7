#include "models/dynamics/dubins.hpp"

#include <algorithm>
#include <stdexcept>

#include "models/dynamics/dubins_batch.hpp"
#include "models/dynamics/parameter_checks.hpp"
#include "models/dynamics/spectral_norm.hpp"
#include "models/dynamics/templated_dynamics.hpp"

namespace qsmpc::models {
namespace {

constexpr double kDefaultSpeed = 1.5;         // m/s, Table B-1
constexpr double kDefaultYawRateBound = 2.0;  // rad/s, Table B-1
constexpr const char* kDubinsSummary =
    "Dubins car: x, y, heading; steered by its yaw rate (Eq. 5-1)";

/// Batches use hand-written loops.
class DubinsDynamics final : public TemplatedDynamics<Dubins> {
 public:
  using TemplatedDynamics::TemplatedDynamics;

  void step(const BatchView& states, const BatchView& inputs, BatchOut next) const override {
    step_dubins(model(), states, inputs, next);
  }

  [[nodiscard]] std::optional<UnicycleStructure> unicycle() const override {
    return UnicycleStructure{.x = Dubins::kX,
                             .y = Dubins::kY,
                             .heading = Dubins::kHeading,
                             .input = Dubins::kYawRate,
                             .reach = model().speed * model().time_step,
                             .input_gain = model().time_step};
  }

  void pullback(const BatchView& states, const BatchView& /*inputs*/, const BatchView& next_adjoint,
                BatchOut state_adjoint, BatchOut input_adjoint) const override {
    pullback_dubins(model(), states, next_adjoint, state_adjoint, input_adjoint);
  }
};

}  // namespace

SystemDescription Dubins::description() const {
  SystemDescription description;
  description.name = "dubins";
  description.summary = kDubinsSummary;
  description.states = {{"x", "m"}, {"y", "m"}, {"heading", "rad", true}};
  description.inputs = {{"yaw_rate", "rad/s"}};
  description.input_lower = Eigen::VectorXd::Constant(1, -kDefaultYawRateBound);
  description.input_upper = Eigen::VectorXd::Constant(1, kDefaultYawRateBound);
  description.position_x = kX;
  description.position_y = kY;
  description.heading = kHeading;
  return description;
}

// Where the clamp is differentiable, the closed loop's Jacobian is, with a = vT, e = (−sin φ, cos
// φ), K = [k_xyᵀ, k_φ] and the clamp's slope s ∈ {0, 1},
//
//     J = [ I₂        a e      ]
//         [ T s k_xyᵀ 1 + T s k_φ ].
//
// Open loop (K = 0) its norm does not depend on φ and is that of [[1, a], [0, 1]], which is
// a/2 + √(1 + a²/4): attained. Otherwise the norm of a block matrix is at most that of the matrix
// of its blocks' norms, and the norm of a non-negative matrix grows with its entries. The closed
// loop is piecewise differentiable, so its Lipschitz constant is the largest of these norms.
double Dubins::lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const {
  if (gain.rows() != kInputDim || gain.cols() != kStateDim) {
    throw std::invalid_argument("dubins: the feedback gain must be 1 x 3");
  }
  const double reach = speed * time_step;
  const double sideways = time_step * gain.leftCols<2>().norm();
  const double turning = std::max(1.0, std::abs(1.0 + time_step * gain(0, kHeading)));
  return spectral_norm(1.0, reach, sideways, turning);
}

std::unique_ptr<const Dynamics> make_dubins(const ParameterMap& parameters, double time_step) {
  const double speed = parameters.at("speed");
  if (!(std::isfinite(speed) && speed >= 0.0)) {
    throw std::invalid_argument("dubins: speed must be a finite number of at least 0 m/s");
  }
  check_time_step("dubins", time_step);
  return std::make_unique<DubinsDynamics>(Dubins{.speed = speed, .time_step = time_step});
}

SystemEntry dubins_entry() {
  return {.name = "dubins",
          .summary = kDubinsSummary,
          .defaults = {{"speed", kDefaultSpeed}},
          .units = {{"speed", "m/s"}}};
}

}  // namespace qsmpc::models
