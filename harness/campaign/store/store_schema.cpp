#include "harness/campaign/store/store_schema.hpp"

#include <cstddef>
#include <cstdint>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include "harness/campaign/store/store_periods.hpp"
#include "harness/errors.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

// "qsmc", which identifies our files in the SQLite header.
constexpr std::int32_t kApplicationId = 0x71736D63;

// Nullable columns hold numbers that need not exist. Timings are in separate tables: everything
// else depends only on scenarios and seeds.
constexpr const char* kFirstSchema = R"sql(
CREATE TABLE campaign (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  name TEXT NOT NULL,
  version TEXT NOT NULL,
  seeds TEXT NOT NULL,
  traces TEXT NOT NULL,
  shard_index INTEGER NOT NULL,
  shard_count INTEGER NOT NULL,
  episodes INTEGER NOT NULL
) STRICT;
CREATE TABLE variant (
  id INTEGER PRIMARY KEY,
  position INTEGER NOT NULL,
  name TEXT NOT NULL UNIQUE,
  scenario TEXT NOT NULL,
  settings TEXT NOT NULL,
  plant TEXT NOT NULL,
  scenario_text TEXT NOT NULL,
  plant_digest TEXT NOT NULL
) STRICT;
CREATE TABLE episode (
  variant INTEGER NOT NULL REFERENCES variant (id),
  seed INTEGER NOT NULL,
  outcome TEXT NOT NULL,
  fault TEXT NOT NULL,
  steps INTEGER NOT NULL,
  time_to_target REAL,
  unsafe INTEGER NOT NULL,
  min_clearance REAL,
  cost REAL,
  next_step_max REAL,
  next_step_sum REAL,
  horizon_max REAL,
  thesis_max REAL,
  iterations_median REAL,
  fallbacks INTEGER NOT NULL,
  trace TEXT NOT NULL,
  PRIMARY KEY (variant, seed)
) STRICT, WITHOUT ROWID;
CREATE TABLE period (
  variant INTEGER NOT NULL,
  seed INTEGER NOT NULL,
  period INTEGER NOT NULL,
  certified REAL,
  published REAL,
  unsafe INTEGER NOT NULL,
  PRIMARY KEY (variant, seed, period)
) STRICT, WITHOUT ROWID;
CREATE TABLE episode_timing (
  variant INTEGER NOT NULL,
  seed INTEGER NOT NULL,
  finished_at REAL NOT NULL,
  wall_ms REAL NOT NULL,
  deadline_misses INTEGER NOT NULL,
  PRIMARY KEY (variant, seed)
) STRICT, WITHOUT ROWID;
CREATE INDEX episode_timing_by_end ON episode_timing (finished_at);
CREATE TABLE period_timing (
  variant INTEGER NOT NULL,
  seed INTEGER NOT NULL,
  period INTEGER NOT NULL,
  ocp_ms REAL NOT NULL,
  PRIMARY KEY (variant, seed, period)
) STRICT, WITHOUT ROWID;
)sql";

// An update may keep episodes of an older program, so each records the version that drove it.
constexpr const char* kSecondSchema = R"sql(
ALTER TABLE episode ADD COLUMN version TEXT NOT NULL DEFAULT '';
UPDATE episode SET version = (SELECT version FROM campaign);
)sql";

// Rows of earlier versions do not say in how many periods a limit of the risk was exceeded.
constexpr const char* kThirdSchema = R"sql(
ALTER TABLE episode ADD COLUMN risk_exceeded INTEGER;
CREATE TABLE risk_against_cost (
  family INTEGER NOT NULL,
  place INTEGER NOT NULL,
  name TEXT NOT NULL,
  settings TEXT NOT NULL,
  PRIMARY KEY (family, place)
) STRICT, WITHOUT ROWID;
)sql";

// Drives of earlier versions have no path: their traces may be gone.
constexpr const char* kPathSchema = R"sql(
CREATE TABLE path (
  variant INTEGER NOT NULL,
  seed INTEGER NOT NULL,
  points TEXT NOT NULL,
  PRIMARY KEY (variant, seed)
) STRICT, WITHOUT ROWID;
)sql";

// Episodes of earlier versions have no checksum.
constexpr const char* kChecksumSchema = R"sql(
CREATE TABLE episode_checksum (
  variant INTEGER NOT NULL,
  seed INTEGER NOT NULL,
  checksum INTEGER NOT NULL,
  PRIMARY KEY (variant, seed)
) STRICT, WITHOUT ROWID;
)sql";

// Rows of earlier versions do not contain the controller's own risk estimates.
constexpr const char* kBelievedSchema = R"sql(
ALTER TABLE episode ADD COLUMN believed_max REAL;
ALTER TABLE episode ADD COLUMN believed_sum REAL;
)sql";

