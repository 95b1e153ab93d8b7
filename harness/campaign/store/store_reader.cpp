#include "harness/campaign/store/store_reader.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string_view>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include "harness/campaign/rare/rare_rows.hpp"
#include "harness/campaign/store/store_checksum.hpp"
#include "harness/campaign/store/store_periods.hpp"
#include "harness/campaign/store/store_rows.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/errors.hpp"
#include "harness/files/text_file.hpp"
#include "harness/text/printable.hpp"
#include "harness/threads/workers.hpp"

namespace qsmpc::harness {
namespace {

std::string existing_store(const std::string& folder) {
  std::string path = folder + "/" + kStoreFile;
  if (is_file(path)) return path;
  throw InputError({.file = path,
                    .found = "no campaign store",
                    .expected = "the folder that qsmpc campaign writes"});
}

const char* column_of(EpisodeNumber number) {
  switch (number) {
    case EpisodeNumber::kCost:
      return "cost";
    case EpisodeNumber::kMinClearance:
      return "min_clearance";
    case EpisodeNumber::kTimeToTarget:
      return "time_to_target";
  }
  throw std::invalid_argument("store: not a column");
}

/// Valid until the statement's next step.
std::string_view text_in(const SQLite::Column& column) {
  return {column.getText(), static_cast<std::size_t>(column.getBytes())};
}

std::string episodes_by_seed() {
  return "SELECT " + episode_columns("e", "t") +
         " FROM episode e JOIN episode_timing t USING (variant, seed)"
         " WHERE e.variant = ? ORDER BY e.seed";
}

/// Iterates over the episodes of a variant by seed.
class EpisodeCursor {
 public:
  EpisodeCursor(SQLite::Database& database, std::int64_t variant)
      : statement_(database, episodes_by_seed()) {
    statement_.bind(1, variant);
    next();
  }

  /// nullptr after the last one.
  [[nodiscard]] const EpisodeRow* row() const { return is_there_ ? &row_ : nullptr; }
  [[nodiscard]] const EpisodeRow* row_of(std::uint64_t seed) const {
    return is_there_ && row_.seed == seed ? &row_ : nullptr;
  }
  void next() {
    is_there_ = statement_.executeStep();
    if (is_there_) row_ = episode_of(statement_);
  }

 private:
  SQLite::Statement statement_;
  EpisodeRow row_{};
  bool is_there_ = false;
};

SQLite::Database open_database(const std::string& path) {
  SQLite::Database database = open_store_to_read(path);
  // All reads in the transaction see the snapshot taken by the first one.
  database.exec("BEGIN");
  return database;
}

}  // namespace

struct StoreReader::Implementation {
  explicit Implementation(const std::string& folder)
      : path(existing_store(folder)), database(open_database(path)) {
    const int schema = schema_of(database, path);
    refuse_newer(schema, path);
    if (schema < store_schema()) {
      throw InputError({.file = path,
                        .found = fmt::format("a store of the older schema {}", schema),
                        .expected = fmt::format(
                            "schema {}; start qsmpc campaign on the folder again to update it",
                            store_schema())});
    }
    campaign = read_campaign(database);
    variants = read_variants(database);
  }

  /// Calls `visit` on every row of `sql` with the parameters `values`.
  void each(const std::string& sql, const std::vector<std::int64_t>& values,
            const std::function<void(SQLite::Statement&)>& visit) {
    with_store_errors(path, [&] {
      SQLite::Statement statement(database, sql);
      for (std::size_t i = 0; i < values.size(); ++i) {
        statement.bind(static_cast<int>(i) + 1, values[i]);
      }
      while (statement.executeStep()) visit(statement);
    });
  }

