#include "harness/campaign/store/store_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/campaign/rare/rare_rows.hpp"
#include "harness/campaign/store/store_checksum.hpp"
#include "harness/campaign/store/store_periods.hpp"
#include "harness/trace/ending.hpp"

namespace qsmpc::harness {
namespace {

// SQLite has no NaN: it is stored as NULL.
void bind_number(SQLite::Statement& statement, int index, double value) {
  if (std::isnan(value)) {
    statement.bind(index);
  } else {
    statement.bind(index, value);
  }
}

void bind_optional(SQLite::Statement& statement, int index, const std::optional<double>& value) {
  bind_number(statement, index, value.value_or(std::numeric_limits<double>::quiet_NaN()));
}

void run(SQLite::Statement& statement) {
  statement.exec();
  statement.reset();
}

/// JSON, so that SQL can read it (json_each).
std::string path_text(const std::vector<PathPoint>& path) {
  std::string text = "[";
  for (const PathPoint& point : path) {
    text += fmt::format("{}[{:.6g},{:.6g}]", text.size() == 1 ? "" : ",", point.x, point.y);
  }
  return text + "]";
}

void insert_families(SQLite::Database& database, const std::vector<VariantFamily>& families) {
  database.exec("DELETE FROM risk_against_cost");
  SQLite::Statement statement(database, "INSERT INTO risk_against_cost VALUES (?, ?, ?, ?)");
  for (std::size_t n = 0; n < families.size(); ++n) {
    for (std::size_t i = 0; i < families[n].settings.size(); ++i) {
      statement.bind(1, static_cast<std::int64_t>(n));
      statement.bind(2, static_cast<std::int64_t>(i));
      statement.bind(3, families[n].name);
      statement.bind(4, families[n].settings[i]);
      run(statement);
    }
  }
}

void insert_stop_rule(SQLite::Database& database, const StoredCampaign& campaign) {
  database.exec("DELETE FROM stop_rule");
  if (!campaign.until) return;
  SQLite::Statement statement(database, "INSERT INTO stop_rule VALUES (1, ?, ?, ?, ?)");
  statement.bind(1, campaign.until->of);
  statement.bind(2, campaign.until->rate_halfwidth);
  statement.bind(3, campaign.until->confidence);
  if (campaign.stopped_after) {
    statement.bind(4, *campaign.stopped_after);
  } else {
    statement.bind(4);
  }
  run(statement);
}

void read_stop_rule(SQLite::Database& database, StoredCampaign& campaign) {
  SQLite::Statement statement(
      database, "SELECT event, rate_halfwidth, confidence, stopped_after FROM stop_rule");
  if (!statement.executeStep()) return;
  campaign.until = {.of = statement.getColumn(0).getString(),
                    .rate_halfwidth = statement.getColumn(1).getDouble(),
                    .confidence = statement.getColumn(2).getDouble()};
  const SQLite::Column seeds = statement.getColumn(3);
  if (!seeds.isNull()) campaign.stopped_after = seeds.getInt64();
}

std::vector<VariantFamily> read_stored_families(SQLite::Database& database) {
  SQLite::Statement statement(
      database, "SELECT family, name, settings FROM risk_against_cost ORDER BY family, place");
  std::vector<VariantFamily> families;
  std::int64_t last = -1;
  while (statement.executeStep()) {
    const std::int64_t family = statement.getColumn(0).getInt64();
    if (family != last) families.push_back({.name = statement.getColumn(1).getString()});
    families.back().settings.push_back(statement.getColumn(2).getString());
    last = family;
  }
  return families;
}

}  // namespace

SQLite::Database open_store_to_read(const std::string& path) {
  return {path, SQLite::OPEN_READONLY | SQLite::OPEN_NOMUTEX, kStorePatience};
}

std::string episode_columns(const std::string& e, const std::string& t) {
  std::string columns = fmt::format("{0}.variant, {0}.seed, {1}, ", e, outcome_column(e + "."));
  for (const char* name :
       {"fault", "steps", "time_to_target", "unsafe", "min_clearance", "cost", "next_step_max",
        "next_step_sum", "horizon_max", "thesis_max", "iterations_median", "fallbacks",
        "risk_exceeded", "believed_max", "believed_sum", "trace", "version"}) {
    columns += fmt::format("{}.{}, ", e, name);
  }
  return columns + fmt::format("{0}.finished_at, {0}.wall_ms, {0}.deadline_misses", t);
}

bool is_timing(std::string_view table) {
  return table == "episode_timing" || table == "episode_ocp_ms" || table == "episode_checksum";
}

std::vector<PathPoint> path_of(const std::string& text) {
  const nlohmann::json points = nlohmann::json::parse(text, nullptr, false);
  const auto is_point = [](const nlohmann::json& point) {
    return point.is_array() && point.size() == 2 && point[0].is_number() && point[1].is_number();
  };
  if (!points.is_array() || !std::ranges::all_of(points, is_point)) {
    throw SQLite::Exception("a path that is not a list of points");
  }
  std::vector<PathPoint> path;
  path.reserve(points.size());
  for (const nlohmann::json& point : points) {
    path.push_back({.x = point[0].get<double>(), .y = point[1].get<double>()});
  }
  return path;
}

double number_of(const SQLite::Column& column) {
  return column.isNull() ? std::numeric_limits<double>::quiet_NaN() : column.getDouble();
}

std::int64_t stored_seed(std::uint64_t seed) { return static_cast<std::int64_t>(seed); }

EpisodeRow episode_of(SQLite::Statement& statement, int first) {
  int next = first;
  const auto column = [&] { return statement.getColumn(next++); };
  EpisodeRow row;
  row.variant = column().getInt64();
  row.seed = static_cast<std::uint64_t>(column().getInt64());
  row.outcome = column().getString();
  row.fault = column().getString();
  row.steps = column().getInt();
  if (const SQLite::Column time = column(); !time.isNull()) row.time_to_target = time.getDouble();
  row.unsafe = column().getInt() != 0;
  row.min_clearance = number_of(column());
  row.cost = number_of(column());
  row.next_step_max = number_of(column());
  row.next_step_sum = number_of(column());
  row.horizon_max = number_of(column());
  row.thesis_max = number_of(column());
  row.iterations_median = number_of(column());
  row.fallbacks = column().getInt();
  if (const SQLite::Column periods = column(); !periods.isNull()) {
    row.risk_exceeded = periods.getInt();
  }
  if (const SQLite::Column most = column(); !most.isNull()) row.believed_max = most.getDouble();
  if (const SQLite::Column sum = column(); !sum.isNull()) row.believed_sum = sum.getDouble();
  row.trace = column().getString();
  row.version = column().getString();
  row.timing.finished_at = column().getDouble();
  row.timing.wall_ms = column().getDouble();
  row.timing.deadline_misses = column().getInt();
  return row;
}

std::string outcome_column(const std::string& prefix) {
  return fmt::format(
      "CASE WHEN {0}unsafe AND {0}outcome IN ('{1}', '{2}') THEN '{3}' ELSE {0}outcome END", prefix,
      outcome_name(Outcome::kReached), outcome_name(Outcome::kTimeout), kLeftSafeSet);
}

std::map<std::string, std::int64_t> count_outcomes(SQLite::Database& database) {
  SQLite::Statement statement(database,
                              "SELECT " + outcome_column() + ", count(*) FROM episode GROUP BY 1");
  std::map<std::string, std::int64_t> outcomes;
  while (statement.executeStep()) {
    outcomes[statement.getColumn(0).getString()] = statement.getColumn(1).getInt64();
  }
  return outcomes;
}

struct EpisodeWriter::Implementation {
  explicit Implementation(SQLite::Database& written)
      : database(written),
        episode(database,
                "INSERT INTO episode VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
                "?, ?)"),
        timing(database, "INSERT INTO episode_timing VALUES (?, ?, ?, ?, ?)"),
        periods(database, "INSERT INTO episode_periods VALUES (?, ?, ?, ?)"),
        times(database, "INSERT INTO episode_ocp_ms VALUES (?, ?, ?)"),
        path(database, "INSERT INTO path VALUES (?, ?, ?)"),
        checksum(database, "INSERT INTO episode_checksum VALUES (?, ?, ?)"),
        checksums(database) {}

