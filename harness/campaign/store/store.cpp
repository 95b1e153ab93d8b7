#include "harness/campaign/store/store.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <mutex>
#include <unordered_set>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include "harness/campaign/store/store_rows.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/version.hpp"

namespace qsmpc::harness {
namespace {

// The SQLite VFS without file locks.
constexpr const char* kNoLocks = "unix-none";

/// The first difference, with the value in the store and the one expected by the campaign.
struct Difference {
  std::string key;
  std::string found;
  std::string expected;
};

/// The first line in which two texts differ.
Difference first_line_that_differs(const std::string& stored, const std::string& asked) {
  const auto line = [](const std::string& text, std::size_t begin) {
    return text.substr(begin, text.find('\n', begin) - begin);
  };
  std::size_t at = 0;
  while (at < stored.size() && at < asked.size() && line(stored, at) == line(asked, at)) {
    at += line(stored, at).size() + 1;
  }
  return {.key = "",
          .found = at < stored.size() ? line(stored, at) : "nothing",
          .expected = at < asked.size() ? line(asked, at) : "nothing"};
}

std::optional<Difference> difference_of(const StoredVariant& stored, const StoredVariant& asked) {
  const std::string key = "variant " + stored.name;
  if (stored.name != asked.name) {
    return Difference{.key = "variant", .found = stored.name, .expected = asked.name};
  }
  if (stored.scenario_text != asked.scenario_text) {
    Difference line = first_line_that_differs(stored.scenario_text, asked.scenario_text);
    line.key = key;
    return line;
  }
  if (stored.plant_digest != asked.plant_digest) {
    return Difference{.key = key,
                      .found = "a vehicle with the digest " + stored.plant_digest,
                      .expected = "one with " + asked.plant_digest + ": its file has changed"};
  }
  return std::nullopt;
}

std::optional<Difference> difference_of(const StoredCampaign& stored, const StoredCampaign& asked) {
  const auto shard = [](const Shard& part) { return fmt::format("{}/{}", part.index, part.count); };
  if (stored.name != asked.name) return Difference{"name", stored.name, asked.name};
  if (stored.version != asked.version) {
    return Difference{"version", "qsmpc " + stored.version, "qsmpc " + asked.version};
  }
  if (stored.seeds != asked.seeds) return Difference{"seeds", stored.seeds, asked.seeds};
  if (stored.until != asked.until) {
    return Difference{"until", until_text(stored.until), until_text(asked.until)};
  }
  if (stored.traces != asked.traces) return Difference{"traces", stored.traces, asked.traces};
  if (stored.rare != asked.rare) return Difference{"rare", stored.rare, asked.rare};
  if (stored.shard != asked.shard) {
    return Difference{"--shard", shard(stored.shard), shard(asked.shard)};
  }
  return std::nullopt;
}

std::optional<Difference> difference_of(const std::vector<StoredVariant>& stored,
                                        const std::vector<StoredVariant>& asked) {
  if (stored.size() != asked.size()) {
    return Difference{"variants", fmt::format("{} of them", stored.size()),
                      fmt::format("{}", asked.size())};
  }
  for (std::size_t i = 0; i < asked.size(); ++i) {
    if (auto difference = difference_of(stored[i], asked[i])) return difference;
  }
  return std::nullopt;
}

std::optional<Difference> difference_of(const CampaignIdentity& stored,
                                        const CampaignIdentity& asked) {
  const auto difference = difference_of(stored.campaign, asked.campaign);
  return difference ? difference : difference_of(stored.variants, asked.variants);
}

/// The set of a shard's seeds, as stored.
class ShardSeeds {
 public:
  ShardSeeds(const SeedSet& seeds, const Shard& shard) : seeds_(seeds), shard_(shard) {
    for (std::size_t i = 0; i < seeds.listed.size(); ++i) {
      if (shard.has(static_cast<std::int64_t>(i))) listed_.insert(stored_seed(seeds.listed[i]));
    }
  }

  [[nodiscard]] bool contains(std::int64_t seed) const {
    if (!seeds_.listed.empty()) return listed_.contains(seed);
    const std::int64_t index = seed - stored_seed(seeds_.first);
    return index >= 0 && index < seeds_.count && shard_.has(index);
  }

