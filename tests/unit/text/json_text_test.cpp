#include "harness/text/json_text.hpp"

#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace qsmpc::harness {
namespace json_text_test {

using Json = nlohmann::ordered_json;

TEST(JsonText, is_indented_and_ends_in_a_new_line) {
  EXPECT_EQ(json_text(Json{{"a", 1}}), "{\n  \"a\": 1\n}\n");
  EXPECT_EQ(compact_json_text(Json{{"a", 1}}), "{\"a\":1}");
}

TEST(JsonText, invalid_utf8_is_replaced) {
  EXPECT_EQ(json_text(Json("a\xFFz")), "\"a\xEF\xBF\xBDz\"\n");
  EXPECT_EQ(compact_json_text(Json("a\xFFz")), "\"a\xEF\xBF\xBDz\"");
}

TEST(JsonText, numbers_that_are_not_finite_are_null) {
  EXPECT_EQ(json_text(Json(std::numeric_limits<double>::infinity())), "null\n");
}

}  // namespace json_text_test
}  // namespace qsmpc::harness
