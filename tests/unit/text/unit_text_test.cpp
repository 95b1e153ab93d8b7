#include "harness/text/unit_text.hpp"

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace unit_text_test {

TEST(UnitText, powers_are_raised) {
  EXPECT_EQ(printed_unit("m/s^2"), "m/s²");
  EXPECT_EQ(printed_unit("kg m^2/s^3"), "kg m²/s³");
  EXPECT_EQ(printed_unit("rad"), "rad");
  EXPECT_EQ(printed_unit(""), "");
}

}  // namespace unit_text_test
}  // namespace qsmpc::harness
