#include "models/dynamics/cart_pole.hpp"

#include <limits>
#include <stdexcept>

#include "models/dynamics/parameter_checks.hpp"
#include "models/dynamics/templated_dynamics.hpp"

namespace qsmpc::models {
namespace {

constexpr const char* kCartPoleName = "cart_pole";
constexpr const char* kCartPoleSummary =
    "Pole on a cart: position, velocity, pole angle (0 is upright), angular velocity; pushed by a "
    "force (Eq. D-3 to D-5)";
// N. The force of the benchmark that also gives the default masses and length.
constexpr double kDefaultForceBound = 10.0;

}  // namespace

SystemDescription CartPole::description() const {
  SystemDescription description;
  description.name = kCartPoleName;
  description.summary = kCartPoleSummary;
  description.states = {{"position", "m"},
                        {"velocity", "m/s"},
                        {"pole_angle", "rad", true},
                        {"angular_velocity", "rad/s"}};
  description.inputs = {{"force", "N"}};
  description.input_lower = Eigen::VectorXd::Constant(1, -kDefaultForceBound);
  description.input_upper = Eigen::VectorXd::Constant(1, kDefaultForceBound);
  return description;
}

// ∂θ̈/∂θ and ∂θ̈/∂θ̇ grow with the angular velocity, which is unbounded: no global constant exists
// for any gain. Over a box there is one, see local_lipschitz.hpp.
double CartPole::lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const {
  if (gain.rows() != kInputDim || gain.cols() != kStateDim) {
    throw std::invalid_argument("cart_pole: the feedback gain must be 1 x 4");
  }
  return std::numeric_limits<double>::infinity();
}

std::unique_ptr<const Dynamics> make_cart_pole(const ParameterMap& parameters, double time_step) {
  check_time_step(kCartPoleName, time_step);
  return std::make_unique<TemplatedDynamics<CartPole>>(CartPole{
      .cart_mass = positive_parameter(kCartPoleName, parameters, "cart_mass"),
      .pole_mass = positive_parameter(kCartPoleName, parameters, "pole_mass"),
      .pole_half_length = positive_parameter(kCartPoleName, parameters, "pole_half_length"),
      .gravity = positive_parameter(kCartPoleName, parameters, "gravity"),
      .cart_damping = non_negative_parameter(kCartPoleName, parameters, "cart_damping"),
      .pole_damping = non_negative_parameter(kCartPoleName, parameters, "pole_damping"),
      .time_step = time_step});
}

// The thesis gives no constants for this system, and no damping. These are from Barto, Sutton and
// Anderson, "Neuronlike adaptive elements that can solve difficult learning control problems",
// 1983.
SystemEntry cart_pole_entry() {
  return {.name = kCartPoleName,
          .summary = kCartPoleSummary,
          .defaults = {{"cart_mass", 1.0},
                       {"pole_mass", 0.1},
                       {"pole_half_length", 0.5},
                       {"gravity", 9.8},
                       {"cart_damping", 0.0},
                       {"pole_damping", 0.0}},
          .units = {{"cart_mass", "kg"},
                    {"pole_mass", "kg"},
                    {"pole_half_length", "m"},
                    {"gravity", "m/s^2"},
                    {"cart_damping", "N s/m"},
                    {"pole_damping", "N m s/rad"}}};
}

}  // namespace qsmpc::models
