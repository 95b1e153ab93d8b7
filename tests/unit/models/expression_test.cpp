// The meaning of formulas, and error messages for invalid ones.
#include "models/dynamics/equations/expression.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace qsmpc::models {
namespace expression_test {

using ::testing::HasSubstr;

std::string steps_of(const std::string& text) {
  static const char* const words[] = {"", "", "neg", "+", "-", "*", "/", "^", ""};
  std::string out;
  for (const Expression::Step& step : parse_expression(text).steps) {
    if (!out.empty()) out += ' ';
    const bool is_number = step.kind == Expression::Kind::kNumber;
    out += is_number ? std::to_string(step.number).substr(0, 3)
                     : words[static_cast<int>(step.kind)] + step.name;
  }
  return out;
}

TEST(Expression, binds_as_in_mathematics) {
  EXPECT_EQ(steps_of("a + b * c"), "a b c * +");
  EXPECT_EQ(steps_of("a - b - c"), "a b - c -");
  EXPECT_EQ(steps_of("a / b / c"), "a b / c /");
  EXPECT_EQ(steps_of("(a + b) * c"), "a b + c *");
  EXPECT_EQ(steps_of("-a^2"), "a 2.0 ^ neg");
  EXPECT_EQ(steps_of("a^-2"), "a 2.0 neg ^");
  EXPECT_EQ(steps_of("a^b^c"), "a b c ^ ^");
  EXPECT_EQ(steps_of("a**b * c"), "a b ^ c *");
  EXPECT_EQ(steps_of("a * -b"), "a b neg *");
  EXPECT_EQ(steps_of("--a"), "a neg neg");
  EXPECT_EQ(steps_of("+a"), "a");
  EXPECT_EQ(steps_of("-a + b"), "a neg b +");
  EXPECT_EQ(steps_of("-a * b"), "a neg b *");
  EXPECT_EQ(steps_of("atan2(y, x + 1)"), "y x 1.0 + atan2");
  EXPECT_EQ(steps_of("sin ( cos(a) )"), "a cos sin");
}

TEST(Expression, reads_numbers_as_they_are_written_anywhere) {
  for (const auto& [text, value] : std::vector<std::pair<std::string, double>>{{"1", 1.0},
                                                                               {"1.5", 1.5},
                                                                               {".5", 0.5},
                                                                               {"2.", 2.0},
                                                                               {"1e3", 1000.0},
                                                                               {"1.5E-2", 0.015}}) {
    EXPECT_EQ(parse_expression(text).steps.at(0).number, value) << text;
  }
}

struct Wrong {
  const char* text;
  std::size_t column;
  const char* found;
  const char* expected;
};

class WrongExpression : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongExpression, is_refused_at_its_column) {
  const Wrong& wrong = GetParam();
  try {
    (void)parse_expression(wrong.text);
    FAIL() << wrong.text;
  } catch (const ExpressionError& error) {
    EXPECT_EQ(error.column(), wrong.column) << wrong.text;
    EXPECT_THAT(error.found(), HasSubstr(wrong.found)) << wrong.text;
    EXPECT_THAT(error.expected(), HasSubstr(wrong.expected)) << wrong.text;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Texts, WrongExpression,
    ::testing::Values(
        Wrong{"", 1, "the end", "a number, a name or '('"}, Wrong{"a +", 4, "the end", "a number"},
        Wrong{"a b", 3, "'b'", "an operator or the end"}, Wrong{"2x", 2, "'x'", "an operator"},
        Wrong{"1.2.3", 4, "'.'", "an operator"}, Wrong{"(a", 3, "the end", "')'"},
        Wrong{"a)", 2, "')'", "an operator"}, Wrong{"a * / b", 5, "'/'", "a number"},
        Wrong{"x = 3", 3, "'='", "an operator"}, Wrong{"sin()", 1, "sin of 0", "sin of 1 argument"},
        Wrong{"a + atan2(b)", 5, "atan2 of 1", "atan2 of 2 arguments"},
        Wrong{"min(a, b, c)", 1, "min of 3", "min of 2"},
        Wrong{"sine(a)", 1, "the function 'sine'", "sin"},
        Wrong{"sin(a", 6, "the end", "',' or ')'"}, Wrong{"1e999", 1, "'1e999'", "a number"},
        Wrong{"a · b", 3, "'·'", "an operator"},
        // Columns count characters, not bytes.
        Wrong{"ä", 1, "'ä'", "a number"}, Wrong{"(a) ä ö", 5, "'ä'", "an operator"}));

TEST(Expression, refuses_nesting_that_would_end_the_stack) {
  EXPECT_THROW((void)parse_expression(std::string(5000, '(') + "a"), ExpressionError);
  EXPECT_THROW((void)parse_expression(std::string(5000, '-') + "a"), ExpressionError);
  EXPECT_THROW((void)parse_expression(std::string(20000, ' ') + "a"), ExpressionError);
  EXPECT_NO_THROW((void)parse_expression(std::string(100, '(') + "a" + std::string(100, ')')));
}

}  // namespace expression_test
}  // namespace qsmpc::models
