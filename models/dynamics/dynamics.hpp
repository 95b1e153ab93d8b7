// A controlled discrete-time system x⁺ = f(x, u), evaluated on whole batches of states.
//
// The planner, the propagators and the certificates know systems only through this interface;
// process noise is additive and is the caller's concern: x⁺ = f(x, u) + w.
//
//   auto car = qsmpc::models::make_dynamics("dubins", {{"speed", 1.5}}, /*time_step=*/0.1);
//   StateBatch next(3, n);
//   car->step(states, inputs, next);
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#pragma GCC visibility push(default)

namespace qsmpc::models {

/// A batch of vectors, one coordinate per row and one particle per column, so that each coordinate
/// is contiguous in memory over all particles.
using StateBatch = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// One coordinate of a state or of an input.
struct Coordinate {
  std::string name;       ///< as users write it in scenario files, e.g. "x"
  std::string unit;       ///< SI symbol, e.g. "m", "rad", "rad/s"
  bool is_angle = false;  ///< whether values 2π apart are equivalent
};

/// The names of a system's states and inputs, its default input bounds, and which two states are
/// its position in the plane.
struct SystemDescription {
  std::string name;
  std::string summary;  ///< one line for `qsmpc list systems`
  std::vector<Coordinate> states;
  std::vector<Coordinate> inputs;
  Eigen::VectorXd input_lower;  ///< input_dim
  Eigen::VectorXd input_upper;  ///< input_dim
  /// Indices of the states that are drawn as x, y and heading; -1 if the system has none.
  int position_x = -1;
  int position_y = -1;
  int heading = -1;

  /// Index of the state called `name`, or -1.
  [[nodiscard]] int state_index(std::string_view name) const;
};

/// The structure of a system whose position is driven by its heading only:
///     (x, y)⁺ = (x, y) + reach (cos φ, sin φ),  φ⁺ = φ + input_gain · u[input].
/// Certificates use it: the position is then an explicit function of the headings.
struct UnicycleStructure {
  int x = 0;
  int y = 1;
  int heading = 2;
  int input = 0;
  double reach = 0.0;       ///< m per period
  double input_gain = 0.0;  ///< rad per unit of the input and period
};

/// Enclosures of the derivatives of f over a box of states and inputs, z = (x, u). An entry is
/// infinite if no finite enclosure is known, never NaN.
struct DerivativeBounds {
  Eigen::MatrixXd jacobian_lower;  ///< state_dim x (state_dim + input_dim): ∂f_i/∂z_a
  Eigen::MatrixXd jacobian_upper;
  /// state_dim symmetric matrices (state_dim + input_dim)²: ∂²f_i/∂z_a∂z_b.
  std::vector<Eigen::MatrixXd> hessian_lower;
  std::vector<Eigen::MatrixXd> hessian_upper;
};

/// Infinite bounds for f with these dimensions: nothing is known.
[[nodiscard]] DerivativeBounds unknown_derivative_bounds(int state_dim, int input_dim);

/// Throws std::invalid_argument unless lower ≤ upper is a non-empty box of (x, u) of `system`.
void check_box(const SystemDescription& system, const Eigen::Ref<const Eigen::VectorXd>& lower,
               const Eigen::Ref<const Eigen::VectorXd>& upper);

/// x⁺ = f(x, u) over one control period. Implementations hold constants only: every function is
/// const, thread-safe and allocation-free, except for results returned by value.
class Dynamics {
 public:
  using BatchView = Eigen::Ref<const StateBatch>;
  using BatchOut = Eigen::Ref<StateBatch>;

  virtual ~Dynamics() = default;

  [[nodiscard]] virtual const SystemDescription& description() const = 0;
  [[nodiscard]] int state_dim() const { return static_cast<int>(description().states.size()); }
  [[nodiscard]] int input_dim() const { return static_cast<int>(description().inputs.size()); }

  /// next = f(states, inputs), column by column.
  /// states, next: state_dim x n; inputs: input_dim x n. `next` must not alias `states`.
  virtual void step(const BatchView& states, const BatchView& inputs, BatchOut next) const = 0;

  /// Reverse mode of `step`: state_adjoint = (∂f/∂x)ᵀ next_adjoint and
  /// input_adjoint = (∂f/∂u)ᵀ next_adjoint, column by column; both are overwritten.
  virtual void pullback(const BatchView& states, const BatchView& inputs,
                        const BatchView& next_adjoint, BatchOut state_adjoint,
                        BatchOut input_adjoint) const = 0;

  /// ∂f/∂x (state_dim x state_dim) and ∂f/∂u (state_dim x input_dim) at one point.
  virtual void jacobians(const Eigen::Ref<const Eigen::VectorXd>& state,
                         const Eigen::Ref<const Eigen::VectorXd>& input,
                         Eigen::Ref<Eigen::MatrixXd> state_jacobian,
                         Eigen::Ref<Eigen::MatrixXd> input_jacobian) const = 0;

  /// A rigorous upper bound of the Lipschitz constant, in the Euclidean norm, of
  /// x ↦ f(x, sat(v + K (x − x̄))) over all x, v and x̄, where `sat` clamps to any box.
  /// gain: K, input_dim x state_dim; zero for an open-loop policy. Infinity if no global bound is
  /// known, so that a certificate built on it is trivial instead of wrong.
  [[nodiscard]] virtual double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const = 0;

  /// Enclosures of f's first and second derivatives over the box lower ≤ (x, u) ≤ upper, rounding
  /// included. lower, upper: state_dim + input_dim, the states first; infinite where unrestricted,
  /// which costs nothing in coordinates in which f is affine with constant coefficients. For a box
  /// of a single point these are the derivatives there, up to rounding. Throws
  /// std::invalid_argument on another size or unless lower ≤ upper. The default returns
  /// unknown_derivative_bounds.
  [[nodiscard]] virtual DerivativeBounds derivative_bounds(
      const Eigen::Ref<const Eigen::VectorXd>& lower,
      const Eigen::Ref<const Eigen::VectorXd>& upper) const;

  /// The unicycle structure, if this system is exactly a unicycle with three states and one input.
  [[nodiscard]] virtual std::optional<UnicycleStructure> unicycle() const { return std::nullopt; }
};

/// A system's numeric constants by name, e.g. {"speed", 1.5}.
using ParameterMap = std::map<std::string, double, std::less<>>;

/// What `qsmpc list systems` and the scenario loader need to know about a system before it is
/// built.
struct SystemEntry {
  std::string name;
  std::string summary;
  ParameterMap defaults;  ///< every parameter that may be given, with its default
  /// The SI symbol of each of them, e.g. "m/s".
  std::map<std::string, std::string, std::less<>> units{};
};

/// The table of systems.
[[nodiscard]] const std::vector<SystemEntry>& systems();

/// Builds the system called `name` for the control period `time_step` (s, > 0). Parameters not
/// given take their default. Throws std::invalid_argument on an unknown system or parameter, naming
/// the known ones, or on a value out of its range.
[[nodiscard]] std::unique_ptr<const Dynamics> make_dynamics(std::string_view name,
                                                            const ParameterMap& parameters,
                                                            double time_step);

}  // namespace qsmpc::models

#pragma GCC visibility pop
