// Parses formulas as users write them into a list of steps: "x + time_step * v * cos(heading)".
//
//   const Expression formula = parse_expression("-x^2 + 3");
//   // names: x; steps: x 2 power negate 3 add
//
// + - * / and ^ (or **) with their usual precedence: -x^2 is -(x^2), and 2^3^2 is 2^(3^2).
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace qsmpc::models {

/// An error in a formula.
class ExpressionError : public std::invalid_argument {
 public:
  /// column: of the character in the formula, from 1; 0 if the error concerns the whole formula.
  ExpressionError(std::size_t column, const std::string& found, const std::string& expected);
  /// For a name (or "the function '…'") that is not among `known`.
  ExpressionError(std::size_t column, const std::string& found, std::string unknown,
                  std::vector<std::string> known);

  [[nodiscard]] std::size_t column() const { return column_; }
  [[nodiscard]] const std::string& found() const { return found_; }
  [[nodiscard]] const std::string& expected() const { return expected_; }
  /// The unknown name and the known ones; empty for other errors.
  [[nodiscard]] const std::string& unknown() const { return unknown_; }
  [[nodiscard]] const std::vector<std::string>& known() const { return known_; }

 private:
  std::size_t column_;
  std::string found_;
  std::string expected_;
  std::string unknown_;
  std::vector<std::string> known_;
};

/// A function that a formula may call.
struct ExpressionFunction {
  const char* name;
  int arguments;
};
[[nodiscard]] const std::vector<ExpressionFunction>& expression_functions();

/// The name of π in formulas.
inline constexpr const char* kPiName = "pi";

/// A formula's steps in order of evaluation, each applied to the results of those before it.
struct Expression {
  enum class Kind { kNumber, kName, kNegate, kAdd, kSubtract, kMultiply, kDivide, kPower, kCall };
  struct Step {
    Kind kind;
    double number = 0.0;     ///< of a number
    std::string name{};      ///< of a name or a function
    std::size_t column = 0;  ///< where it begins, from 1
  };
  std::vector<Step> steps;
};

/// Throws ExpressionError on an invalid formula, an unknown function or a wrong number of
/// arguments.
[[nodiscard]] Expression parse_expression(std::string_view text);

/// Whether `text` is a letter or _, then letters, digits and _.
[[nodiscard]] bool is_expression_name(std::string_view text);

}  // namespace qsmpc::models
