#include "models/dynamics/equations/tape.hpp"

#include <bit>
#include <cmath>
#include <stdexcept>

namespace qsmpc::models {
namespace {

using Operation = Tape::Operation;
using Id = Tape::Id;

constexpr int kMostFactors = 64;
constexpr Id kNone = -1;
// Limits above all the steps of the integrators.
constexpr std::size_t kMostNodes = 200000;

bool is_commutative(Operation operation) {
  return operation == Operation::kAdd || operation == Operation::kMultiply;
}

}  // namespace

double evaluate(Operation operation, double a, double b) {
  switch (operation) {
    case Operation::kArgument:
    case Operation::kConstant:
      break;
    case Operation::kNegate:
      return -a;
    case Operation::kAdd:
      return a + b;
    case Operation::kSubtract:
      return a - b;
    case Operation::kMultiply:
      return a * b;
    case Operation::kDivide:
      return a / b;
    case Operation::kSquare:
      return a * a;
    case Operation::kSqrt:
      return std::sqrt(a);
    case Operation::kSin:
      return std::sin(a);
    case Operation::kCos:
      return std::cos(a);
    case Operation::kTan:
      return std::tan(a);
    case Operation::kAsin:
      return std::asin(a);
    case Operation::kAcos:
      return std::acos(a);
    case Operation::kAtan:
      return std::atan(a);
    case Operation::kExp:
      return std::exp(a);
    case Operation::kLog:
      return std::log(a);
    case Operation::kSinh:
      return std::sinh(a);
    case Operation::kCosh:
      return std::cosh(a);
    case Operation::kTanh:
      return std::tanh(a);
    case Operation::kAbs:
      return std::abs(a);
    case Operation::kSign:
      return a > 0.0 ? 1.0 : a < 0.0 ? -1.0 : a;
    case Operation::kLessEqual:
      return a <= b ? 1.0 : 0.0;
    case Operation::kMin:
      return std::isnan(b) || b < a ? b : a;
    case Operation::kMax:
      return std::isnan(b) || b > a ? b : a;
    case Operation::kAtan2:
      return std::atan2(a, b);
    case Operation::kPower:
      return std::pow(a, b);
  }
  throw std::logic_error("tape: no operation");
}

Tape::Tape(int arguments) : arguments_(arguments) {
  for (int i = 0; i < arguments; ++i) {
    nodes_.push_back({.operation = Operation::kArgument, .a = i});
  }
}

Id Tape::put(Node node) {
  if (is_commutative(node.operation) && node.a > node.b) std::swap(node.a, node.b);
  const auto [place, is_new] = known_.try_emplace(
      {node.operation, node.a, node.b, std::bit_cast<std::uint64_t>(node.constant)},
      static_cast<Id>(nodes_.size()));
  if (is_new) {
    if (nodes_.size() == kMostNodes) throw std::length_error("the equations are too long");
    nodes_.push_back(node);
  }
  return place->second;
}

bool Tape::is(Id id, double value) const { return is_constant(id) && node(id).constant == value; }

Id Tape::constant(double value) {
  return put({.operation = Operation::kConstant, .constant = value});
}

Id Tape::unary(Operation operation, Id a) {
  if (is_constant(a)) return constant(evaluate(operation, node(a).constant, 0.0));
  return put({.operation = operation, .a = a});
}

Id Tape::binary(Operation operation, Id a, Id b) {
  if (is_constant(a) && is_constant(b)) {
    return constant(evaluate(operation, node(a).constant, node(b).constant));
  }
  return put({.operation = operation, .a = a, .b = b});
}

Id Tape::negate(Id a) {
  if (node(a).operation == Operation::kNegate) return node(a).a;
  return unary(Operation::kNegate, a);
}

Id Tape::add(Id a, Id b) {
  if (is(a, 0.0)) return b;
  if (is(b, 0.0)) return a;
  if (node(b).operation == Operation::kNegate) return subtract(a, node(b).a);
  if (node(a).operation == Operation::kNegate) return subtract(b, node(a).a);
  return binary(Operation::kAdd, a, b);
}

Id Tape::subtract(Id a, Id b) {
  if (is(b, 0.0)) return a;
  if (is(a, 0.0)) return negate(b);
  if (node(b).operation == Operation::kNegate) return add(a, node(b).a);
  return binary(Operation::kSubtract, a, b);
}

Id Tape::multiply(Id a, Id b) {
  if (is(a, 0.0) || is(b, 0.0)) return constant(0.0);
  if (is(a, 1.0)) return b;
  if (is(b, 1.0)) return a;
  if (is(a, -1.0)) return negate(b);
  if (is(b, -1.0)) return negate(a);
  if (a == b) return unary(Operation::kSquare, a);
  return binary(Operation::kMultiply, a, b);
}

Id Tape::divide(Id a, Id b) {
  if (is(b, 1.0)) return a;
  if (is(a, 0.0) && !is(b, 0.0)) return a;
  return binary(Operation::kDivide, a, b);
}

Id Tape::whole_power(Id a, int exponent) {
  if (exponent == 1) return a;
  const Id half = unary(Operation::kSquare, whole_power(a, exponent / 2));
  return exponent % 2 == 0 ? half : multiply(a, half);
}

Id Tape::power(Id a, Id b) {
  if (!is_constant(b)) return binary(Operation::kPower, a, b);
  const double exponent = node(b).constant;
  if (exponent == 0.0) return constant(1.0);
  if (exponent == 0.5) return unary(Operation::kSqrt, a);
  if (exponent != std::floor(exponent) || std::abs(exponent) > kMostFactors) {
    return binary(Operation::kPower, a, b);
  }
  const Id product = whole_power(a, static_cast<int>(std::abs(exponent)));
  return exponent > 0.0 ? product : divide(constant(1.0), product);
}

namespace {

/// The reverse sweep, from the last operation of a tape to the first, as operations of another
/// tape.
class ReverseSweep {
 public:
  explicit ReverseSweep(const Tape& forward)
      : forward_(forward),
        tape_(forward.argument_count() + static_cast<int>(forward.outputs.size())),
        copies_(forward.nodes().size(), kNone),
        adjoints_(forward.nodes().size(), kNone) {}

