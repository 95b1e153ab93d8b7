#include "harness/text/csv.hpp"

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace csv_test {

TEST(CsvField, quotes_a_field_that_needs_it) {
  EXPECT_EQ(csv_field("plain text"), "plain text");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("say \"a\""), "\"say \"\"a\"\"\"");
  EXPECT_EQ(csv_field("two\nlines"), "\"two\nlines\"");
}

TEST(CsvField, no_spreadsheet_takes_a_text_for_a_formula) {
  EXPECT_EQ(csv_field("=1+1"), "\"'=1+1\"");
  EXPECT_EQ(csv_field("+a"), "\"'+a\"");
  EXPECT_EQ(csv_field("-a"), "\"'-a\"");
  EXPECT_EQ(csv_field("@SUM(A1)"), "\"'@SUM(A1)\"");
  EXPECT_EQ(csv_field("\t=1"), "\"'\t=1\"");
  EXPECT_EQ(csv_field("a=1"), "a=1");
  EXPECT_EQ(csv_field(""), "");
}

}  // namespace csv_test
}  // namespace qsmpc::harness