  std::string path;
  SQLite::Database database;
  StoredCampaign campaign;
  std::vector<StoredVariant> variants;
};

StoreReader::StoreReader(const std::string& folder) {
  with_store_errors(folder + "/" + kStoreFile,
                    [&] { implementation_ = std::make_unique<Implementation>(folder); });
}

StoreReader::~StoreReader() = default;

void StoreReader::verify() const {
  std::optional<StoredEpisode> damaged;
  with_store_errors(implementation_->path,
                    [&] { damaged = damaged_episode(implementation_->path, available_threads()); });
  if (!damaged) return;
  throw IoError(
      fmt::format("{}: the rows of variant {}, seed {} differ from those that were written: the "
                  "file is damaged; use a copy, or run the campaign again",
                  printable(implementation_->path, 400), damaged->variant + 1, damaged->seed));
}

const StoredCampaign& StoreReader::campaign() const { return implementation_->campaign; }

const std::vector<StoredVariant>& StoreReader::variants() const {
  return implementation_->variants;
}

std::map<std::string, std::int64_t> StoreReader::outcomes() const {
  std::map<std::string, std::int64_t> outcomes;
  with_store_errors(implementation_->path,
                    [&] { outcomes = count_outcomes(implementation_->database); });
  return outcomes;
}

std::int64_t StoreReader::finished_since(double time) const {
  std::int64_t count = 0;
  // finished_at is compared as a number, so the time is inserted as a literal.
  implementation_->each(
      fmt::format("SELECT count(*) FROM episode_timing WHERE finished_at >= {:.6f}", time), {},
      [&](SQLite::Statement& row) { count = row.getColumn(0).getInt64(); });
  return count;
}

void StoreReader::for_each_episode(std::int64_t variant,
                                   const std::function<void(const EpisodeRow&)>& visit) const {
  implementation_->each(episodes_by_seed(), {variant},
                        [&](SQLite::Statement& row) { visit(episode_of(row)); });
}

void StoreReader::for_each_pair(
    std::int64_t first, std::int64_t second,
    const std::function<void(const EpisodeRow&, const EpisodeRow&)>& visit) const {
  implementation_->each("SELECT " + episode_columns("a", "at") + ", " + episode_columns("b", "bt") +
                            " FROM episode a JOIN episode b ON b.variant = ?2 AND b.seed = a.seed"
                            " JOIN episode_timing at ON at.variant = a.variant AND at.seed = a.seed"
                            " JOIN episode_timing bt ON bt.variant = b.variant AND bt.seed = b.seed"
                            " WHERE a.variant = ?1 ORDER BY a.seed",
                        {first, second}, [&](SQLite::Statement& row) {
                          visit(episode_of(row), episode_of(row, kEpisodeColumns));
                        });
}

void StoreReader::for_each_seed(
    const std::vector<std::int64_t>& variants,
    const std::function<void(std::uint64_t seed, const std::vector<const EpisodeRow*>&)>& visit)
    const {
  with_store_errors(implementation_->path, [&] {
    std::vector<std::unique_ptr<EpisodeCursor>> cursors;
    cursors.reserve(variants.size());
    for (const std::int64_t variant : variants) {
      cursors.push_back(std::make_unique<EpisodeCursor>(implementation_->database, variant));
    }
    std::vector<const EpisodeRow*> rows(variants.size());
    while (true) {
      std::optional<std::uint64_t> seed;
      for (const auto& cursor : cursors) {
        if (cursor->row() != nullptr)
          seed = std::min(seed.value_or(cursor->row()->seed), cursor->row()->seed);
      }
      if (!seed) return;
      for (std::size_t v = 0; v < cursors.size(); ++v) rows[v] = cursors[v]->row_of(*seed);
      visit(*seed, rows);
      for (std::size_t v = 0; v < cursors.size(); ++v) {
        if (rows[v] != nullptr) cursors[v]->next();
      }
    }
  });
}

void StoreReader::for_each_period(std::int64_t variant,
                                  const std::function<void(std::uint64_t seed, std::int64_t period,
                                                           const PeriodRow&)>& visit) const {
  std::vector<PeriodRow> periods;
  std::vector<double> times;
  implementation_->each(
      "SELECT p.seed, p.certificates, p.unsafe, t.ocp_ms FROM episode_periods p"
      " JOIN episode_ocp_ms t USING (variant, seed) WHERE p.variant = ? ORDER BY p.seed",
      {variant}, [&](SQLite::Statement& row) {
        read_periods(text_in(row.getColumn(1)), text_in(row.getColumn(2)), periods);
        read_ocp_ms(text_in(row.getColumn(3)), times);
        if (times.size() != periods.size()) {
          throw SQLite::Exception("an episode with different numbers of periods and times");
        }
        const auto seed = static_cast<std::uint64_t>(row.getColumn(0).getInt64());
        for (std::size_t k = 0; k < periods.size(); ++k) {
          periods[k].ocp_ms = times[k];
          visit(seed, static_cast<std::int64_t>(k), periods[k]);
        }
      });
}

void StoreReader::for_each_path(
    std::int64_t variant, std::int64_t most,
    const std::function<void(const std::string& outcome, const std::vector<PathPoint>& path)>&
        visit) const {
  implementation_->each(
      fmt::format("SELECT {}, p.points FROM episode e JOIN path p USING (variant, seed)"
                  " WHERE e.variant = ? ORDER BY e.outcome = 'reached' AND NOT e.unsafe, e.seed"
                  " LIMIT ?",
                  outcome_column("e.")),
      {variant, most}, [&](SQLite::Statement& row) {
        visit(row.getColumn(0).getString(), path_of(row.getColumn(1).getString()));
      });
}

void StoreReader::for_each_trace(
    const std::function<void(const std::string& folder)>& visit) const {
  implementation_->each("SELECT trace FROM episode WHERE trace <> ''", {},
                        [&](SQLite::Statement& row) { visit(row.getColumn(0).getString()); });
}

void StoreReader::for_each_rare(
    std::int64_t variant,
    const std::function<void(std::uint64_t seed, const RareRow&)>& visit) const {
  implementation_->each(
      "SELECT seed, " + rare_columns() + " FROM rare_run WHERE variant = ? ORDER BY seed",
      {variant}, [&](SQLite::Statement& row) {
        visit(static_cast<std::uint64_t>(row.getColumn(0).getInt64()), rare_row_of(row, 1));
      });
}

void StoreReader::for_each_sorted(std::int64_t variant, EpisodeNumber number,
                                  const std::function<void(double)>& visit) const {
  const std::string column = column_of(number);
  implementation_->each(
      fmt::format("SELECT {0} FROM episode WHERE variant = ? AND outcome <> 'fault' AND {0} IS NOT "
                  "NULL ORDER BY {0}",
                  column),
      {variant}, [&](SQLite::Statement& row) { visit(row.getColumn(0).getDouble()); });
}

void StoreReader::for_each_ocp_ms(std::int64_t variant,
                                  const std::function<void(double)>& visit) const {
  std::vector<double> times;
  implementation_->each("SELECT ocp_ms FROM episode_ocp_ms WHERE variant = ? ORDER BY seed",
                        {variant}, [&](SQLite::Statement& row) {
                          read_ocp_ms(text_in(row.getColumn(0)), times);
                          for (const double ms : times) visit(ms);
                        });
}

}  // namespace qsmpc::harness
