#include "harness/campaign/store/joined_store.hpp"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <limits>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/campaign/store/store_rows.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/errors.hpp"

namespace qsmpc::harness {
namespace {

// KiB; holds the pages of the episodes that are added at a time.
constexpr int kJoinedCacheSize = 196'608;

/// A URI that opens the file at `path` read-only.
std::string read_only_uri(const std::string& path) {
  std::string uri = "file:";
  for (const char c : path) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '/' || c == '.' ||
                       c == '_' || c == '-';
    uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri + "?mode=ro";
}

/// The columns of a table except those in `without`.
std::vector<std::string> columns_of(SQLite::Database& database, const std::string& table,
                                    std::initializer_list<std::string> without) {
  SQLite::Statement info(database, "SELECT name FROM pragma_table_info(?)");
  info.bind(1, table);
  std::vector<std::string> columns;
  while (info.executeStep()) {
    const std::string name = info.getColumn(0).getString();
    if (std::ranges::find(without, name) == without.end()) columns.push_back(name);
  }
  return columns;
}

/// Attaches a store, and detaches it on destruction.
class Attached {
 public:
  Attached(SQLite::Database& database, const std::string& folder) : database_(database) {
    SQLite::Statement attach(database, "ATTACH ? AS shard");
    attach.bind(1, read_only_uri(folder + "/" + kStoreFile));
    attach.exec();
  }
  ~Attached() { (void)database_.tryExec("DETACH shard"); }
  Attached(const Attached&) = delete;
  Attached& operator=(const Attached&) = delete;