  Tape sweep() {
    copy_forward();
    for (std::size_t i = 0; i < forward_.outputs.size(); ++i) {
      const Id adjoint = tape_.argument(forward_.argument_count() + static_cast<int>(i));
      give(forward_.outputs[i], adjoint);
    }
    for (Id id = static_cast<Id>(forward_.nodes().size()) - 1; id >= 0; --id) {
      if (adjoints_[static_cast<std::size_t>(id)] != kNone) pass_on(id);
    }
    for (int i = 0; i < forward_.argument_count(); ++i) {
      const Id adjoint = adjoints_[static_cast<std::size_t>(i)];
      tape_.outputs.push_back(adjoint == kNone ? tape_.constant(0.0) : adjoint);
    }
    return std::move(tape_);
  }

 private:
  void copy_forward() {
    for (std::size_t i = 0; i < copies_.size(); ++i) copies_[i] = copy_of(forward_.nodes()[i]);
  }

  Id copy_of(const Tape::Node& node) {
    switch (node.operation) {
      case Operation::kArgument:
        return tape_.argument(node.a);
      case Operation::kConstant:
        return tape_.constant(node.constant);
      case Operation::kAdd:
        return tape_.add(copy(node.a), copy(node.b));
      case Operation::kSubtract:
        return tape_.subtract(copy(node.a), copy(node.b));
      case Operation::kMultiply:
        return tape_.multiply(copy(node.a), copy(node.b));
      case Operation::kDivide:
        return tape_.divide(copy(node.a), copy(node.b));
      case Operation::kLessEqual:
      case Operation::kMin:
      case Operation::kMax:
      case Operation::kAtan2:
      case Operation::kPower:
        return tape_.binary(node.operation, copy(node.a), copy(node.b));
      default:
        return tape_.unary(node.operation, copy(node.a));
    }
  }

  [[nodiscard]] Id copy(Id id) const { return copies_[static_cast<std::size_t>(id)]; }

  void give(Id id, Id adjoint) {
    if (forward_.is_constant(id)) return;
    Id& sum = adjoints_[static_cast<std::size_t>(id)];
    sum = sum == kNone ? adjoint : tape_.add(sum, adjoint);
  }
  /// adjoint · by.
  void give(Id id, Id adjoint, Id by) { give(id, tape_.multiply(adjoint, by)); }

