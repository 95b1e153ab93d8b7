#include "harness/text/html.hpp"

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace html_test {

TEST(EscapeHtml, markup_characters_become_references) {
  EXPECT_EQ(escape_html("<a href=\"x\" title='y'>&</a>"),
            "&lt;a href=&quot;x&quot; title=&#39;y&#39;&gt;&amp;&lt;/a&gt;");
}

TEST(EscapeHtml, text_of_any_script_is_kept) {
  const std::string text = "Größe 速度 🚗\n\tx";
  EXPECT_EQ(escape_html(text), text);
}

TEST(EscapeHtml, bytes_that_are_not_utf8_are_replaced_one_by_one) {
  EXPECT_EQ(escape_html("a\xFFz"), "a\xEF\xBF\xBDz");
  EXPECT_EQ(escape_html("\xC3"), "\xEF\xBF\xBD");                                  // truncated
  EXPECT_EQ(escape_html("\xC0\xBC"), "\xEF\xBF\xBD\xEF\xBF\xBD");                  // overlong '<'
  EXPECT_EQ(escape_html("\xED\xA0\x80"), "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD");  // surrogate
}

TEST(EscapeHtml, control_characters_are_replaced) {
  EXPECT_EQ(escape_html(std::string_view("a\0b\x1b\x7f", 5)),
            "a\xEF\xBF\xBD"
            "b\xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST(UrlBeside, a_plain_file_name_is_kept) {
  EXPECT_EQ(url_beside("episode-1_a.mp4"), "./episode-1_a.mp4");
}

TEST(UrlBeside, nothing_but_a_file_beside_the_page_can_be_named) {
  EXPECT_EQ(url_beside("https://a.b/c?d#\"é"), "./https%3A%2F%2Fa.b%2Fc%3Fd%23%22%C3%A9");
}

}  // namespace html_test
}  // namespace qsmpc::harness
