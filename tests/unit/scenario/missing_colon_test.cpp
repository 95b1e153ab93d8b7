// A missing colon is reported at its own line, not where the parser fails.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc::harness {
namespace missing_colon_test {

using ::testing::HasSubstr;

void expect_at(int line, const std::string& words, const std::string& text) {
  const InputError::Where where = refusal_of(text);
  EXPECT_EQ(where.line, line) << text;
  EXPECT_EQ(where.found, "\"" + words + "\"") << text;
  EXPECT_EQ(where.expected, "a colon after the key");
}

TEST(MissingColon, is_reported_at_its_own_line) {
  expect_at(2, "time_step 0.1", "name: x\ntime_step 0.1\nmodel: {system: dubins}\n");
  expect_at(2, "time_step 0.1", "name: x\ntime_step 0.1   # s\n\n# more\nmodel: {}\n");
  expect_at(3, "system dubins", "name: x\nmodel:\n  system dubins\n  speed: 1\n");
  expect_at(4, "speed 1", "name: x\nmodel:\n  system: dubins\n  speed 1\ntime_step: 0.1\n");
}

TEST(MissingColon, is_reported_in_the_last_line) {
  expect_at(3, "time_step 0.1", "name: x\nmodel: {system: dubins}\ntime_step 0.1\n");
  expect_at(3, "time_step 0.1", "name: x\nmodel: {system: dubins}\ntime_step 0.1");
}

TEST(MissingColon, is_not_seen_in_a_text_of_several_lines) {
  EXPECT_EQ(parse_scenario(minimal_text + "description: a car that\n  drives on\n").description,
            "a car that drives on");
  const InputError::Where where =
      refusal_of("name: x\ndescription: a car that\n  drives on\nmodel: {system: a: b}\n");
  EXPECT_THAT(where.found, HasSubstr("not YAML"));
}

}  // namespace missing_colon_test
}  // namespace qsmpc::harness
