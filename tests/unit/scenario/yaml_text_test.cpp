#include "harness/scenario/yaml_text.hpp"

#include <random>

#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "harness/scenario/overrides.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {
namespace yaml_text_test {

// Plain text other than numbers, true and false may come back quoted.
void expect_same(const YamlNode& a, const YamlNode& b) {
  ASSERT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.text, b.text);
  EXPECT_EQ(a.keys, b.keys);
  EXPECT_TRUE(b.quoted || !a.quoted) << a.text;
  const bool is_value = parse_number(a) || a.text == "true" || a.text == "false";
  EXPECT_TRUE(a.quoted == b.quoted || !is_value) << a.text;
  ASSERT_EQ(a.items.size(), b.items.size());
  for (std::size_t i = 0; i < a.items.size(); ++i) expect_same(a.items[i], b.items[i]);
}

std::string random_text(std::mt19937_64& random) {
  static const std::vector<std::string> pieces{
      "a", "Z", "0", "9",  ".",  "-",  "+", "/",    " ",  ":",  ",",    "[",    "]",  "{",
      "}", "#", "&", "*",  "!",  "|",  ">", "'",    "\"", "\\", "%",    "@",    "`",  "?",
      "~", "=", "_", "\n", "\t", "\r", "",  "\x7F", "é",  "€",  "null", "true", "- ", "..."};
  std::string text;
  const std::size_t count = random() % 6;
  for (std::size_t i = 0; i < count; ++i) text += pieces[random() % pieces.size()];
  return text;
}

YamlNode random_tree(std::mt19937_64& random, int depth) {
  YamlNode node;
  const std::size_t kind = random() % (depth > 0 ? 4 : 2);
  if (kind == 0 && random() % 4 == 0) return node;
  if (kind <= 1) {
    node.kind = YamlNode::Kind::kText;
    node.text = random_text(random);
    node.quoted = true;
    if (random() % 2 == 0) {
      static const std::vector<std::string> plain{"1", "-2.5e-3", ".inf", "true", "dubins", "+7"};
      node.text = plain[random() % plain.size()];
      node.quoted = false;
    }
    return node;
  }
  const bool is_map = kind == 2;
  node.kind = is_map ? YamlNode::Kind::kMap : YamlNode::Kind::kList;
  const std::size_t count = random() % 4;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_map) node.keys.push_back(random_text(random) + std::to_string(i));
    node.items.push_back(random_tree(random, depth - 1));
  }
  return node;
}

TEST(YamlFlow, reads_back_as_the_same_tree) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20'000; ++i) {
    const YamlNode tree = random_tree(random, 3);
    const std::string text = yaml_flow(tree);
    SCOPED_TRACE(text);
    EXPECT_EQ(text.find('\n'), std::string::npos);
    expect_same(tree, parse_yaml(text, "flow"));
    if (::testing::Test::HasFailure()) break;
  }
}

TEST(YamlFlow, is_what_follows_the_equals_sign_of_an_override) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 5'000; ++i) {
    const YamlNode tree = random_tree(random, 3);
    const std::string override = "some.key=" + yaml_flow(tree);
    SCOPED_TRACE(override);
    YamlNode root{.kind = YamlNode::Kind::kMap};
    apply_override(root, override);
    expect_same(tree, *root.find("some")->find("key"));
    if (::testing::Test::HasFailure()) break;
  }
}

// As written in files, including block style, where more scalars are plain than in flow style.
TEST(YamlFlow, keeps_what_a_file_says) {
  for (const std::string text :
       {"a: 1\nb: [x, 'y', \"z\"]\nc: {}\nd: []\ne:\nf: ~\n", "a: plain, with [commas] and words\n",
        "a: |\n  two\n  lines\n", "a: >\n  folded\n  text\n", "- - 1\n  - 2\n- {a: b}\n",
        "'null': null\n", "a: http://b.c/d?e=f&g\n", "a: \"\\x01\\x7f\\u00e9\\n\"\n", "12\n",
        "a: ---\n", "'': 1\n"}) {
    SCOPED_TRACE(text);
    const YamlNode tree = parse_yaml(text, "block");
    expect_same(tree, parse_yaml(yaml_flow(tree), "flow"));
  }
}

TEST(YamlFlow, is_short_where_nothing_needs_quotes) {
  EXPECT_EQ(yaml_flow(parse_yaml("x: [2, 4.5]\nname: lbfgs\nlimits: {a.b: .inf}\nnone:\n", "t")),
            "{x: [2, 4.5], name: lbfgs, limits: {a.b: .inf}, none: null}");
  EXPECT_EQ(yaml_flow(parse_yaml("['2', \"a b\"]", "t")), "[\"2\", \"a b\"]");
}

TEST(YamlFlow, a_key_longer_than_a_plain_one_may_be_reads_back) {
  YamlNode tree{.kind = YamlNode::Kind::kMap};
  tree.keys.emplace_back(3000, 'k');
  tree.items.push_back({.kind = YamlNode::Kind::kText, .text = "1"});
  expect_same(tree, parse_yaml(yaml_flow(tree), "flow"));
}

}  // namespace yaml_text_test
}  // namespace qsmpc::harness
