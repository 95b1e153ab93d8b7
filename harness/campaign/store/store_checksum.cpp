#include "harness/campaign/store/store_checksum.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>

#include "harness/campaign/store/store_periods.hpp"
#include "harness/campaign/store/store_rows.hpp"
#include "harness/text/fnv1a.hpp"
#include "harness/threads/workers.hpp"

namespace qsmpc::harness {
namespace {

// Columns are listed by name. Those added by later schemas are in separate queries that contribute
// only if they return a row, so that older checksums remain valid.
constexpr const char* kEpisodeQuery =
    "SELECT outcome, fault, steps, time_to_target, unsafe, min_clearance, cost, next_step_max, "
    "next_step_sum, horizon_max, thesis_max, iterations_median, fallbacks, trace, version, "
    "risk_exceeded FROM episode WHERE variant = ? AND seed = ?";
constexpr const char* kTimingQuery =
    "SELECT finished_at, wall_ms, deadline_misses FROM episode_timing "
    "WHERE variant = ? AND seed = ?";
constexpr const char* kPeriodsQuery =
    "SELECT certificates, unsafe FROM episode_periods WHERE variant = ? AND seed = ?";
constexpr const char* kOcpQuery =
    "SELECT ocp_ms FROM episode_ocp_ms WHERE variant = ? AND seed = ?";
constexpr const char* kPathQuery = "SELECT points FROM path WHERE variant = ? AND seed = ?";
constexpr const char* kBelievedQuery =
    "SELECT believed_max, believed_sum FROM episode WHERE variant = ? AND seed = ? AND "
    "(believed_max IS NOT NULL OR believed_sum IS NOT NULL)";
constexpr const char* kRareQuery =
    "SELECT particles, floor, probability, collision, left_bounds, levels, drives, periods, "
    "extinct, below_floor, plain_unsafe, plain_periods, plain_faults, certified, found "
    "FROM rare_run WHERE variant = ? AND seed = ?";

// SQLite's type codes.
constexpr std::uint64_t kIntegerType = 1;
constexpr std::uint64_t kRealType = 2;
constexpr std::uint64_t kNullType = 5;

using Hash = Fnv1a<std::uint64_t>;

void add_text(std::string_view text, Hash& hash) {
  hash.add(static_cast<std::uint64_t>(text.size()));
  hash.add(text);
}

std::string_view text_of(const SQLite::Column& column) {
  return {column.getText(), static_cast<std::size_t>(column.getBytes())};
}

void add_column(const SQLite::Column& column, Hash& hash) {
  hash.add(static_cast<std::uint64_t>(column.getType()));
  if (column.isInteger()) hash.add(static_cast<std::uint64_t>(column.getInt64()));
  if (column.isFloat()) hash.add(std::bit_cast<std::uint64_t>(column.getDouble()));
  if (column.isText()) add_text(text_of(column), hash);
}

void add_integer(std::uint64_t value, Hash& hash) {
  hash.add(kIntegerType);
  hash.add(value);
}

void add_real(double value, Hash& hash) {
  hash.add(std::isnan(value) ? kNullType : kRealType);
  if (!std::isnan(value)) hash.add(std::bit_cast<std::uint64_t>(value));
}

/// Successive seeds that one thread checks, since neighbours are on the same pages.
constexpr std::uint64_t kBlock = 64;

/// The first damaged episode that any thread has found.
class Damage {
 public:
  /// Whether `episode` comes after one that was found.
  [[nodiscard]] bool is_before(const StoredEpisode& episode) {
    const std::lock_guard lock(mutex_);
    return first_ && *first_ < episode;
  }

  void found(const StoredEpisode& episode) {
    const std::lock_guard lock(mutex_);
    if (!first_ || episode < *first_) first_ = episode;
  }

  [[nodiscard]] std::optional<StoredEpisode> first() {
    const std::lock_guard lock(mutex_);
    return first_;
  }