 private:
  const SeedSet& seeds_;
  Shard shard_;
  std::unordered_set<std::int64_t> listed_;
};

std::int64_t count_episodes(SQLite::Database& database) {
  return database.execAndGet("SELECT count(*) FROM episode").getInt64();
}

}  // namespace

StoredCampaign stored_campaign(const Campaign& campaign, const Shard& shard) {
  return {.name = campaign.name,
          .version = kVersion,
          .seeds = seeds_text(campaign.seeds),
          .traces = traces_text(campaign),
          .shard = shard,
          .episodes = static_cast<std::int64_t>(campaign.variants.size()) *
                      shard.share(campaign.seeds.size()),
          .risk_against_cost = campaign.risk_against_cost,
          .until = campaign.until,
          .rare = rare_text(campaign)};
}

std::vector<StoredVariant> stored_variants(const Campaign& campaign,
                                           const std::vector<std::string>& digests) {
  std::vector<StoredVariant> variants;
  for (std::size_t i = 0; i < campaign.variants.size(); ++i) {
    const CampaignVariant& variant = campaign.variants[i];
    variants.push_back({.id = static_cast<std::int64_t>(i),
                        .name = variant.name,
                        .scenario = variant.scenario,
                        .settings = variant.settings,
                        .plant = variant.plant,
                        .scenario_text = to_yaml(variant.resolved),
                        .plant_digest = digests.at(i)});
  }
  return variants;
}

void refuse_other_campaign(const std::string& path, const CampaignIdentity& stored,
                           const CampaignIdentity& asked, const std::string& remedy) {
  const std::optional<Difference> difference = difference_of(stored, asked);
  if (!difference) return;
  throw InputError({.file = path,
                    .key = difference->key,
                    .found = difference->found,
                    .expected = difference->expected + remedy});
}

struct Store::Implementation {
  Implementation(std::string file, StoreUse use)
      : path(std::move(file)),
        database(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kStorePatience,
                 use == StoreUse::kAlone ? kNoLocks : "") {
    // Must precede the first use of the log, so that its index stays in this process's memory.
    if (use == StoreUse::kAlone) database.exec("PRAGMA locking_mode = EXCLUSIVE");
    // Checked before anything is written, in case the file is not one of ours.
    const int schema = schema_of(database, path);
    refuse_newer(schema, path);
    // With the log, a commit is a single append, and others can read meanwhile; each commit waits
    // until it is on disk.
    database.exec("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL");
    migrate(database, schema, store_migrations());
    // Frees the space of the former per-period rows.
    if (schema > 0 && schema < kPeriodsSchemaNumber) database.exec("VACUUM");
  }

  [[nodiscard]] bool holds_campaign() {
    return database.execAndGet("SELECT count(*) FROM campaign").getInt() > 0;
  }

  void fill(const StoredCampaign& campaign, const std::vector<StoredVariant>& variants) {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    insert_campaign(database, campaign);
    for (std::size_t i = 0; i < variants.size(); ++i) {
      insert_variant(database, variants[i], static_cast<std::int64_t>(i));
    }
    transaction.commit();
  }

  /// Removes the episodes of a variant whose seeds satisfy `goes`, and records them in `update`.
  template <class Goes>
  void drop(std::int64_t variant, const Goes& goes, StoreUpdate& update) {
    std::vector<std::int64_t> seeds;
    {
      SQLite::Statement statement(database, "SELECT seed, trace FROM episode WHERE variant = ?");
      statement.bind(1, variant);
      while (statement.executeStep()) {
        const std::int64_t seed = statement.getColumn(0).getInt64();
        if (!goes(seed)) continue;
        seeds.push_back(seed);
        const std::string trace = statement.getColumn(1).getString();
        if (!trace.empty()) update.traces.push_back(trace);
      }
    }
    for (const std::int64_t seed : seeds) {
      delete_episode(database, variant, static_cast<std::uint64_t>(seed));
    }
    update.dropped += std::ssize(seeds);
  }

  /// Turns the store into that of another campaign, keeping the episodes that both have.
  void change(const StoredCampaign& campaign, const std::vector<StoredVariant>& asked,
              const SeedSet& seeds) {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    std::vector<StoredVariant> kept;
    const ShardSeeds mine(seeds, campaign.shard);
    for (const StoredVariant& stored : read_variants(database)) {
      const auto same = std::ranges::find(asked, stored.name, &StoredVariant::name);
      if (same != asked.end() && !difference_of(stored, *same)) {
        drop(
            stored.id, [&](std::int64_t seed) { return !mine.contains(seed); }, changes);
        kept.push_back(stored);
      } else {
        drop(
            stored.id, [](std::int64_t) { return true; }, changes);
      }
    }
    database.exec("DELETE FROM variant");
    std::int64_t next = 0;
    for (const StoredVariant& variant : kept) next = std::max(next, variant.id + 1);
    for (std::size_t i = 0; i < asked.size(); ++i) {
      const auto known = std::ranges::find(kept, asked[i].name, &StoredVariant::name);
      StoredVariant variant = asked[i];
      variant.id = known != kept.end() ? known->id : next++;
      insert_variant(database, variant, static_cast<std::int64_t>(i));
    }
    insert_campaign(database, campaign);
    changes.changed = true;
    changes.kept = count_episodes(database);
    transaction.commit();
  }

