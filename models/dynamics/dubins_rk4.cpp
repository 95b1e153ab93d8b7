#include "models/dynamics/dubins_rk4.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "models/dynamics/dubins.hpp"
#include "models/dynamics/dubins_rk4_batch.hpp"
#include "models/dynamics/parameter_checks.hpp"
#include "models/dynamics/spectral_norm.hpp"
#include "models/dynamics/templated_dynamics.hpp"

namespace qsmpc::models {
namespace {

constexpr const char* kDubinsRk4Name = "dubins_rk4";
constexpr const char* kDubinsRk4Summary =
    "Dubins car by the Runge-Kutta method: x, y, heading; steered by its yaw rate, held constant "
    "over a period";

/// Batches use hand-written loops.
class DubinsRk4Dynamics final : public TemplatedDynamics<DubinsRk4> {
 public:
  using TemplatedDynamics::TemplatedDynamics;

  void step(const BatchView& states, const BatchView& inputs, BatchOut next) const override {
    step_dubins_rk4(model(), states, inputs, next);
  }

  void pullback(const BatchView& states, const BatchView& inputs, const BatchView& next_adjoint,
                BatchOut state_adjoint, BatchOut input_adjoint) const override {
    pullback_dubins_rk4(model(), states, inputs, next_adjoint, state_adjoint, input_adjoint);
  }
};

}  // namespace

// Names, bounds and drawing are those of the Dubins car, independent of the discretisation.
SystemDescription DubinsRk4::description() const {
  SystemDescription description = Dubins{.speed = speed, .time_step = time_step}.description();
  description.name = kDubinsRk4Name;
  description.summary = kDubinsRk4Summary;
  return description;
}

// Where the clamp is differentiable, the closed loop's Jacobian is, with a = vT, K = [k_xyᵀ, k_φ]
// and the clamp's slope s ∈ {0, 1},
//
//     J = [ I₂ + s g k_xyᵀ   h + s g k_φ ]      h = (a/6) (e'₀ + 4 e'₁ + e'₂),
//         [ s T k_xyᵀ        1 + s T k_φ ],     g = (aT/6) (2 e'₁ + e'₂),
//
// where e'ᵢ = (−sin, cos) of the headings at the period's beginning, middle and end are unit
// vectors. Therefore |g| ≤ aT/2, and since
//
//     h + s g k_φ = (a/6) (e'₀ + (4 + 2 s T k_φ) e'₁ + (1 + s T k_φ) e'₂)
//
// is no longer than (a/6) (1 + |4 + 2 s T k_φ| + |1 + s T k_φ|): for s = 0 that is a. The norm of
// a block matrix is at most that of the matrix of its blocks' norms, and the norm of a
// non-negative matrix grows with its entries, so that the larger of those at s = 0 and s = 1 is
// taken in every block. Open loop (K = 0) this is the norm of [[1, a], [0, 1]], attained at u = 0.
// The closed loop is piecewise differentiable, so its Lipschitz constant is the largest of these
// norms.
double DubinsRk4::lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const {
  if (gain.rows() != kInputDim || gain.cols() != kStateDim) {
    throw std::invalid_argument("dubins_rk4: the feedback gain must be 1 x 3");
  }
  const double reach = speed * time_step;
  const double sideways = time_step * gain.leftCols<2>().norm();
  const double turn = time_step * gain(0, kHeading);
  const double shifting = 1.0 + 0.5 * reach * sideways;
  const double carrying =
      std::max(reach, reach / 6.0 * (1.0 + std::abs(4.0 + 2.0 * turn) + std::abs(1.0 + turn)));
  const double turning = std::max(1.0, std::abs(1.0 + turn));
  return spectral_norm(shifting, carrying, sideways, turning);
}

std::unique_ptr<const Dynamics> make_dubins_rk4(const ParameterMap& parameters, double time_step) {
  const double speed = parameters.at("speed");
  if (!(std::isfinite(speed) && speed >= 0.0)) {
    throw std::invalid_argument("dubins_rk4: speed must be a finite number of at least 0 m/s");
  }
  check_time_step(kDubinsRk4Name, time_step);
  return std::make_unique<DubinsRk4Dynamics>(DubinsRk4{.speed = speed, .time_step = time_step});
}

SystemEntry dubins_rk4_entry() {
  SystemEntry entry = dubins_entry();
  entry.name = kDubinsRk4Name;
  entry.summary = kDubinsRk4Summary;
  return entry;
}

}  // namespace qsmpc::models
