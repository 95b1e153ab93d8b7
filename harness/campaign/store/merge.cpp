#include "harness/campaign/store/merge.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <system_error>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/store/folder_lock.hpp"
#include "harness/campaign/store/joined_store.hpp"
#include "harness/campaign/store/store_checksum.hpp"
#include "harness/campaign/store/store_reader.hpp"
#include "harness/campaign/store/store_rows.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/threads/workers.hpp"
#include "harness/trace/trace_file.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;

std::string shard_text(const Shard& shard) {
  return fmt::format("shard {}/{}", shard.index, shard.count);
}

/// "penalties: w2, w20; limits: r001", "none" without families.
std::string families_text(const std::vector<VariantFamily>& families) {
  std::string text;
  for (const VariantFamily& family : families) {
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", family.name,
                        fmt::join(family.settings, ", "));
  }
  return text.empty() ? "none" : text;
}

/// The properties of the stores to merge.
struct Joined {
  StoredCampaign campaign;
  std::vector<StoredVariant> variants;
  std::vector<Shard> shards;  ///< of each folder
};

/// Refuses `other` unless it is of the same campaign as `first`.
void require_same(const Joined& first, const StoreReader& other, const std::string& folder) {
  const auto require = [&](const std::string& key, const std::string& found,
                           const std::string& expected) {
    if (found != expected) {
      throw InputError({.file = folder, .key = key, .found = found, .expected = expected});
    }
  };
  const StoredCampaign& expected = first.campaign;
  const StoredCampaign& found = other.campaign();
  require("name", found.name, expected.name);
  require("version", found.version, expected.version);
  require("seeds", found.seeds, expected.seeds);
  require("traces", found.traces, expected.traces);
  require("until", until_text(found.until), until_text(expected.until));
  require("rare", found.rare, expected.rare);
  require("figure.risk_against_cost", families_text(found.risk_against_cost),
          families_text(expected.risk_against_cost));
  require("shards", fmt::format("{}", found.shard.count), fmt::format("{}", expected.shard.count));
  require("variants", fmt::format("{}", other.variants().size()),
          fmt::format("{}", first.variants.size()));
  for (std::size_t i = 0; i < first.variants.size(); ++i) {
    const StoredVariant& variant = other.variants()[i];
    const StoredVariant& same = first.variants[i];
    require("variant", variant.name, same.name);
    if (variant.scenario_text != same.scenario_text || variant.plant_digest != same.plant_digest) {
      throw InputError({.file = folder,
                        .key = "variant " + variant.name,
                        .found = "another scenario or vehicle",
                        .expected = "that of the other shards"});
    }
  }
}

/// Opens the stores one after the other and checks that they are of the same campaign.
Joined joined(const std::vector<std::string>& folders) {
  if (folders.empty()) throw InputError({.found = "no folder", .expected = "those of the shards"});
  Joined stores;
  for (const std::string& folder : folders) {
    const StoreReader store(folder);
    if (stores.shards.empty()) {
      stores.campaign = store.campaign();
      stores.variants = store.variants();
    } else {
      require_same(stores, store, folder);
    }
    stores.shards.push_back(store.campaign().shard);
  }
  return stores;
}

/// Refuses folders that are not each of the shards exactly once.
void require_all_shards(const std::vector<std::string>& folders, const Joined& stores) {
  const std::int64_t count = stores.campaign.shard.count;
  std::map<std::int64_t, std::string> folder_of;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const auto [first, is_new] = folder_of.try_emplace(stores.shards[i].index, folders[i]);
    if (is_new) continue;
    throw InputError(
        {.file = folders[i],
         .found = shard_text(stores.shards[i]) + ", which " + first->second + " also holds",
         .expected = fmt::format("each of {} shards once", count)});
  }
  for (std::int64_t index = 1; index <= count; ++index) {
    if (folder_of.contains(index)) continue;
    throw InputError({.found = fmt::format("{} folders without {}", folders.size(),
                                           shard_text({.index = index, .count = count})),
                      .expected = fmt::format("each of {} shards once", count)});
  }
}

/// Refuses folders that are not all of the same shard.
void require_one_shard(const std::vector<std::string>& folders, const Joined& stores) {
  for (std::size_t i = 0; i < folders.size(); ++i) {
    if (stores.shards[i] == stores.campaign.shard) continue;
    throw InputError({.file = folders[i],
                      .found = shard_text(stores.shards[i]),
                      .expected = shard_text(stores.campaign.shard) + ", like " + folders[0]});
  }
}

/// Refuses seeds of a variant that are not in the campaign, and unless `incomplete` also missing
/// seeds.
void require_seeds(SQLite::Database& database, const StoredVariant& variant,
                   const std::vector<std::uint64_t>& listed, const SeedSet& seeds,
                   bool incomplete) {
  SQLite::Statement statement(database, "SELECT seed FROM episode WHERE variant = ? ORDER BY seed");
  statement.bind(1, variant.id);
  const auto refuse = [&](const std::string& found) {
    throw InputError(
        {.key = "variant " + variant.name,
         .found = found,
         .expected =
             "each seed of the campaign once; qsmpc campaign drives a shard's missing episodes"});
  };
  std::optional<std::uint64_t> seed;
  const auto step = [&] {
    seed.reset();
    if (statement.executeStep()) {
      seed = static_cast<std::uint64_t>(statement.getColumn(0).getInt64());
    }
  };
  step();
  for (std::int64_t i = 0; i < seeds.size(); ++i) {
    const std::uint64_t expected =
        listed.empty() ? seeds.at(i) : listed[static_cast<std::size_t>(i)];
    if (incomplete && !seed) return;
    if (seed && *seed < expected) break;
    if (seed == expected) {
      step();
    } else if (!incomplete) {
      refuse(fmt::format("no episode with seed {}", expected));
    }
  }
  if (seed)
    refuse(fmt::format("an episode with seed {}, which is not one of the campaign's", *seed));
}

