#include "harness/text/fnv1a.hpp"

#include <string>

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace fnv1a_test {

template <class Word>
Word digest_of(std::string_view text) {
  Fnv1a<Word> digest;
  digest.add(text);
  return digest.value();
}

TEST(Fnv1a, has_the_published_values) {
  EXPECT_EQ(digest_of<std::uint32_t>(""), 0x811c9dc5U);
  EXPECT_EQ(digest_of<std::uint32_t>("a"), 0xe40c292cU);
  EXPECT_EQ(digest_of<std::uint32_t>("foobar"), 0xbf9cf968U);
  EXPECT_EQ(digest_of<std::uint64_t>(""), 0xcbf29ce484222325U);
  EXPECT_EQ(digest_of<std::uint64_t>("a"), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(digest_of<std::uint64_t>("foobar"), 0x85944171f73967e8U);
}

TEST(Fnv1a, of_a_number_is_that_of_its_bytes) {
  Fnv1a<std::uint64_t> digest;
  digest.add(std::uint64_t{0x6261});
  EXPECT_EQ(digest.value(), digest_of<std::uint64_t>(std::string_view("ab\0\0\0\0\0\0", 8)));
}

TEST(Fnv1a, of_a_small_number_is_that_of_its_bytes) {
  for (const unsigned number : {0U, 1U, 97U, 255U}) {
    const std::string bytes{static_cast<char>(number), 0, 0, 0, 0, 0, 0, 0};
    Fnv1a<std::uint64_t> digest;
    digest.add(std::string_view("x"));
    digest.add(std::uint64_t{number});
    EXPECT_EQ(digest.value(), digest_of<std::uint64_t>("x" + bytes));
    Fnv1a<std::uint32_t> shorter;
    shorter.add(std::uint64_t{number});
    EXPECT_EQ(shorter.value(), digest_of<std::uint32_t>(bytes));
  }
}

}  // namespace fnv1a_test
}  // namespace qsmpc::harness
