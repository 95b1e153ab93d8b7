#include "harness/text/utf8.hpp"

#include <string>

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace utf8_test {

using std::string_literals::operator""s;

TEST(Utf8Length, is_the_number_of_bytes_of_the_first_character) {
  EXPECT_EQ(utf8_length("a€"), 1U);
  EXPECT_EQ(utf8_length("é-"), 2U);
  EXPECT_EQ(utf8_length("€-"), 3U);
  EXPECT_EQ(utf8_length("🚗-"), 4U);
  EXPECT_EQ(utf8_length("\0"s), 1U);
}

TEST(Utf8Length, accepts_the_first_and_last_character_of_each_length) {
  for (const std::string& text : {"\xC2\x80"s, "\xDF\xBF"s}) EXPECT_EQ(utf8_length(text), 2U);
  for (const std::string& text :
       {"\xE0\xA0\x80"s, "\xED\x9F\xBF"s, "\xEE\x80\x80"s, "\xEF\xBF\xBF"s}) {
    EXPECT_EQ(utf8_length(text), 3U);
  }
  for (const std::string& text : {"\xF0\x90\x80\x80"s, "\xF4\x8F\xBF\xBF"s}) {
    EXPECT_EQ(utf8_length(text), 4U);
  }
}

TEST(Utf8Length, is_zero_where_no_character_is_well_formed) {
  for (const std::string& text :
       {"\x80"s, "\xBF"s,                                   // continuation bytes
        "\xC0\xBC"s, "\xC1\xBF"s, "\xE0\x9F\xBF"s,          // overlong
        "\xF0\x8F\xBF\xBF"s,                                // overlong
        "\xED\xA0\x80"s, "\xED\xBF\xBF"s,                   // surrogates
        "\xF4\x90\x80\x80"s, "\xF5\x80\x80\x80"s, "\xFF"s,  // above U+10FFFF
        "\xC3"s, "\xE2\x82"s, "\xF0\x9F\x9A"s,              // truncated
        "\xC3z"s, "\xE2\x82z"s, "\xF0\x9F\x9Az"s}) {
    EXPECT_EQ(utf8_length(text), 0U) << ::testing::PrintToString(text);
  }
}

TEST(Utf8Characters, counts_characters_rather_than_bytes) {
  EXPECT_EQ(utf8_characters(""), 0U);
  EXPECT_EQ(utf8_characters("Größe 🚗"), 7U);
}

TEST(ControlCharacter, is_below_the_space_or_delete) {
  EXPECT_TRUE(is_control_character('\0'));
  EXPECT_TRUE(is_control_character('\x1F'));
  EXPECT_TRUE(is_control_character('\x7F'));
  EXPECT_FALSE(is_control_character(' '));
  EXPECT_FALSE(is_control_character('~'));
  EXPECT_FALSE(is_control_character('\x80'));
}

}  // namespace utf8_test
}  // namespace qsmpc::harness
