// Shared by the tests of campaign files: a folder with two scenarios and a campaign.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/campaign/plan/campaign_file.hpp"
#include "harness/errors.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc::harness {

/// A folder with the scenarios a.yaml ("test", line 5 is the last), b.yaml ("other") and files that
/// a test adds.
class CampaignFolder : public TemporaryFolder {
 public:
  CampaignFolder() {
    (void)file("a.yaml", minimal_text);
    (void)file("b.yaml", "name: other\n" + minimal_text.substr(minimal_text.find('\n') + 1));
  }

  /// Writes `text` as c.yaml and returns its path.
  [[nodiscard]] std::string campaign(const std::string& text) const { return file("c.yaml", text); }

  [[nodiscard]] Campaign load(const std::string& text) const {
    return load_campaign(campaign(text));
  }

  /// The problems of a campaign, with its folder removed from file names.
  [[nodiscard]] std::vector<InputError::Where> problems(const std::string& text) const {
    std::vector<InputError::Where> problems = validate_campaign_file(campaign(text));
    for (InputError::Where& where : problems) {
      if (where.file.starts_with(path() + "/")) where.file.erase(0, path().size() + 1);
    }
    return problems;
  }

  /// The single problem of a campaign; the loader must report exactly one.
  [[nodiscard]] InputError::Where problem(const std::string& text) const {
    const std::vector<InputError::Where> all = problems(text);
    EXPECT_EQ(all.size(), 1U) << text;
    if (all.empty()) return {};
    try {
      (void)load(text);
      ADD_FAILURE() << "accepted:\n" << text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.where().key, all.front().key);
      EXPECT_EQ(error.where().line, all.front().line);
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
    return all.front();
  }
};

inline std::vector<std::string> names_of(const Campaign& campaign) {
  std::vector<std::string> names;
  for (const CampaignVariant& variant : campaign.variants) names.push_back(variant.name);
  return names;
}

}  // namespace qsmpc::harness