 private:
  SQLite::Database& database_;
};

/// The bounds at which the seeds, as stored, fall into `parts` equal parts.
std::vector<std::int64_t> seed_bounds(const SeedSet& seeds, std::int64_t parts) {
  std::vector<std::uint64_t> listed = seeds.listed;
  std::ranges::sort(listed, {}, [](std::uint64_t seed) { return static_cast<std::int64_t>(seed); });
  const SeedSet sorted{.first = seeds.first, .count = seeds.count, .listed = listed};
  std::vector<std::int64_t> bounds;
  for (std::int64_t part = 1; part < parts; ++part) {
    bounds.push_back(static_cast<std::int64_t>(sorted.at(part * sorted.size() / parts)));
  }
  std::ranges::sort(bounds);
  return bounds;
}

}  // namespace

std::vector<KeyRange> key_ranges(std::int64_t variants, const SeedSet& seeds,
                                 std::int64_t episodes) {
  using Limits = std::numeric_limits<std::int64_t>;
  const auto parts_of = [&](std::int64_t count) { return (count + episodes - 1) / episodes; };
  const std::int64_t parts = std::min(parts_of(seeds.size()), seeds.size());
  const std::int64_t together = std::max<std::int64_t>(1, episodes / seeds.size());
  const std::vector<std::int64_t> bounds = seed_bounds(seeds, parts);
  std::vector<KeyRange> ranges;
  for (std::int64_t first = 0; first < variants; first += together) {
    KeyRange range{.first_variant = first,
                   .last_variant = std::min(first + together, variants) - 1,
                   .first_seed = Limits::min(),
                   .last_seed = Limits::max()};
    for (const std::int64_t bound : bounds) {
      if (bound == range.first_seed) continue;
      range.last_seed = bound - 1;
      ranges.push_back(range);
      range.first_seed = bound;
      range.last_seed = Limits::max();
    }
    ranges.push_back(range);
  }
  return ranges;
}

JoinedStore::JoinedStore(const std::string& path, const StoredCampaign& campaign,
                         const std::vector<StoredVariant>& variants)
    : database_(path, SQLite::OPEN_READWRITE | SQLite::OPEN_URI | SQLite::OPEN_NOMUTEX,
                kStorePatience) {
  // A partly written store is useless and has no final name yet, so neither a rollback journal nor
  // synchronous writes are needed.
  database_.exec("PRAGMA page_size = 16384; PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF");
  database_.exec(fmt::format("PRAGMA cache_size = -{}", kJoinedCacheSize));
  migrate(database_, 0, store_migrations());
  insert_campaign(database_, campaign);
  for (std::size_t i = 0; i < variants.size(); ++i) {
    insert_variant(database_, variants[i], static_cast<std::int64_t>(i));
  }
}

void JoinedStore::add(const std::string& folder, const MergePolicy& policy, const KeyRange& range) {
  const Attached attached(database_, folder);
  const Part part{.variants = numbers(range), .range = range};
  if (policy.duplicates) {
    refuse_contradictions(part, folder);
  } else {
    refuse_duplicates(part, folder);
  }
  copy(part, policy.duplicates);
}

JoinedStore::Numbers JoinedStore::numbers(const KeyRange& range) {
  SQLite::Statement statement(database_,
                              "SELECT s.id, m.id FROM shard.variant s JOIN main.variant m ON "
                              "m.name = s.name WHERE m.id BETWEEN ? AND ? ORDER BY m.id");
  statement.bind(1, range.first_variant);
  statement.bind(2, range.last_variant);
  Numbers variants;
  while (statement.executeStep()) {
    variants.emplace_back(statement.getColumn(0).getInt64(), statement.getColumn(1).getInt64());
  }
  return variants;
}

/// The first of the part's variants for which `sql` returns a row, and the seed in that row.
std::optional<JoinedStore::Found> JoinedStore::first_row(const std::string& sql, const Part& part) {
  SQLite::Statement statement(database_, sql);
  statement.bind(3, part.range.first_seed);
  statement.bind(4, part.range.last_seed);
  for (const auto& [from, to] : part.variants) {
    statement.bind(1, from);
    statement.bind(2, to);
    if (statement.executeStep()) {
      const std::int64_t seed = statement.getColumn(0).getInt64();
      SQLite::Statement name(database_, "SELECT name FROM main.variant WHERE id = ?");
      name.bind(1, to);
      name.executeStep();
      return Found{.variant = name.getColumn(0).getString(), .seed = seed};
    }
    statement.reset();
  }
  return std::nullopt;
}

// SQLite takes the tables of a CROSS JOIN in the order given: the few rows of the added store
// first.
void JoinedStore::refuse_duplicates(const Part& part, const std::string& folder) {
  const std::optional<Found> twice = first_row(
      "SELECT e.seed FROM shard.episode e CROSS JOIN main.episode o ON o.variant = ?2 AND o.seed = "
      "e.seed WHERE e.variant = ?1 AND e.seed BETWEEN ?3 AND ?4 LIMIT 1",
      part);
  if (!twice) return;
  throw InputError({.file = folder,
                    .found = fmt::format("variant {}, seed {}, which another shard also has",
                                         twice->variant, twice->seed),
                    .expected = "each episode once"});
}

/// Refuses an episode that differs from the same episode of an earlier store.
void JoinedStore::refuse_contradictions(const Part& part, const std::string& folder) {
  for (const char* table : kEpisodeTables) {
    if (is_timing(table)) continue;
    // The name of a trace's folder contains the variant's number, which differs between stores.
    const std::vector<std::string> columns =
        columns_of(database_, table, {"variant", "seed", "trace"});
    const std::optional<Found> found = first_row(
        fmt::format(
            "SELECT e.seed FROM shard.{0} e CROSS JOIN main.{0} o ON o.variant = ?2 AND o.seed "
            "= e.seed WHERE e.variant = ?1 AND e.seed BETWEEN ?3 AND ?4 AND (e.{1}) IS NOT "
            "(o.{2}) LIMIT 1",
            table, fmt::join(columns, ", e."), fmt::join(columns, ", o.")),
        part);
    if (!found) continue;
    throw InputError({.file = folder,
                      .key = fmt::format("variant {}, seed {}", found->variant, found->seed),
                      .found = fmt::format(
                          "a row of table {} that differs from that of an earlier folder", table),
                      .expected = "the same episode, except for timings"});
  }
}

void JoinedStore::copy(const Part& part, bool ignore_duplicates) {
  SQLite::Transaction transaction(database_);
  for (const char* table : kEpisodeTables) {
    SQLite::Statement rows(
        database_,
        fmt::format("INSERT {2} INTO main.{0} (variant, {1}) SELECT ?2, {1} FROM shard.{0}"
                    " WHERE variant = ?1 AND seed BETWEEN ?3 AND ?4",
                    table, fmt::join(columns_of(database_, table, {"variant"}), ", "),
                    ignore_duplicates ? "OR IGNORE" : ""));
    rows.bind(3, part.range.first_seed);
    rows.bind(4, part.range.last_seed);
    for (const auto& [from, to] : part.variants) {
      rows.bind(1, from);
      rows.bind(2, to);
      rows.exec();
      rows.reset();
    }
  }
  transaction.commit();
}

}  // namespace qsmpc::harness
