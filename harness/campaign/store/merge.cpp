#include "harness/campaign/store/merge.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <system_error>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/store/folder_lock.hpp"
#include "harness/campaign/store/store_reader.hpp"
#include "harness/campaign/store/store_rows.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/trace/trace_file.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;

std::string shard_text(const Shard& shard) {
  return fmt::format("shard {}/{}", shard.index, shard.count);
}

/// "penalties: w2, w20; limits: r001", "none" without a family.
std::string families_text(const std::vector<VariantFamily>& families) {
  std::string text;
  for (const VariantFamily& family : families) {
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", family.name,
                        fmt::join(family.settings, ", "));
  }
  return text.empty() ? "none" : text;
}

/// Refuses `other` unless it is a shard of the campaign that `first` is of.
void require_same(const StoreReader& first, const StoreReader& other, const std::string& folder) {
  const auto require = [&](const std::string& key, const std::string& found,
                           const std::string& expected) {
    if (found != expected) {
      throw InputError({.file = folder, .key = key, .found = found, .expected = expected});
    }
  };
  const StoredCampaign& expected = first.campaign();
  const StoredCampaign& found = other.campaign();
  require("name", found.name, expected.name);
  require("version", found.version, expected.version);
  require("seeds", found.seeds, expected.seeds);
  require("traces", found.traces, expected.traces);
  require("rare", found.rare, expected.rare);
  require("figure.risk_against_cost", families_text(found.risk_against_cost),
          families_text(expected.risk_against_cost));
  require("shards", fmt::format("{}", found.shard.count), fmt::format("{}", expected.shard.count));
  require("variants", fmt::format("{}", other.variants().size()),
          fmt::format("{}", first.variants().size()));
  for (std::size_t i = 0; i < first.variants().size(); ++i) {
    const StoredVariant& variant = other.variants()[i];
    const StoredVariant& same = first.variants()[i];
    require("variant", variant.name, same.name);
    if (variant.scenario_text != same.scenario_text || variant.plant_digest != same.plant_digest) {
      throw InputError({.file = folder,
                        .key = "variant " + variant.name,
                        .found = "another scenario or vehicle",
                        .expected = "that of the other shards"});
    }
  }
}

/// Refuses folders that are not each shard once.
void require_all_shards(const std::vector<std::string>& folders,
                        const std::vector<std::unique_ptr<StoreReader>>& shards) {
  const std::int64_t count = shards.front()->campaign().shard.count;
  for (std::int64_t index = 1; index <= count; ++index) {
    std::vector<std::string> of_index;
    for (std::size_t i = 0; i < shards.size(); ++i) {
      if (shards[i]->campaign().shard.index == index) of_index.push_back(folders[i]);
    }
    const std::string shard = shard_text({.index = index, .count = count});
    if (of_index.empty()) {
      throw InputError({.found = fmt::format("{} folders without {}", folders.size(), shard),
                        .expected = fmt::format("each of {} shards once", count)});
    }
    if (of_index.size() > 1) {
      throw InputError({.file = of_index[1],
                        .found = shard + ", which " + of_index[0] + " holds, too",
                        .expected = fmt::format("each of {} shards once", count)});
    }
  }
}

/// A path as a URI that opens the file for reading only.
std::string read_only_uri(const std::string& path) {
  std::string uri = "file:";
  for (const char c : path) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '/' || c == '.' ||
                       c == '_' || c == '-';
    uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri + "?mode=ro";
}

/// Columns of a table but the first, which is the variant.
std::string columns_of(SQLite::Database& database, const std::string& table) {
  SQLite::Statement info(database, "SELECT name FROM pragma_table_info(?) WHERE name <> 'variant'");
  info.bind(1, table);
  std::string columns;
  while (info.executeStep()) columns += ", " + info.getColumn(0).getString();
  return columns;
}

/// Copies the rows of the shard in `folder`. Variants may be numbered differently there.
void add_rows(SQLite::Database& database, const std::string& folder) {
  SQLite::Statement attach(database, "ATTACH ? AS shard");
  attach.bind(1, read_only_uri(folder + "/" + kStoreFile));
  attach.exec();
  {
    SQLite::Statement twice(database,
                            "SELECT s.name, e.seed FROM shard.episode e"
                            " JOIN shard.variant s ON s.id = e.variant"
                            " JOIN main.variant m ON m.name = s.name"
                            " JOIN main.episode o ON o.variant = m.id AND o.seed = e.seed LIMIT 1");
    if (twice.executeStep()) {
      throw InputError(
          {.file = folder,
           .found = fmt::format("variant {}, seed {}, which another shard has, too",
                                twice.getColumn(0).getString(), twice.getColumn(1).getInt64()),
           .expected = "each episode once"});
    }
  }
  SQLite::Transaction transaction(database);
  for (const char* table : kEpisodeTables) {
    const std::string columns = columns_of(database, table);
    database.exec(
        fmt::format("INSERT INTO main.{0} (variant{1}) SELECT m.id{1} FROM shard.{0} e JOIN "
                    "shard.variant s ON s.id = e.variant JOIN (SELECT id, name AS common FROM "
                    "main.variant) m ON m.common = s.name",
                    table, columns));
  }
  transaction.commit();
}

