#include "models/dynamics/equations/tape_jets.hpp"

#include <stdexcept>
#include <vector>

#include "models/dynamics/equations/tape_dynamics.hpp"
#include "models/dynamics/second_order_jet.hpp"

namespace qsmpc::models {
namespace {

using Operation = Tape::Operation;

template <class Jet>
Jet unary_jet(Operation operation, const Jet& a) {
  switch (operation) {
    case Operation::kNegate:
      return -a;
    case Operation::kSquare:
      return square(a);
    case Operation::kSqrt:
      return sqrt(a);
    case Operation::kSin:
      return sin(a);
    case Operation::kCos:
      return cos(a);
    case Operation::kTan:
      return tan(a);
    case Operation::kAsin:
      return asin(a);
    case Operation::kAcos:
      return acos(a);
    case Operation::kAtan:
      return atan(a);
    case Operation::kExp:
      return exp(a);
    case Operation::kLog:
      return log(a);
    case Operation::kSinh:
      return sinh(a);
    case Operation::kCosh:
      return cosh(a);
    case Operation::kTanh:
      return tanh(a);
    case Operation::kAbs:
      return abs(a);
    default:
      throw std::logic_error("tape: no enclosure of an operation");
  }
}

template <class Jet>
class JetSweep {
 public:
  JetSweep(const Tape& tape, const Eigen::Ref<const Eigen::VectorXd>& lower,
           const Eigen::Ref<const Eigen::VectorXd>& upper)
      : tape_(tape), values_(tape.nodes().size()) {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const Tape::Node& node = tape.nodes()[i];
      if (node.operation == Operation::kArgument) {
        values_[i] = Jet::variable(Interval(lower[node.a], upper[node.a]), node.a);
      } else {
        values_[i] = value_of(node);
      }
    }
  }

  [[nodiscard]] const Jet& at(Tape::Id id) const { return values_[static_cast<std::size_t>(id)]; }

 private:
  Jet value_of(const Tape::Node& node) const {
    const Jet& a = at(node.a);
    const Jet& b = at(node.b);
    switch (node.operation) {
      case Operation::kConstant:
        return constant(node.constant);
      case Operation::kAdd:
        return a + b;
      case Operation::kSubtract:
        return a - b;
      case Operation::kMultiply:
        if (is_finite_constant(node.a)) return tape_.node(node.a).constant * b;
        return is_finite_constant(node.b) ? tape_.node(node.b).constant * a : a * b;
      case Operation::kDivide:
        return is_finite_constant(node.b) ? a / tape_.node(node.b).constant : a / b;
      case Operation::kMin:
        return min(a, b);
      case Operation::kMax:
        return max(a, b);
      case Operation::kAtan2:
        return atan2(a, b);
      case Operation::kPower:
        return tape_.is_constant(node.b) ? pow(a, tape_.node(node.b).constant) : pow(a, b);
      default:
        return unary_jet(node.operation, a);
    }
  }

  [[nodiscard]] bool is_finite_constant(Tape::Id id) const {
    return tape_.is_constant(id) && std::isfinite(tape_.node(id).constant);
  }

  /// Nothing is known about a NaN constant, such as 0/0.
  static Jet constant(double value) {
    if (std::isfinite(value)) return Jet(value);
    return inverse(Jet(0.0));
  }

  const Tape& tape_;
  std::vector<Jet> values_;
};

template <int kVariables>
DerivativeBounds bounds_with(const Tape& tape, const Eigen::Ref<const Eigen::VectorXd>& lower,
                             const Eigen::Ref<const Eigen::VectorXd>& upper) {
  const JetSweep<SecondOrderJet<kVariables>> sweep(tape, lower, upper);
  const int arguments = tape.argument_count();
  const int dim = static_cast<int>(tape.outputs.size());
  DerivativeBounds bounds{Eigen::MatrixXd(dim, arguments), Eigen::MatrixXd(dim, arguments),
                          std::vector(dim, Eigen::MatrixXd(arguments, arguments)),
                          std::vector(dim, Eigen::MatrixXd(arguments, arguments))};
  for (int i = 0; i < dim; ++i) {
    const auto& next = sweep.at(tape.outputs[static_cast<std::size_t>(i)]);
    for (int a = 0; a < arguments; ++a) {
      bounds.jacobian_lower(i, a) = next.gradient(a).lower();
      bounds.jacobian_upper(i, a) = next.gradient(a).upper();
      for (int b = 0; b < arguments; ++b) {
        bounds.hessian_lower[i](a, b) = next.hessian(a, b).lower();
        bounds.hessian_upper[i](a, b) = next.hessian(a, b).upper();
      }
    }
  }
  return bounds;
}

}  // namespace

DerivativeBounds derivative_bounds_of(const Tape& tape,
                                      const Eigen::Ref<const Eigen::VectorXd>& lower,
                                      const Eigen::Ref<const Eigen::VectorXd>& upper) {
  const int arguments = tape.argument_count();
  if (arguments <= 4) return bounds_with<4>(tape, lower, upper);
  if (arguments <= 8) return bounds_with<8>(tape, lower, upper);
  if (arguments <= 16) return bounds_with<16>(tape, lower, upper);
  return bounds_with<kMostCoordinates>(tape, lower, upper);
}

}  // namespace qsmpc::models