/// Folds the log of a store that will be replaced into its file: a leftover log would be taken for
/// the new store's.
void fold_store(const std::string& path) {
  with_store_errors(path, [&] {
    SQLite::Database database(path, SQLite::OPEN_READWRITE, kStorePatience);
    database.exec("PRAGMA journal_mode = DELETE");
  });
}

/// Copies the file `name` of an episode from folder `from` to folder `to`.
void copy_episode_file(const std::string& from, const std::string& to, const std::string& name) {
  const std::string source = from + "/" + name;
  PendingFile file(to + "/" + name);
  std::error_code error;
  fs::copy_file(source, file.partial_path(), fs::copy_options::overwrite_existing, error);
  if (error) throw IoError(source + ": cannot be copied: " + error.message());
  file.commit();
}

/// Copies the kept traces of the store in `folder` unless they exist in `out`; returns how many
/// were copied.
std::int64_t copy_traces(const std::string& folder, const std::string& out) {
  const StoreReader store(folder);
  std::int64_t copied = 0;
  store.for_each_trace([&](const std::string& trace) {
    const std::string from = folder + "/" + trace;
    const std::string to = out + "/" + trace;
    std::error_code ignored;
    if (fs::exists(to + "/" + kTraceFile, ignored)) return;
    make_durable_folder(to, out);
    if (fs::exists(from + "/" + kControllerLog, ignored)) {
      copy_episode_file(from, to, kControllerLog);
    }
    copy_episode_file(from, to, kTraceFile);
    ++copied;
  });
  return copied;
}

/// Refuses a store with an episode that fails its checksum; names the damaged one of the source
/// folders.
void refuse_damage(const std::string& path, const std::vector<std::string>& folders) {
  const std::optional<StoredEpisode> damaged = damaged_episode(path, available_threads());
  if (!damaged) return;
  for (const std::string& folder : folders) StoreReader(folder).verify();
  throw IoError(fmt::format("{}: the rows of variant {}, seed {} changed while they were copied",
                            path, damaged->variant + 1, damaged->seed));
}

std::int64_t write_store(const std::string& path, const std::vector<std::string>& folders,
                         const Joined& stores, const StoredCampaign& campaign,
                         const MergePolicy& policy) {
  JoinedStore store(path, campaign, stores.variants);
  const SeedSet seeds = seeds_from_text(campaign.seeds);
  for (const KeyRange& range :
       key_ranges(std::ssize(stores.variants), seeds, policy.episodes_at_a_time)) {
    for (const std::string& folder : folders) {
      with_store_errors(folder + "/" + kStoreFile, [&] { store.add(folder, policy, range); });
    }
  }
  std::vector<std::uint64_t> sorted = seeds.listed;
  std::ranges::sort(sorted);
  for (const StoredVariant& variant : read_variants(store.database())) {
    require_seeds(store.database(), variant, sorted, seeds, policy.incomplete);
  }
  refuse_damage(path, folders);
  return store.database().execAndGet("SELECT count(*) FROM episode").getInt64();
}

/// Merges compatible stores as `campaign`.
MergeResult merge(const std::vector<std::string>& folders, const std::string& out,
                  const Joined& stores, const StoredCampaign& campaign, const MergePolicy& policy) {
  make_output_folder(out);
  const FolderLock lock(out);
  const std::string path = out + "/" + kStoreFile;
  std::error_code ignored;
  if (!policy.replace && fs::exists(path, ignored)) {
    throw InputError(
        {.file = path, .found = "a campaign", .expected = "a folder that holds none yet"});
  }
  if (fs::exists(path, ignored)) fold_store(path);
  MergeResult result{.asked = campaign.episodes};
  PendingFile store(path);
  with_store_errors(path, [&] {
    result.episodes = write_store(store.partial_path(), folders, stores, campaign, policy);
  });
  for (const std::string& folder : folders) result.traces += copy_traces(folder, out);
  store.commit();
  return result;
}

}  // namespace

MergeResult merge_stores(const std::vector<std::string>& folders, const std::string& out,
                         const MergePolicy& policy) {
  const Joined stores = joined(folders);
  require_one_shard(folders, stores);
  return merge(folders, out, stores, stores.campaign, policy);
}

MergeResult merge_shards(const std::vector<std::string>& folders, const std::string& out) {
  const Joined stores = joined(folders);
  require_all_shards(folders, stores);
  StoredCampaign campaign = stores.campaign;
  campaign.shard = {};
  campaign.episodes = std::ssize(stores.variants) * seeds_from_text(campaign.seeds).size();
  return merge(folders, out, stores, campaign, {});
}

}  // namespace qsmpc::harness