  static void begin(SQLite::Statement& statement, const EpisodeRow& row) {
    statement.reset();  // in case the previous execution failed
    statement.bind(1, row.variant);
    statement.bind(2, stored_seed(row.seed));
  }

  void add_episode(const EpisodeRow& row) {
    begin(episode, row);
    episode.bind(3, row.outcome);
    episode.bind(4, row.fault);
    episode.bind(5, row.steps);
    bind_optional(episode, 6, row.time_to_target);
    episode.bind(7, row.unsafe ? 1 : 0);
    bind_number(episode, 8, row.min_clearance);
    bind_number(episode, 9, row.cost);
    bind_number(episode, 10, row.next_step_max);
    bind_number(episode, 11, row.next_step_sum);
    bind_number(episode, 12, row.horizon_max);
    bind_number(episode, 13, row.thesis_max);
    bind_number(episode, 14, row.iterations_median);
    episode.bind(15, row.fallbacks);
    episode.bind(16, row.trace);
    episode.bind(17, row.version);
    if (row.risk_exceeded) {
      episode.bind(18, *row.risk_exceeded);
    } else {
      episode.bind(18);
    }
    bind_optional(episode, 19, row.believed_max);
    bind_optional(episode, 20, row.believed_sum);
    run(episode);
  }

  void add_periods(const EpisodeRow& row) {
    if (row.periods.empty()) return;
    begin(periods, row);
    periods.bind(3, certificates_text(row.periods));
    periods.bind(4, unsafe_text(row.periods));
    run(periods);
    begin(times, row);
    times.bind(3, ocp_ms_text(row.periods));
    run(times);
  }