/// Refuses seeds of a variant that are not exactly the campaign's.
void require_all_seeds(SQLite::Database& database, const StoredVariant& variant,
                       const std::vector<std::uint64_t>& listed, const SeedSet& seeds) {
  SQLite::Statement statement(database, "SELECT seed FROM episode WHERE variant = ? ORDER BY seed");
  statement.bind(1, variant.id);
  const auto refuse = [&](const std::string& found) {
    throw InputError({.key = "variant " + variant.name,
                      .found = found,
                      .expected = "each seed of the campaign once; qsmpc campaign drives what is "
                                  "missing of a shard"});
  };
  for (std::int64_t i = 0; i < seeds.size(); ++i) {
    const std::uint64_t expected =
        listed.empty() ? seeds.at(i) : listed[static_cast<std::size_t>(i)];
    const bool more = statement.executeStep();
    const auto seed = more ? static_cast<std::uint64_t>(statement.getColumn(0).getInt64()) : 0;
    if (!more || seed > expected) refuse(fmt::format("no episode with seed {}", expected));
    if (seed < expected) refuse(fmt::format("an episode with the foreign seed {}", seed));
  }
  if (statement.executeStep()) {
    refuse(fmt::format("an episode with the foreign seed {}", statement.getColumn(0).getInt64()));
  }
}

/// Copies the traces that the shard in `folder` keeps; returns how many.
std::int64_t copy_traces(const StoreReader& shard, const std::string& folder,
                         const std::string& out) {
  std::int64_t copied = 0;
  for (const StoredVariant& variant : shard.variants()) {
    shard.for_each_episode(variant.id, [&](const EpisodeRow& row) {
      if (row.trace.empty()) return;
      make_durable_folder(out + "/" + row.trace, out);
      PendingFile file(out + "/" + row.trace + "/" + kTraceFile);
      const std::string source = folder + "/" + row.trace + "/" + kTraceFile;
      std::error_code error;
      fs::copy_file(source, file.partial_path(), fs::copy_options::overwrite_existing, error);
      if (error) throw IoError(source + ": cannot be copied: " + error.message());
      file.commit();
      ++copied;
    });
  }
  return copied;
}

std::int64_t write_store(const std::string& path, const std::vector<std::string>& folders,
                         const StoreReader& first) {
  SQLite::Database database(path, SQLite::OPEN_READWRITE | SQLite::OPEN_URI, kStorePatience);
  // Until it has its name, nobody needs it: no log is kept of what is done to it.
  database.exec("PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF");
  migrate(database, 0, store_migrations());
  const SeedSet seeds = seeds_from_text(first.campaign().seeds);
  std::vector<std::uint64_t> sorted = seeds.listed;
  std::ranges::sort(sorted);
  StoredCampaign campaign = first.campaign();
  campaign.shard = {};
  campaign.episodes = std::ssize(first.variants()) * seeds.size();
  insert_campaign(database, campaign);
  for (std::size_t i = 0; i < first.variants().size(); ++i) {
    insert_variant(database, first.variants()[i], static_cast<std::int64_t>(i));
  }
  for (const std::string& folder : folders) {
    add_rows(database, folder);
    database.exec("DETACH shard");
  }
  for (const StoredVariant& variant : first.variants()) {
    require_all_seeds(database, variant, sorted, seeds);
  }
  return campaign.episodes;
}

}  // namespace

MergeResult merge_shards(const std::vector<std::string>& folders, const std::string& out) {
  if (folders.empty()) throw InputError({.found = "no folder", .expected = "those of the shards"});
  std::vector<std::unique_ptr<StoreReader>> shards;
  for (const std::string& folder : folders) {
    shards.push_back(std::make_unique<StoreReader>(folder));
    shards.back()->verify();
    require_same(*shards.front(), *shards.back(), folder);
  }
  require_all_shards(folders, shards);
  make_output_folder(out);
  const FolderLock lock(out);
  const std::string path = out + "/" + kStoreFile;
  std::error_code ignored;
  if (fs::exists(path, ignored)) {
    throw InputError(
        {.file = path, .found = "a campaign", .expected = "a folder that holds none yet"});
  }
  MergeResult result;
  PendingFile store(path);
  with_store_errors(
      path, [&] { result.episodes = write_store(store.partial_path(), folders, *shards.front()); });
  for (std::size_t i = 0; i < folders.size(); ++i) {
    result.traces += copy_traces(*shards[i], folders[i], out);
  }
  store.commit();
  return result;
}

}  // namespace qsmpc::harness
