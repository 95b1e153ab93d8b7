#include "harness/campaign/rare/rare_rows.hpp"

#include <cmath>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <nlohmann/json.hpp>

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

/// JSON, so that SQL can read it (json_each).
std::string found_text(const std::vector<RareDrive>& found) {
  Json json = Json::array();
  for (const RareDrive& drive : found) {
    Json noise = Json::array();
    for (const models::NoiseSeed& entry : drive.seeds.noise) {
      noise.push_back({entry.from, entry.seed});
    }
    json.push_back({{"seed", drive.seeds.seed},
                    {"noise", std::move(noise)},
                    {"outcome", drive.outcome},
                    {"periods", drive.periods}});
  }
  return json.dump();
}

std::vector<RareDrive> found_of(const std::string& text) {
  std::vector<RareDrive> found;
  try {
    for (const Json& drive : Json::parse(text)) {
      found.push_back({.seeds = {.seed = drive.at("seed").get<std::uint64_t>()},
                       .outcome = drive.at("outcome").get<std::string>(),
                       .periods = drive.at("periods").get<std::int64_t>()});
      for (const Json& entry : drive.at("noise")) {
        found.back().seeds.noise.push_back(
            {.from = entry.at(0).get<std::uint64_t>(), .seed = entry.at(1).get<std::uint64_t>()});
      }
    }
  } catch (const Json::exception&) {
    throw SQLite::Exception("an invalid list of unsafe drives");
  }
  return found;
}

}  // namespace

std::string rare_columns() {
  return "particles, floor, probability, collision, left_bounds, levels, drives, periods, extinct, "
         "below_floor, plain_unsafe, plain_periods, plain_faults, certified, found";
}

RareRow rare_row_of(SQLite::Statement& statement, int first) {
  int next = first;
  const auto column = [&] { return statement.getColumn(next++); };
  RareRow row;
  row.particles = column().getInt();
  row.floor = column().getDouble();
  row.probability = column().getDouble();
  row.collision = column().getDouble();
  row.left_bounds = column().getDouble();
  row.levels = column().getInt64();
  row.drives = column().getInt64();
  row.periods = column().getInt64();
  row.extinct = column().getInt() != 0;
  row.below_floor = column().getInt() != 0;
  row.plain_unsafe = column().getInt64();
  row.plain_periods = column().getInt64();
  row.plain_faults = column().getInt64();
  if (const SQLite::Column certified = column(); !certified.isNull()) {
    row.certified = certified.getDouble();
  }
  row.found = found_of(column().getString());
  return row;
}

void insert_rare(SQLite::Database& database, std::int64_t variant, std::int64_t seed,
                 const RareRow& row) {
  SQLite::Statement statement(database, "INSERT INTO rare_run (variant, seed, " + rare_columns() +
                                            ") VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
                                            "?, ?, ?)");
  int next = 1;
  statement.bind(next++, variant);
  statement.bind(next++, seed);
  statement.bind(next++, row.particles);
  for (const double value : {row.floor, row.probability, row.collision, row.left_bounds}) {
    statement.bind(next++, value);
  }
  for (const std::int64_t count : {row.levels, row.drives, row.periods}) {
    statement.bind(next++, count);
  }
  statement.bind(next++, row.extinct ? 1 : 0);
  statement.bind(next++, row.below_floor ? 1 : 0);
  for (const std::int64_t count : {row.plain_unsafe, row.plain_periods, row.plain_faults}) {
    statement.bind(next++, count);
  }
  if (std::isnan(row.certified)) {
    statement.bind(next++);  // NULL
  } else {
    statement.bind(next++, row.certified);
  }
  statement.bind(next, found_text(row.found));
  statement.exec();
}

std::string read_rare_settings(SQLite::Database& database) {
  SQLite::Statement statement(database, "SELECT settings FROM rare");
  return statement.executeStep() ? statement.getColumn(0).getString() : std::string();
}

void insert_rare_settings(SQLite::Database& database, const std::string& settings) {
  database.exec("DELETE FROM rare");
  if (settings.empty()) return;
  SQLite::Statement statement(database, "INSERT INTO rare VALUES (1, ?)");
  statement.bind(1, settings);
  statement.exec();
}

}  // namespace qsmpc::harness