  void add(const EpisodeRow& row) {
    add_episode(row);
    begin(timing, row);
    timing.bind(3, row.timing.finished_at);
    timing.bind(4, row.timing.wall_ms);
    timing.bind(5, row.timing.deadline_misses);
    run(timing);
    add_periods(row);
    if (!row.path.empty()) {
      begin(path, row);
      path.bind(3, path_text(row.path));
      run(path);
    }
    if (row.rare) insert_rare(database, row.variant, stored_seed(row.seed), *row.rare);
    begin(checksum, row);
    checksum.bind(3, checksums.of(row.variant, stored_seed(row.seed)));
    run(checksum);
  }

  SQLite::Database& database;
  SQLite::Statement episode;
  SQLite::Statement timing;
  SQLite::Statement periods;
  SQLite::Statement times;
  SQLite::Statement path;
  SQLite::Statement checksum;
  EpisodeChecksums checksums;
};

EpisodeWriter::EpisodeWriter(SQLite::Database& database)
    : implementation_(std::make_unique<Implementation>(database)) {}

EpisodeWriter::~EpisodeWriter() = default;

void EpisodeWriter::add(const EpisodeRow& row) { implementation_->add(row); }

void delete_episode(SQLite::Database& database, std::int64_t variant, std::uint64_t seed) {
  for (const char* table : kEpisodeTables) {
    SQLite::Statement statement(
        database, fmt::format("DELETE FROM {} WHERE variant = ? AND seed = ?", table));
    statement.bind(1, variant);
    statement.bind(2, stored_seed(seed));
    run(statement);
  }
}

StoredCampaign read_campaign(SQLite::Database& database) {
  SQLite::Statement statement(database,
                              "SELECT name, version, seeds, traces, shard_index, shard_count, "
                              "episodes FROM campaign");
  if (!statement.executeStep()) throw SQLite::Exception("it holds no campaign");
  StoredCampaign campaign{.name = statement.getColumn(0).getString(),
                          .version = statement.getColumn(1).getString(),
                          .seeds = statement.getColumn(2).getString(),
                          .traces = statement.getColumn(3).getString(),
                          .shard = {.index = statement.getColumn(4).getInt64(),
                                    .count = statement.getColumn(5).getInt64()},
                          .episodes = statement.getColumn(6).getInt64(),
                          .risk_against_cost = read_stored_families(database),
                          .rare = read_rare_settings(database)};
  read_stop_rule(database, campaign);
  return campaign;
}

void insert_campaign(SQLite::Database& database, const StoredCampaign& campaign) {
  SQLite::Statement statement(database,
                              "INSERT OR REPLACE INTO campaign VALUES (1, ?, ?, ?, ?, ?, ?, ?)");
  statement.bind(1, campaign.name);
  statement.bind(2, campaign.version);
  statement.bind(3, campaign.seeds);
  statement.bind(4, campaign.traces);
  statement.bind(5, campaign.shard.index);
  statement.bind(6, campaign.shard.count);
  statement.bind(7, campaign.episodes);
  run(statement);
  insert_families(database, campaign.risk_against_cost);
  insert_stop_rule(database, campaign);
  insert_rare_settings(database, campaign.rare);
}

std::vector<StoredVariant> read_variants(SQLite::Database& database) {
  SQLite::Statement statement(database,
                              "SELECT id, name, scenario, settings, plant, scenario_text, "
                              "plant_digest FROM variant ORDER BY position");
  std::vector<StoredVariant> variants;
  while (statement.executeStep()) {
    variants.push_back({.id = statement.getColumn(0).getInt64(),
                        .name = statement.getColumn(1).getString(),
                        .scenario = statement.getColumn(2).getString(),
                        .settings = statement.getColumn(3).getString(),
                        .plant = statement.getColumn(4).getString(),
                        .scenario_text = statement.getColumn(5).getString(),
                        .plant_digest = statement.getColumn(6).getString()});
  }
  return variants;
}

void insert_variant(SQLite::Database& database, const StoredVariant& variant,
                    std::int64_t position) {
  SQLite::Statement statement(database, "INSERT INTO variant VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
  statement.bind(1, variant.id);
  statement.bind(2, position);
  statement.bind(3, variant.name);
  statement.bind(4, variant.scenario);
  statement.bind(5, variant.settings);
  statement.bind(6, variant.plant);
  statement.bind(7, variant.scenario_text);
  statement.bind(8, variant.plant_digest);
  run(statement);
}

}  // namespace qsmpc::harness
