// A store in its own folder.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "harness/campaign/store/store.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/errors.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/campaign/campaign_fixture.hpp"

namespace qsmpc::testing {

class StoreFolder : public ::testing::Test {
 protected:
  harness::Store open(const harness::Campaign& campaign, bool update = false,
                      const harness::Shard& shard = {}) const {
    return {folder.path(), harness::stored_campaign(campaign, shard),
            harness::stored_variants(campaign, digests(campaign)), campaign.seeds, update};
  }
  static std::vector<std::string> digests(const harness::Campaign& campaign) {
    return std::vector<std::string>(campaign.variants.size());
  }
  std::string refusal(const harness::Campaign& campaign, const harness::Shard& shard = {}) const {
    try {
      (void)open(campaign, false, shard);
    } catch (const harness::InputError& error) {
      return error.what();
    }
    return "not refused";
  }
  std::vector<harness::EpisodeRow> rows_of(std::int64_t variant) const {
    std::vector<harness::EpisodeRow> rows;
    harness::StoreReader(folder.path())
        .for_each_episode(variant, [&](const harness::EpisodeRow& row) { rows.push_back(row); });
    return rows;
  }
  SQLite::Database database() const {
    return {folder.path() + "/" + harness::kStoreFile, SQLite::OPEN_READWRITE};
  }
  /// The bytes of the store, including its log.
  std::string content() const {
    database().exec("PRAGMA journal_mode = DELETE");
    std::ifstream file(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  std::string path() const { return folder.path() + "/" + harness::kStoreFile; }

  TemporaryFolder folder;
};

}  // namespace qsmpc::testing
