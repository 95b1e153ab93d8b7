#include "harness/text/text_width.hpp"

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace text_width_test {

TEST(TextLayout, lines_are_broken_at_spaces_and_never_within_a_character) {
  using Lines = std::vector<std::string>;
  EXPECT_EQ(wrapped("one two three", 8), (Lines{"one two", "three"}));
  EXPECT_EQ(wrapped("abcdef", 4), (Lines{"abcd", "ef"}));
  EXPECT_EQ(wrapped("€€€ €€", 3), (Lines{"€€€", "€€"}));
  EXPECT_EQ(wrapped("€€€€", 3), (Lines{"€€€", "€"}));
  EXPECT_TRUE(wrapped("", 5).empty());
}

TEST(TextLayout, width_counts_characters_and_grows_with_the_font) {
  EXPECT_DOUBLE_EQ(estimated_width("ä", 10.0), estimated_width("a", 10.0));
  EXPECT_GT(estimated_width("速", 10.0), estimated_width("a", 10.0));
  EXPECT_DOUBLE_EQ(estimated_width("abc", 20.0), 2.0 * estimated_width("abc", 10.0));
}

TEST(Padded, fills_up_to_the_columns_and_counts_characters) {
  EXPECT_EQ(padded("ä", 3), "ä  ");
  EXPECT_EQ(padded("abc", 3), "abc");
  EXPECT_EQ(padded("abcd", 3), "abcd");
}

}  // namespace text_width_test
}  // namespace qsmpc::harness