  std::string path;
  SQLite::Database database;
  std::mutex mutex{};
  StoreUpdate changes{};
  std::optional<EpisodeWriter> writer{};  ///< created when the first episode is added
  std::vector<std::int64_t> ids{};
};

Store::Store(const std::string& folder, const StoredCampaign& campaign,
             const std::vector<StoredVariant>& variants, const SeedSet& seeds, bool update,
             StoreUse use) {
  const std::string path = folder + "/" + kStoreFile;
  with_store_errors(path, [&] {
    implementation_ = std::make_unique<Implementation>(path, use);
    SQLite::Database& database = implementation_->database;
    if (!implementation_->holds_campaign()) {
      implementation_->fill(campaign, variants);
    } else {
      const CampaignIdentity stored{read_campaign(database), read_variants(database)};
      const CampaignIdentity asked{campaign, variants};
      const bool differs = difference_of(stored, asked).has_value();
      if (differs && !update) {
        refuse_other_campaign(path, stored, asked,
                              "; --update continues with the changed campaign and keeps the "
                              "episodes that it still asks for");
      }
      if (differs) {
        implementation_->change(campaign, variants, seeds);
      } else if (stored.campaign.risk_against_cost != campaign.risk_against_cost) {
        SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
        insert_campaign(database, campaign);
        transaction.commit();
      }
    }
    for (const StoredVariant& variant : read_variants(database)) {
      implementation_->ids.push_back(variant.id);
    }
  });
}

Store::~Store() = default;

const StoreUpdate& Store::update() const { return implementation_->changes; }

const std::vector<std::int64_t>& Store::variant_ids() const { return implementation_->ids; }

std::optional<std::string> Store::outcome(std::int64_t variant, std::uint64_t seed) const {
  std::optional<std::string> outcome;
  const std::lock_guard lock(implementation_->mutex);
  with_store_errors(implementation_->path, [&] {
    SQLite::Statement statement(
        implementation_->database,
        "SELECT " + outcome_column() + " FROM episode WHERE variant = ? AND seed = ?");
    statement.bind(1, variant);
    statement.bind(2, stored_seed(seed));
    if (statement.executeStep()) outcome = statement.getColumn(0).getString();
  });
  return outcome;
}

std::map<std::string, std::int64_t> Store::outcomes() const {
  std::map<std::string, std::int64_t> outcomes;
  const std::lock_guard lock(implementation_->mutex);
  with_store_errors(implementation_->path,
                    [&] { outcomes = count_outcomes(implementation_->database); });
  return outcomes;
}

void Store::add(const EpisodeRow& row, bool replace) {
  const std::lock_guard lock(implementation_->mutex);
  with_store_errors(implementation_->path, [&] {
    SQLite::Database& database = implementation_->database;
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    if (replace) delete_episode(database, row.variant, row.seed);
    if (!implementation_->writer) implementation_->writer.emplace(database);
    implementation_->writer->add(row);
    transaction.commit();
  });
}

void Store::for_each_outcome(
    const std::function<void(std::int64_t variant, std::uint64_t seed, const std::string& outcome,
                             bool unsafe)>& visit) const {
  const std::lock_guard lock(implementation_->mutex);
  with_store_errors(implementation_->path, [&] {
    SQLite::Statement statement(
        implementation_->database,
        "SELECT variant, seed, " + outcome_column() + ", unsafe FROM episode");
    while (statement.executeStep()) {
      visit(statement.getColumn(0).getInt64(),
            static_cast<std::uint64_t>(statement.getColumn(1).getInt64()),
            statement.getColumn(2).getString(), statement.getColumn(3).getInt() != 0);
    }
  });
}

std::vector<std::string> Store::stop_after(const SeedSet& seeds, std::int64_t count) {
  SeedSet kept = seeds;
  if (seeds.listed.empty()) {
    kept.count = count;
  } else {
    kept.listed.resize(static_cast<std::size_t>(count));
  }
  std::vector<std::string> traces;
  const std::lock_guard lock(implementation_->mutex);
  with_store_errors(implementation_->path, [&] {
    SQLite::Database& database = implementation_->database;
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    StoredCampaign campaign = read_campaign(database);
    campaign.stopped_after = count;
    campaign.episodes = std::ssize(implementation_->ids) * count;
    insert_campaign(database, campaign);
    const ShardSeeds mine(kept, {});
    StoreUpdate dropped;
    for (const std::int64_t variant : implementation_->ids) {
      implementation_->drop(
          variant, [&](std::int64_t seed) { return !mine.contains(seed); }, dropped);
    }
    traces = std::move(dropped.traces);
    transaction.commit();
  });
  return traces;
}

void Store::fold() {
  const std::lock_guard lock(implementation_->mutex);
  with_store_errors(implementation_->path, [&] {
    SQLite::Database& database = implementation_->database;
    database.setBusyTimeout(0);  // do not wait for readers
    try {
      (void)database.execAndGet("PRAGMA wal_checkpoint(TRUNCATE)");
      database.exec("PRAGMA journal_mode = DELETE");
    } catch (const SQLite::Exception& error) {
      // The store has readers: the log stays until the last of them is gone.
      constexpr int kBusy = 5;
      constexpr int kLocked = 6;
      if (error.getErrorCode() != kBusy && error.getErrorCode() != kLocked) throw;
    }
    database.setBusyTimeout(kStorePatience);
  });
}

}  // namespace qsmpc::harness
