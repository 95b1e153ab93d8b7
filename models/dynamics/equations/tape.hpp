// A function of several numbers as a list of elementary operations, and its reverse derivative as
// another such list. Equal operations are stored only once, and operations on constants are folded.
//
//   Tape tape(2);
//   tape.outputs = {tape.multiply(tape.argument(0), tape.sine(tape.argument(1)))};
//   const Tape gradient = reverse(tape);  // of x, y and the adjoint of the output
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

namespace qsmpc::models {

class Tape {
 public:
  enum class Operation : std::uint8_t {
    kArgument,
    kConstant,
    kNegate,
    kAdd,
    kSubtract,
    kMultiply,
    kDivide,
    kSquare,
    kSqrt,
    kSin,
    kCos,
    kTan,
    kAsin,
    kAcos,
    kAtan,
    kExp,
    kLog,
    kSinh,
    kCosh,
    kTanh,
    kAbs,
    kSign,       ///< −1, 0 or 1
    kLessEqual,  ///< 1 where a ≤ b, else 0
    kMin,
    kMax,
    kAtan2,
    kPower,
  };
  /// A value of the tape, by its number in `nodes()`.
  using Id = int;

  struct Node {
    Operation operation;
    Id a = 0;  ///< operands; for an argument, its number
    Id b = 0;
    double constant = 0.0;
  };

  /// A function of `arguments` numbers.
  explicit Tape(int arguments);

  [[nodiscard]] int argument_count() const { return arguments_; }
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  /// Every node comes after its operands.
  [[nodiscard]] const Node& node(Id id) const { return nodes_[static_cast<std::size_t>(id)]; }
  [[nodiscard]] bool is_constant(Id id) const { return node(id).operation == Operation::kConstant; }

  [[nodiscard]] Id argument(int index) const { return index; }
  [[nodiscard]] Id constant(double value);
  [[nodiscard]] Id negate(Id a);
  [[nodiscard]] Id add(Id a, Id b);
  [[nodiscard]] Id subtract(Id a, Id b);
  [[nodiscard]] Id multiply(Id a, Id b);
  [[nodiscard]] Id divide(Id a, Id b);
  /// Integer exponents up to 64 become products.
  [[nodiscard]] Id power(Id a, Id b);
  /// Any operation with one operand.
  [[nodiscard]] Id unary(Operation operation, Id a);
  /// kLessEqual, kMin, kMax or kAtan2.
  [[nodiscard]] Id binary(Operation operation, Id a, Id b);

  std::vector<Id> outputs{};

 private:
  [[nodiscard]] Id put(Node node);
  [[nodiscard]] bool is(Id id, double value) const;
  [[nodiscard]] Id whole_power(Id a, int exponent);

  int arguments_;
  std::vector<Node> nodes_;
  std::map<std::tuple<Operation, Id, Id, std::uint64_t>, Id> known_;
};

/// The result of an operation, by the standard library.
[[nodiscard]] double evaluate(Tape::Operation operation, double a, double b);

/// The function (arguments, adjoints of the outputs) ↦ adjoints of the arguments.
[[nodiscard]] Tape reverse(const Tape& tape);

}  // namespace qsmpc::models
