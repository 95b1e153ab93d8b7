#include "harness/text/printable.hpp"

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace printable_test {

TEST(Printable, replaces_control_characters_by_spaces) {
  EXPECT_EQ(printable("a\nb\x1B[31m\x7F"), "a b [31m ");
}

TEST(Printable, marks_a_text_that_is_cut) {
  EXPECT_EQ(printable("abcd", 4), "abcd");
  EXPECT_EQ(printable("abcde", 4), "abcd…");
}

TEST(Printable, cuts_no_character_in_half) {
  EXPECT_EQ(printable("ab€cd", 3), "ab…");
  EXPECT_EQ(printable("ab€cd", 4), "ab…");
}

}  // namespace printable_test
}  // namespace qsmpc::harness