// One row per episode instead of one per period: the same space, and a fraction of the time to
// read. The tables have a rowid, which suits such large rows. Views replace the former tables for
// SQL users.
constexpr const char* kPeriodsSchema = R"sql(
ALTER TABLE period RENAME TO old_period;
ALTER TABLE period_timing RENAME TO old_period_timing;
CREATE TABLE episode_periods (
  variant INTEGER NOT NULL,
  seed INTEGER NOT NULL,
  certificates TEXT NOT NULL,
  unsafe TEXT NOT NULL,
  PRIMARY KEY (variant, seed)
) STRICT;
CREATE TABLE episode_ocp_ms (
  variant INTEGER NOT NULL,
  seed INTEGER NOT NULL,
  ocp_ms TEXT NOT NULL,
  PRIMARY KEY (variant, seed)
) STRICT;
)sql";
constexpr const char* kPeriodViews = R"sql(
DROP TABLE old_period;
DROP TABLE old_period_timing;
CREATE VIEW period AS
  SELECT p.variant, p.seed, c.key AS period,
    CAST(json_extract(c.value, '$[0]') AS REAL) AS certified,
    CAST(json_extract(c.value, '$[1]') AS REAL) AS published,
    EXISTS (SELECT 1 FROM json_each(p.unsafe) u WHERE u.value = c.key) AS unsafe
  FROM episode_periods p, json_each(p.certificates) c;
CREATE VIEW period_timing AS
  SELECT t.variant, t.seed, m.key AS period, CAST(m.value AS REAL) AS ocp_ms
  FROM episode_ocp_ms t, json_each(t.ocp_ms) m;
)sql";

constexpr const char* kStopSchema = R"sql(
CREATE TABLE stop_rule (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  event TEXT NOT NULL,
  rate_halfwidth REAL NOT NULL,
  confidence REAL NOT NULL,
  stopped_after INTEGER
) STRICT;
)sql";

// Campaigns of earlier versions did not search for rare outcomes.
constexpr const char* kRareSchema = R"sql(
CREATE TABLE rare (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  settings TEXT NOT NULL
) STRICT;
CREATE TABLE rare_run (
  variant INTEGER NOT NULL,
  seed INTEGER NOT NULL,
  particles INTEGER NOT NULL,
  floor REAL NOT NULL,
  probability REAL NOT NULL,
  collision REAL NOT NULL,
  left_bounds REAL NOT NULL,
  levels INTEGER NOT NULL,
  drives INTEGER NOT NULL,
  periods INTEGER NOT NULL,
  extinct INTEGER NOT NULL,
  below_floor INTEGER NOT NULL,
  plain_unsafe INTEGER NOT NULL,
  plain_periods INTEGER NOT NULL,
  plain_faults INTEGER NOT NULL,
  certified REAL,
  found TEXT NOT NULL,
  PRIMARY KEY (variant, seed)
) STRICT, WITHOUT ROWID;
)sql";

}  // namespace

const std::vector<Migration>& store_migrations() {
  static const std::vector<Migration> migrations{
      {.sql = kFirstSchema},
      {.sql = kSecondSchema},
      {.sql = kThirdSchema},
      {.sql = kPathSchema},
      {.sql = kChecksumSchema},
      {.sql = kBelievedSchema},
      {.sql = kPeriodsSchema, .move_rows = gather_periods, .after = kPeriodViews},
      {.sql = kStopSchema},
      {.sql = kRareSchema}};
  return migrations;
}

int store_schema() { return static_cast<int>(store_migrations().size()); }

int schema_of(SQLite::Database& database, const std::string& path) {
  const int schema = database.execAndGet("PRAGMA user_version").getInt();
  const int application = database.execAndGet("PRAGMA application_id").getInt();
  if (application == kApplicationId) return schema;
  const int tables = database.execAndGet("SELECT count(*) FROM sqlite_master").getInt();
  if (tables == 0 && schema == 0 && application == 0) return 0;
  throw InputError({.file = path,
                    .found = "an SQLite file from another program",
                    .expected = "the store of a campaign"});
}

void migrate(SQLite::Database& database, int from, const std::vector<Migration>& migrations) {
  for (std::size_t step = static_cast<std::size_t>(from); step < migrations.size(); ++step) {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    database.exec(migrations[step].sql);
    if (migrations[step].move_rows != nullptr) migrations[step].move_rows(database);
    database.exec(migrations[step].after);
    database.exec(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}",
                              kApplicationId, step + 1));
    transaction.commit();
  }
}

void refuse_newer(int schema, const std::string& path) {
  if (schema <= store_schema()) return;
  throw InputError(
      {.file = path,
       .found = fmt::format("a store of schema {}, made by a newer qsmpc", schema),
       .expected = fmt::format("schema {} or older; use the newer qsmpc", store_schema())});
}

void with_store_errors(const std::string& path, const std::function<void()>& work) {
  try {
    work();
  } catch (const SQLite::Exception& error) {
    // A negative code means that this program detected the damage, in rows that SQLite could read.
    if (error.getErrorCode() < 0) {
      throw IoError(printable(path, 400) + ": damaged: " + error.what());
    }
    throw IoError(printable(path, 400) + ": " + error.getErrorStr() +
                  (error.getErrorStr() == std::string(error.what())
                       ? ""
                       : std::string(" (") + error.what() + ")"));
  }
}

}  // namespace qsmpc::harness