  /// Propagates the adjoint of `id` to those of its operands.
  void pass_on(Id id) {
    const Tape::Node& node = forward_.node(id);
    const Id adjoint = adjoints_[static_cast<std::size_t>(id)];
    switch (node.operation) {
      case Operation::kArgument:
      case Operation::kConstant:
      case Operation::kSign:
      case Operation::kLessEqual:
        return;
      case Operation::kAdd:
        give(node.a, adjoint);
        return give(node.b, adjoint);
      case Operation::kSubtract:
        give(node.a, adjoint);
        return give(node.b, tape_.negate(adjoint));
      case Operation::kMultiply:
        give(node.a, adjoint, copy(node.b));
        return give(node.b, adjoint, copy(node.a));
      case Operation::kDivide: {
        const Id share = tape_.divide(adjoint, copy(node.b));
        give(node.a, share);
        return give(node.b, tape_.negate(tape_.multiply(share, copy(id))));
      }
      case Operation::kMin:
      case Operation::kMax:
      case Operation::kAtan2:
      case Operation::kPower:
        return pass_on_binary(node, id, adjoint);
      default:
        give(node.a, through(node.operation, copy(node.a), copy(id), adjoint));
    }
  }

  void pass_on_binary(const Tape::Node& node, Id id, Id adjoint) {
    const Id a = copy(node.a);
    const Id b = copy(node.b);
    if (node.operation == Operation::kAtan2) {
      const Id share = tape_.divide(adjoint, tape_.add(tape_.multiply(a, a), tape_.multiply(b, b)));
      give(node.a, share, b);
      return give(node.b, tape_.negate(tape_.multiply(share, a)));
    }
    if (node.operation == Operation::kPower) {
      const Id lower = tape_.power(a, tape_.subtract(b, tape_.constant(1.0)));
      give(node.a, adjoint, tape_.multiply(b, lower));
      if (tape_.is_constant(b)) return;
      return give(node.b, adjoint, tape_.multiply(copy(id), tape_.unary(Operation::kLog, a)));
    }
    // One of the two receives the whole adjoint.
    const Id first = tape_.multiply(adjoint, tape_.binary(Operation::kLessEqual, a, b));
    const Id second = tape_.subtract(adjoint, first);
    const bool is_min = node.operation == Operation::kMin;
    give(node.a, is_min ? first : second);
    give(node.b, is_min ? second : first);
  }

  /// adjoint · h'(a) for value = h(a).
  Id through(Operation operation, Id a, Id value, Id adjoint) {
    const Id one = tape_.constant(1.0);
    const auto times = [&](Id by) { return tape_.multiply(adjoint, by); };
    const auto over = [&](Id by) { return tape_.divide(adjoint, by); };
    const auto squared = [&](Id of) { return tape_.multiply(of, of); };
    const auto below_circle = [&] {
      return tape_.unary(Operation::kSqrt, tape_.subtract(one, squared(a)));
    };
    switch (operation) {
      case Operation::kNegate:
        return tape_.negate(adjoint);
      case Operation::kSquare:
        return times(tape_.multiply(tape_.constant(2.0), a));
      case Operation::kSqrt:
        return tape_.divide(times(tape_.constant(0.5)), value);
      case Operation::kSin:
        return times(tape_.unary(Operation::kCos, a));
      case Operation::kCos:
        return tape_.negate(times(tape_.unary(Operation::kSin, a)));
      case Operation::kTan:
        return times(tape_.add(one, squared(value)));
      case Operation::kAsin:
        return over(below_circle());
      case Operation::kAcos:
        return tape_.negate(over(below_circle()));
      case Operation::kAtan:
        return over(tape_.add(one, squared(a)));
      case Operation::kExp:
        return times(value);
      case Operation::kLog:
        return over(a);
      case Operation::kSinh:
        return times(tape_.unary(Operation::kCosh, a));
      case Operation::kCosh:
        return times(tape_.unary(Operation::kSinh, a));
      case Operation::kTanh:
        return times(tape_.subtract(one, squared(value)));
      case Operation::kAbs:
        return times(tape_.unary(Operation::kSign, a));
      default:
        throw std::logic_error("tape: no derivative");
    }
  }

  const Tape& forward_;
  Tape tape_;
  std::vector<Id> copies_;    // by the forward tape's values
  std::vector<Id> adjoints_;  // kNone: zero
};

}  // namespace

Tape reverse(const Tape& tape) { return ReverseSweep(tape).sweep(); }

}  // namespace qsmpc::models
