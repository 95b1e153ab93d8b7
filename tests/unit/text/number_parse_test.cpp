#include "harness/text/number_parse.hpp"

#include <cstdint>

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace number_parse_test {

TEST(ParseInteger, accepts_only_the_whole_text) {
  EXPECT_EQ(parse_integer<int>("-12"), -12);
  EXPECT_EQ(parse_integer<std::uint64_t>("18446744073709551615"), UINT64_MAX);
  for (const char* text : {"", " 1", "1 ", "+1", "1.0", "0x1", "one"}) {
    EXPECT_EQ(parse_integer<int>(text), std::nullopt) << text;
  }
}

TEST(ParseInteger, refuses_what_does_not_fit) {
  EXPECT_EQ(parse_integer<int>("2147483648"), std::nullopt);
  EXPECT_EQ(parse_integer<std::uint64_t>("-1"), std::nullopt);
}

TEST(ParseDecimal, takes_decimal_notation_with_either_sign) {
  EXPECT_EQ(parse_decimal("-1.5e3"), -1500.0);
  EXPECT_EQ(parse_decimal("+2"), 2.0);
  EXPECT_EQ(parse_decimal(".5"), 0.5);
}

TEST(ParseDecimal, refuses_any_other_notation) {
  for (const char* text : {"", "-", "--1", "+-1", "1,5", "1 ", "inf", "nan", "1e999", "0x10"}) {
    EXPECT_EQ(parse_decimal(text), std::nullopt) << text;
  }
}

}  // namespace number_parse_test
}  // namespace qsmpc::harness
