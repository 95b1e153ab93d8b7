#include "harness/text/number_format.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "models/constants.hpp"

namespace qsmpc::harness {
namespace number_format_test {

TEST(FormatNumber, ordinary_numbers_are_plain_decimals) {
  EXPECT_EQ(format_number(0.0), "0");
  EXPECT_EQ(format_number(12.345), "12.3");
  EXPECT_EQ(format_number(-0.0456), "−0.0456");
  EXPECT_EQ(format_number(9.999), "10.0");
  EXPECT_EQ(format_number(123456.0), "123456");
}

TEST(FormatNumber, others_have_a_power_of_ten) {
  EXPECT_EQ(format_number(1.234e-5), "1.23 × 10⁻⁵");
  EXPECT_EQ(format_number(-4.0e12, 2), "−4.0 × 10¹²");
}

TEST(FormatNumber, names_what_is_not_finite) {
  EXPECT_EQ(format_number(kInfinity), "∞");
  EXPECT_EQ(format_number(-kInfinity), "−∞");
  EXPECT_EQ(format_number(std::numeric_limits<double>::quiet_NaN()), "not a number");
}

TEST(FormatShort, zeros_at_the_end_of_the_decimals_are_left_out) {
  EXPECT_EQ(format_short(10.9, 4), "10.9");
  EXPECT_EQ(format_short(100.0, 4), "100");
  EXPECT_EQ(format_short(0.1 + 0.2), "0.3");
  EXPECT_EQ(format_short(2.0e-7), "2 × 10⁻⁷");
  EXPECT_EQ(format_short(-0.25), "−0.25");
}

TEST(FormatBound, is_rounded_up) {
  EXPECT_EQ(format_bound(0.012301), "0.0124");
  EXPECT_EQ(format_bound(1.2301e-9), "1.24 × 10⁻⁹");
  EXPECT_EQ(format_bound(0.9991), "1");
}

TEST(FormatBound, a_short_decimal_is_kept) {
  EXPECT_EQ(format_bound(0.25), "0.25");
  EXPECT_EQ(format_bound(0.0), "0");
  EXPECT_EQ(format_bound(1.0), "1");
}

TEST(FormatBound, works_for_the_smallest_numbers) {
  EXPECT_FALSE(format_bound(std::numeric_limits<double>::denorm_min()).empty());
  EXPECT_EQ(format_bound(kInfinity), "∞");
}

TEST(FormatFixed, zero_has_no_sign) {
  EXPECT_EQ(format_fixed(-0.001, 1), "0.0");
  EXPECT_EQ(format_fixed(-2.5, 1), "−2.5");
}

TEST(FormatPercent, shows_0_and_100_only_where_exact) {
  EXPECT_EQ(format_percent(0.0), "0");
  EXPECT_EQ(format_percent(1.0), "100");
  EXPECT_EQ(format_percent(1e-9), "<0.01");
  EXPECT_EQ(format_percent(1.0 - 1e-9), ">99.9");
  EXPECT_EQ(format_percent(0.9989), "99.9");
  EXPECT_EQ(format_percent(0.5), "50");
  EXPECT_EQ(format_percent(0.12345), "12.3");
  EXPECT_EQ(format_percent(0.0012345), "0.12");
  EXPECT_EQ(format_percent(0.09999), "10");
  EXPECT_EQ(format_percent(std::nan("")), "-");
}

TEST(PlainInTable, holds_for_zero_and_ordinary_sizes) {
  for (const double value : {0.0, -0.0, 0.01, -0.01, 1.0, -9999.9}) {
    EXPECT_TRUE(is_plain_in_table(value)) << value;
  }
  for (const double value : {0.00999, -1e4, kInfinity, std::nan("")}) {
    EXPECT_FALSE(is_plain_in_table(value)) << value;
  }
}

}  // namespace number_format_test
}  // namespace qsmpc::harness
