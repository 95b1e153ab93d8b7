#include "harness/prediction/input_table.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/errors.hpp"

namespace qsmpc::harness {
namespace input_table_test {

InputTableFormat two_inputs() {
  return {.inputs = {{.name = "steering", .unit = "rad"}, {.name = "acceleration", .unit = "m/s²"}},
          .bounds = {.lower = Eigen::Vector2d(-0.5, -3.0), .upper = Eigen::Vector2d(0.5, 2.0)}};
}

Eigen::MatrixXd table(const std::string& text, std::optional<int> stages = std::nullopt) {
  InputTableFormat format = two_inputs();
  format.stages = stages;
  return parse_input_table(text, "in.csv", format);
}

TEST(InputTable, a_row_is_a_stage_and_a_column_an_input) {
  Eigen::MatrixXd expected(2, 3);
  expected << 0.1, -0.5, 0.5, 2, 1e-3, -3;
  EXPECT_EQ(table("0.1,2\n-0.5,1e-3\n0.5,-3\n"), expected);
  EXPECT_EQ(table(" +0.1 ,\t2.0\r\n-.5,0.001\r\n0.5,-3"), expected) << "blanks, CRLF, no last end";
  EXPECT_EQ(table("\xEF\xBB\xBF"
                  "0.1,2\n-0.5,0.001\n0.5,-3\n\n\n"),
            expected)
      << "byte order mark, empty lines at the end";
}

TEST(InputTable, a_first_line_may_name_the_inputs_in_any_order) {
  Eigen::MatrixXd expected(2, 1);
  expected << 0.1, 2;
  EXPECT_EQ(table("steering,acceleration\n0.1,2\n"), expected);
  EXPECT_EQ(table("acceleration, steering\n2,0.1\n"), expected);
}

TEST(InputTable, no_more_rows_are_read_than_stages_are_wanted) {
  EXPECT_EQ(table("0.1,2\n0.2,1\nbroken\n", 2).cols(), 2);
}

struct Broken {
  const char* name;
  std::string text;
  const char* message;
};

class BrokenInputTable : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenInputTable, is_refused_with_where_what_and_what_is_expected) {
  try {
    static_cast<void>(table(GetParam().text));
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), GetParam().message);
  }
}

std::string many_rows() {
  std::string text;
  for (int i = 0; i < 1001; ++i) text += "0,0\n";
  return text;
}

INSTANTIATE_TEST_SUITE_P(
    Files, BrokenInputTable,
    ::testing::Values(
        Broken{"empty", "",
               "in.csv: found 0 rows, expected at least one row: 2 numbers separated by commas: "
               "steering, acceleration"},
        Broken{"header_only", "steering,acceleration\n",
               "in.csv: found 0 rows, expected at least one row: 2 numbers separated by commas: "
               "steering, acceleration"},
        Broken{"few_columns", "0,0\n0.1\n",
               "in.csv:2: found 1 column, expected 2 numbers separated by commas: steering, "
               "acceleration"},
        Broken{"many_columns", "0,0,0\n",
               "in.csv:1: found 3 columns, expected 2 numbers separated by commas: steering, "
               "acceleration"},
        Broken{"empty_line", "0,0\n\n0,0\n",
               "in.csv:2: found an empty line, expected 2 numbers separated by commas: steering, "
               "acceleration"},
        Broken{"word", "0,0\n0,fast\n",
               "in.csv:2: column 2 (acceleration): found fast, expected a finite number"},
        Broken{"empty_cell", "0,\n",
               "in.csv:1: column 2 (acceleration): found nothing, expected a finite number"},
        Broken{"not_a_number", "0,nan\n",
               "in.csv:1: column 2 (acceleration): found nan, expected a finite number"},
        Broken{"infinite", "0,0\ninf,inf\n",
               "in.csv:2: column 1 (steering): found inf, expected a finite number"},
        Broken{"beyond_doubles", "1e999,0\n",
               "in.csv:1: column 1 (steering): found 1e999, expected a finite number"},
        Broken{"above_its_bound", "0,0\n0,2.5\n",
               "in.csv:2: column 2 (acceleration): found 2.5, expected a number from -3 to 2, the "
               "bounds of the input"},
        Broken{"below_its_bound", "acceleration,steering\n0,-0.51\n",
               "in.csv:2: column 2 (steering): found -0.51, expected a number from -0.5 to 0.5, "
               "the bounds of the input"},
        Broken{"unknown_name", "steering,accelration\n0,0\n",
               "in.csv:1: column 2: found accelration, expected a number, or the name of an input: "
               "acceleration (known: steering, acceleration)"},
        Broken{"name_twice", "steering,steering\n0,0\n",
               "in.csv:1: column 2: found steering a second time, expected each input once"},
        Broken{"second_header", "steering,acceleration\nsteering,acceleration\n",
               "in.csv:2: column 1 (steering): found steering, expected a finite number"},
        Broken{"too_many_rows", many_rows(),
               "in.csv:1001: found more than 1000 rows, expected one row per stage, no more"},
        Broken{"binary", std::string("0,0\n\0\x01,0\n", 9),
               "in.csv:2: found the control character 0x00, expected a CSV file in UTF-8"}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(InputTable, fewer_rows_than_stages_are_refused) {
  try {
    static_cast<void>(table("0,0\n0,0\n", 3));
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "in.csv: found 2 rows, expected at least 3, one per stage");
  }
}

TEST(InputTable, a_file_that_is_not_there_is_refused_by_its_name) {
  try {
    static_cast<void>(read_input_table("/no/such/file.csv", two_inputs()));
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("/no/such/file.csv: found No such file"));
  }
}

}  // namespace input_table_test
}  // namespace qsmpc::harness
