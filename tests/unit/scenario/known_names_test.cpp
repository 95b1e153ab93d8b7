#include "harness/scenario/known_names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace known_names_test {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(EditDistance, counts_each_kind_of_slip_once) {
  EXPECT_EQ(edit_distance("horizon", "horizon"), 0U);
  EXPECT_EQ(edit_distance("horzon", "horizon"), 1U);
  EXPECT_EQ(edit_distance("horizzon", "horizon"), 1U);
  EXPECT_EQ(edit_distance("horixon", "horizon"), 1U);
  EXPECT_EQ(edit_distance("hroizon", "horizon"), 1U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("abc", ""), 3U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
}

TEST(NearestNames, puts_the_nearest_first_and_leaves_out_the_far) {
  const std::vector<std::string> known{"closed_loop", "open_loop", "state", "stat"};
  EXPECT_THAT(nearest_names("opn_loop", known), ElementsAre("open_loop"));
  EXPECT_THAT(nearest_names("stat", known), ElementsAre("stat", "state"));
  EXPECT_THAT(nearest_names("closed", known), ElementsAre("closed_loop"));
  EXPECT_THAT(nearest_names("zzzzzzzz", known), IsEmpty());
  EXPECT_THAT(nearest_names("", known), IsEmpty());
  EXPECT_THAT(nearest_names(std::string(100000, 'a'), known), IsEmpty());
}

TEST(NearestNames, a_one_letter_name_is_not_near_to_another) {
  EXPECT_THAT(nearest_names("z", {"x", "y"}), IsEmpty());
}

TEST(ExpectedNames, says_the_suggestion_before_the_list) {
  EXPECT_EQ(expected_names("tpo", {"chase", "top"}), "top (known: chase, top)");
  EXPECT_EQ(expected_names("zzzzzz", {"chase", "top"}), "one of chase, top");
}

}  // namespace known_names_test
}  // namespace qsmpc::harness
