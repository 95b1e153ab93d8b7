// Files designed to break the reader: each gives a scenario or an InputError, quickly.
#include <random>

#include <gtest/gtest.h>

#include "harness/scenario/shipped_files.hpp"
#include "harness/scenario/yaml_tree.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc::harness {
namespace hostile_file_test {

std::string repeated(const std::string& piece, std::size_t bytes) {
  std::string text;
  text.reserve(bytes + piece.size());
  while (text.size() + piece.size() <= bytes) text += piece;
  return text;
}

TEST(HostileFile, an_alias_bomb_is_refused_at_its_first_anchor) {
  std::string bomb = "a: &a [x, x, x, x, x, x, x, x, x]\n";
  for (char c = 'b'; c <= 'i'; ++c) {
    const std::string before(1, static_cast<char>(c - 1));
    bomb += std::string(1, c) + ": &" + c + " [";
    for (int i = 0; i < 9; ++i) bomb += (i == 0 ? "*" : ", *") + before;
    bomb += "]\n";
  }
  const InputError::Where where = refusal_of(bomb);
  EXPECT_EQ(where.line, 1);
  EXPECT_EQ(where.found, "an anchor (&)");
}

TEST(HostileFile, ten_megabytes_of_noise_are_refused_by_their_size) {
  const TemporaryFolder folder;
  std::mt19937_64 random(1);
  std::string noise;
  noise.resize(10'000'000);
  for (char& c : noise) c = static_cast<char>(random());
  const auto problems = validate_scenario_file(folder.file("noise.yaml", noise));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].expected, "a file of at most 1 MiB");
}

TEST(HostileFile, noise_below_the_limit_is_refused) {
  std::mt19937_64 random(2);
  std::string noise(kMaxYamlBytes, '\0');
  for (char& c : noise) c = static_cast<char>(random());
  EXPECT_EQ(refusal_of(noise).expected, "a YAML file in UTF-8");
}

// One mebibyte of each piece that makes a parser nest, backtrack or accumulate.
TEST(HostileFile, a_mebibyte_of_any_syntax_ends_without_harm) {
  for (const std::string piece :
       {"[",           "{",          "]",        "}",     "- ",       "? ",    ": ",      "a: ",
        "!",           "&",          "*",        "|",     ">",        "'",     "\"",      "%",
        "#",           "\n",         " ",        "-\n",   "a\n",      "- a\n", "{a: ",    "[a, ",
        "? a\n",       "---\n",      "...\n",    "[],",   "{},",      "\\",    "a: |\n ", "!!a ",
        "%YAML 1.2\n", "%TAG ! x\n", "\xC3\xA9", "'a': ", "\"\\u00e9"}) {
    SCOPED_TRACE(piece);
    (void)refusal_of(repeated(piece, kMaxYamlBytes));
    (void)refusal_of("a: " + repeated(piece, kMaxYamlBytes - 3));
  }
}

TEST(HostileFile, many_unknown_keys_give_a_bounded_number_of_problems) {
  const TemporaryFolder folder;
  std::string text = minimal_text;
  for (int i = 0; i < 50000; ++i) text += "k" + std::to_string(i) + ": 1\n";
  EXPECT_EQ(validate_scenario_file(folder.file("s.yaml", text)).size(), 100U);
}

std::string mutated(std::string text, std::mt19937_64& random) {
  static const std::string syntax = "[]{}:,-#&*!|>'\"%@`\n\t .0123456789eE+~?\\";
  const std::size_t changes = 1 + random() % 3;
  for (std::size_t i = 0; i < changes && !text.empty(); ++i) {
    const std::size_t at = random() % text.size();
    const char piece =
        random() % 4 == 0 ? static_cast<char>(random()) : syntax[random() % syntax.size()];
    switch (random() % 4) {
      case 0:
        text[at] = piece;
        break;
      case 1:
        text.insert(at, 1, piece);
        break;
      case 2:
        text.erase(at, 1 + random() % 16);
        break;
      default:
        text.insert(at, text.substr(random() % text.size(), 1 + random() % 32));
    }
  }
  return text;
}

TEST(HostileFile, a_damaged_file_is_loaded_or_refused_and_nothing_else) {
  std::vector<std::string> texts;
  for (const ShippedScenario& entry : shipped_scenarios()) {
    texts.push_back(content_of(entry.path));
    texts.push_back(to_yaml(load_scenario(entry.name)));
  }
  ASSERT_FALSE(texts.empty());
  std::mt19937_64 random(3);
  int loaded = 0;
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::string text = mutated(texts[static_cast<std::size_t>(i) % texts.size()], random);
    try {
      const Scenario scenario = parse_scenario(text);
      // An accepted scenario can be written, and is accepted again.
      EXPECT_EQ(to_yaml(parse_scenario(to_yaml(scenario))), to_yaml(scenario)) << text;
      ++loaded;
    } catch (const InputError& error) {
      EXPECT_NE(error.where().expected, "") << text;
      ++refused;
    } catch (const std::exception& error) {
      FAIL() << error.what() << "\n" << text;
    }
  }
  // Both outcomes are frequent; otherwise the damage is too mild or too severe to test anything.
  EXPECT_GT(loaded, 200);
  EXPECT_GT(refused, 1000);
}

}  // namespace hostile_file_test
}  // namespace qsmpc::harness
