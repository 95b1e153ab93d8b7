#include "harness/report/packed_numbers.hpp"

#include <stdexcept>
#include <string_view>

#include <gtest/gtest.h>

#include "harness/text/base64.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace packed_numbers_test {

std::string base64_of(std::string_view text) {
  return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

TEST(Base64, gives_the_examples_of_its_definition) {  // RFC 4648, section 10
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64_of("\xFF\xFE\xFB"), "//77");
}

TEST(Base64, takes_bytes_as_hexadecimal_digits_and_nothing_else) {
  EXPECT_EQ(base64_of_hex("666f6f"), "Zm9v");
  EXPECT_THROW((void)base64_of_hex("666"), std::invalid_argument);
  EXPECT_THROW((void)base64_of_hex("6g"), std::invalid_argument);
}

TEST(PackedNumbers, are_little_endian) {
  EXPECT_EQ(packed_words({0x0201, 0xFFFF}), base64_of("\x01\x02\xFF\xFF"));
  EXPECT_EQ(packed_bytes({0x01, 0xFE}), base64_of("\x01\xFE"));
  EXPECT_EQ(packed_floats({1.0, -2.5}),
            base64_of(std::string_view("\x00\x00\x80\x3F\x00\x00\x20\xC0", 8)));
}

TEST(PackedNumbers, keep_what_is_not_finite) {
  EXPECT_EQ(packed_floats({kInfinity}), base64_of(std::string_view("\x00\x00\x80\x7F", 4)));
  EXPECT_EQ(packed_floats({1e300}), packed_floats({kInfinity}));
}

}  // namespace packed_numbers_test
}  // namespace qsmpc::harness