 private:
  std::mutex mutex_{};
  std::optional<StoredEpisode> first_{};
};

/// Checks the episodes that fall to `worker` out of `workers`. Which these are follows from their
/// keys, so that it is the same for all threads even while a campaign adds to the store.
void find_damage(const std::string& path, std::uint64_t worker, std::uint64_t workers,
                 Damage& damage) {
  SQLite::Database database = open_store_to_read(path);
  EpisodeChecksums checksums(database);
  SQLite::Statement statement(
      database, "SELECT variant, seed, checksum FROM episode_checksum ORDER BY variant, seed");
  while (statement.executeStep()) {
    const StoredEpisode episode{.variant = statement.getColumn(0).getInt64(),
                                .seed = statement.getColumn(1).getInt64()};
    const std::uint64_t block = static_cast<std::uint64_t>(episode.seed) / kBlock +
                                static_cast<std::uint64_t>(episode.variant);
    if (block % workers != worker) continue;
    if (damage.is_before(episode)) return;
    if (checksums.of(episode.variant, episode.seed) != statement.getColumn(2).getInt64()) {
      damage.found(episode);
      return;
    }
  }
}

}  // namespace

struct EpisodeChecksums::Implementation {
  explicit Implementation(SQLite::Database& database)
      : episode_(database, kEpisodeQuery),
        timing_(database, kTimingQuery),
        periods_(database, kPeriodsQuery),
        ocp_(database, kOcpQuery),
        path_(database, kPathQuery),
        believed_(database, kBelievedQuery),
        rare_(database, kRareQuery) {}

  std::int64_t of(std::int64_t variant, std::int64_t seed) {
    Hash hash;
    hash.add(static_cast<std::uint64_t>(seed));
    for (SQLite::Statement* statement :
         {&episode_, &timing_, &periods_, &ocp_, &path_, &believed_, &rare_}) {
      statement->bind(1, variant);
      statement->bind(2, seed);
    }
    hash.add(add_rows(episode_, hash));
    hash.add(add_rows(timing_, hash));
    add_periods(hash);
    add_ocp_ms(hash);
    hash.add(add_rows(path_, hash));
    for (SQLite::Statement* added : {&believed_, &rare_}) {
      if (const std::uint64_t rows = add_rows(*added, hash); rows > 0) hash.add(rows);
    }
    return static_cast<std::int64_t>(hash.value());
  }

 private:
  /// Hashes all rows of `statement`; returns their number.
  static std::uint64_t add_rows(SQLite::Statement& statement, Hash& hash) {
    std::uint64_t rows = 0;
    for (; statement.executeStep(); ++rows) {
      for (int k = 0; k < statement.getColumnCount(); ++k) {
        add_column(statement.getColumn(k), hash);
      }
    }
    statement.reset();
    return rows;
  }

  void add_periods(Hash& hash) {
    rows_.clear();
    if (periods_.executeStep()) {
      read_periods(text_of(periods_.getColumn(0)), text_of(periods_.getColumn(1)), rows_);
    }
    periods_.reset();
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      add_integer(k, hash);
      add_real(rows_[k].certified, hash);
      add_real(rows_[k].published, hash);
      add_integer(rows_[k].unsafe ? 1 : 0, hash);
    }
    hash.add(static_cast<std::uint64_t>(rows_.size()));
  }

  void add_ocp_ms(Hash& hash) {
    times_.clear();
    if (ocp_.executeStep()) read_ocp_ms(text_of(ocp_.getColumn(0)), times_);
    ocp_.reset();
    for (std::size_t k = 0; k < times_.size(); ++k) {
      add_integer(k, hash);
      add_real(times_[k], hash);
    }
    hash.add(static_cast<std::uint64_t>(times_.size()));
  }

  SQLite::Statement episode_;
  SQLite::Statement timing_;
  SQLite::Statement periods_;
  SQLite::Statement ocp_;
  SQLite::Statement path_;
  SQLite::Statement believed_;
  SQLite::Statement rare_;
  std::vector<PeriodRow> rows_{};
  std::vector<double> times_{};
};

EpisodeChecksums::EpisodeChecksums(SQLite::Database& database)
    : implementation_(std::make_unique<Implementation>(database)) {}

EpisodeChecksums::~EpisodeChecksums() = default;

std::int64_t EpisodeChecksums::of(std::int64_t variant, std::int64_t seed) {
  return implementation_->of(variant, seed);
}

std::optional<StoredEpisode> damaged_episode(const std::string& path, int threads) {
  const int count =
      open_store_to_read(path).execAndGet("SELECT count(*) FROM episode_checksum").getInt();
  const int workers = std::clamp(count / static_cast<int>(kBlock), 1, threads);
  Damage damage;
  run_workers(workers, [&](int worker) {
    find_damage(path, static_cast<std::uint64_t>(worker), static_cast<std::uint64_t>(workers),
                damage);
  });
  return damage.first();
}

}  // namespace qsmpc::harness
