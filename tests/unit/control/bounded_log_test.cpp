#include "harness/control/bounded_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace bounded_log_test {

TEST(BoundedLog, keeps_all_of_what_is_short) {
  BoundedLog log(100);
  log.add("first\n");
  log.add("second\n\n");
  EXPECT_EQ(log.text(), "first\nsecond\n\n");
  EXPECT_EQ(log.last_line(), "second");
  log.clear();
  EXPECT_EQ(log.text(), "");
  EXPECT_EQ(log.last_line(), "");
}

TEST(BoundedLog, keeps_beginning_and_end_of_what_is_long) {
  BoundedLog log(10);
  std::size_t all = 0;
  for (int n = 100; n < 1000; ++n) {
    const std::string line = std::to_string(n) + "\n";
    all += line.size();
    log.add(line);
    EXPECT_LE(log.text().size(), 100U);
  }
  EXPECT_THAT(log.text(), ::testing::StartsWith("100\n101\n10\n[… "));
  EXPECT_THAT(log.text(), ::testing::EndsWith("\n998\n999\n"));
  EXPECT_EQ(log.last_line(), "999");
  // The omitted part and the kept part add up to the whole.
  const std::string text = log.text();
  const std::size_t mark = text.find("[… ");
  const std::size_t end = text.find(" …]\n");
  const std::size_t kept = (mark - 1) + (text.size() - end - std::string(" …]\n").size());
  EXPECT_EQ(kept + std::stoul(text.substr(mark + std::string("[… ").size())), all);
}

TEST(BoundedLog, the_last_line_may_cross_the_half_or_end_before_it) {
  BoundedLog crossing(10);
  crossing.add("a long last line\n");
  EXPECT_EQ(crossing.last_line(), "a long last line");
  BoundedLog before(10);
  before.add("ten bytes!\n\n");
  EXPECT_EQ(before.last_line(), "ten bytes!");
}

}  // namespace bounded_log_test
}  // namespace qsmpc::harness
