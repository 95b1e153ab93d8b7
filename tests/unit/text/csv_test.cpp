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

}  // namespace csv_test
}  // namespace qsmpc::harness
