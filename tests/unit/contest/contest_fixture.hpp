// Contest files in a folder, and stores of made-up drives.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "harness/campaign/store/store.hpp"
#include "harness/contest/contest.hpp"
#include "harness/contest/contest_file.hpp"
#include "harness/contest/contest_reader.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/yaml_tree.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/campaign/campaign_fixture.hpp"

namespace qsmpc::testing {

/// Two controllers on one map with three seeds; `more` is appended.
inline std::string contest_text(const std::string& more = "") {
  return "controllers:\n"
         "  careful: {controller.kind: quantised}\n"
         "  bold: {controller.kind: nominal}\n"
         "scenarios: [quick.yaml]\n"
         "seeds: {first: 5, count: 3}\n" +
         more;
}

/// A contest file beside the map that it names.
class ContestFolder {
 public:
  ContestFolder() { (void)folder_.file("quick.yaml", harness::to_yaml(quick_scenario())); }

  [[nodiscard]] std::string file(const std::string& text) const {
    return folder_.file("small.yaml", text);
  }
  [[nodiscard]] harness::LoadedContest load(const std::string& text) const {
    return harness::load_contest(file(text));
  }
  /// The problems of a contest with this text, one per line.
  [[nodiscard]] std::string problems(const std::string& text) const {
    std::string lines;
    for (const harness::InputError::Where& where : harness::validate_contest_file(file(text))) {
      const std::string line = harness::InputError(where).what();
      lines += line.substr(line.find("small.yaml")) + "\n";
    }
    return lines;
  }
  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }

 private:
  TemporaryFolder folder_;
};

/// The store of `campaign` with `rows`, in the existing folder `path`.
inline void fill_store(const harness::Campaign& campaign, const std::string& path,
                       const std::vector<harness::EpisodeRow>& rows) {
  harness::Store store(
      path, harness::stored_campaign(campaign, {}),
      harness::stored_variants(campaign, std::vector<std::string>(campaign.variants.size())),
      campaign.seeds, false);
  for (const harness::EpisodeRow& row : rows) store.add(row, false);
  store.fold();
}

}  // namespace qsmpc::testing
