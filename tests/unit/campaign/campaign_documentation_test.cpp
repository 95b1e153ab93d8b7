// docs/campaign.md and the reader agree, and damaged files are refused.
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/campaign/campaign_folder.hpp"

namespace qsmpc::harness {
namespace campaign_documentation_test {

using ::testing::HasSubstr;

std::string document() { return content_of(std::string(QSMPC_SOURCE_DIR) + "/docs/campaign.md"); }

std::string example() {
  const std::string text = document();
  const std::string fence = "```yaml\n";
  const std::size_t begin = text.find(fence) + fence.size();
  return text.substr(begin, text.find("```", begin) - begin);
}

TEST(CampaignDocumentation, its_example_is_as_described) {
  const CampaignFolder folder;
  (void)folder.file("my_scenario.yaml", minimal_text);
  const Campaign campaign = folder.load(example());
  EXPECT_EQ(campaign.variants.size(), 48U);
  EXPECT_EQ(campaign.episodes(), 9600);
  EXPECT_THAT(document(), HasSubstr("= 48 variants with 200 seeds each, 9600 episodes"));
  EXPECT_THAT(document(), HasSubstr("`" + campaign.variants.front().name + "`"));
}

TEST(CampaignDocumentation, describes_every_key) {
  const CampaignFolder folder;
  const auto problems = folder.problems("scenario: a.yaml\nseeds: [0]\nzzzzzzzz: 1\n");
  ASSERT_EQ(problems.size(), 1U);
  // "one of name, description, …": the keys known to the reader.
  std::string known = problems.front().expected.substr(std::string("one of ").size()) + ", ";
  int keys = 0;
  for (std::size_t comma = 0; (comma = known.find(", ")) != std::string::npos; ++keys) {
    EXPECT_THAT(document(), HasSubstr("| `" + known.substr(0, comma) + "` |"));
    known.erase(0, comma + 2);
  }
  EXPECT_EQ(keys, 13);
}

TEST(HostileCampaign, a_damaged_file_is_loaded_or_refused_and_nothing_else) {
  const std::string whole =
      "scenarios: [a.yaml, b.yaml]\nvariants:\n  closed: {controller.policy: closed_loop}\n"
      "  open: {controller: {policy: open_loop}, safe_set.obstacles: [{x: [2, 3]}]}\n"
      "grid: {controller.horizon: [2, 3], description: [a, 'b, c']}\nplants: [analytic]\n"
      "seeds: {first: 0, count: 10}\ntraces: failures\ntrace_sample: 2\n";
  const std::string syntax = "[]{}:,-#&*!|>'\"%@`\n\t .0123456789eE+~?\\=";
  const CampaignFolder folder;
  std::mt19937_64 random(4);
  int loaded = 0;
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::string text = whole;
    const std::size_t at = random() % text.size();
    const std::size_t kind = random() % 3;
    if (kind == 0) text[at] = syntax[random() % syntax.size()];
    if (kind == 1) text.insert(at, 1, syntax[random() % syntax.size()]);
    if (kind == 2) text.erase(at, 1 + random() % 8);
    try {
      EXPECT_GE(folder.load(text).variants.size(), 1U) << text;
      ++loaded;
    } catch (const InputError& error) {
      EXPECT_NE(error.where().expected, "") << error.what() << "\n" << text;
      EXPECT_NE(error.where().file, "--set") << error.what() << "\n" << text;
      ++refused;
    }
  }
  // Both outcomes are frequent; otherwise the damage is too mild or too severe to test anything.
  EXPECT_GT(loaded, 20);
  EXPECT_GT(refused, 200);
}

}  // namespace campaign_documentation_test
}  // namespace qsmpc::harness
