#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

#include "harness/campaign/campaign.hpp"
#include "harness/campaign/runner.hpp"
#include "harness/campaign/statistics/campaign_csv.hpp"
#include "harness/campaign/statistics/campaign_json.hpp"
#include "harness/campaign/statistics/campaign_table.hpp"
#include "harness/campaign/statistics/statistics.hpp"
#include "harness/campaign/status.hpp"
#include "harness/campaign/store/store_reader.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/errors.hpp"
#include "harness/report/campaign_page.hpp"
#include "tests/fuzz/edited_files.hpp"
#include "tests/fuzz/example_drive.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::testing {
namespace {

using namespace harness;

std::string in_quotes(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + "\"";
}

/// A store under edit. Edits that SQLite refuses are skipped.
class EditedStore {
 public:
  explicit EditedStore(const std::string& path) : database_(path, SQLite::OPEN_READWRITE) {
    database_.exec("PRAGMA ignore_check_constraints = 1");
  }

  void edit(const std::string& line) {
    std::istringstream words(line);
    std::string what;
    std::string table;
    if (!(words >> what >> table)) return;
    try {
      if (what == "set") set(table, words);
      if (what == "delete") remove(table, words);
      if (what == "copy") copy(table, words);
      if (what == "drop") database_.exec("DROP TABLE " + in_quotes(table));
      if (what == "rename") rename(table, words);
      if (what == "scenario") replace_in_scenarios(replacement(line));
      if (what == "version") {
        database_.exec("PRAGMA user_version = " + std::to_string(std::atoi(table.c_str())));
      }
    } catch (const SQLite::Exception&) {
    }
  }

 private:
  static void bind(SQLite::Statement& statement, int place, const std::string& value) {
    char* end = nullptr;
    const double number = std::strtod(value.c_str(), &end);
    if (value == "null") {
      statement.bind(place);
    } else if (value.empty() || *end != '\0') {
      statement.bind(place, value);
    } else if (value.find_first_of(".eEnN") == std::string::npos) {
      statement.bind(place, static_cast<std::int64_t>(std::strtoll(value.c_str(), nullptr, 10)));
    } else {
      statement.bind(place, number);
    }
  }

  /// The condition for the row of this number, whatever its key columns are.
  [[nodiscard]] std::string row_condition(const std::string& table, int row) {
    std::string keys;
    SQLite::Statement columns(database_, "SELECT name FROM pragma_table_info(?) WHERE pk > 0");
    columns.bind(1, table);
    while (columns.executeStep()) {
      keys += (keys.empty() ? "" : ", ") + in_quotes(columns.getColumn(0).getString());
    }
    return " WHERE (" + keys + ") IN (SELECT " + keys + " FROM " + in_quotes(table) +
           " LIMIT 1 OFFSET " + std::to_string(row) + ")";
  }

  void set(const std::string& table, std::istringstream& words) {
    std::string column;
    int row = 0;
    std::string value;
    if (!(words >> column >> row)) return;
    std::getline(words >> std::ws, value);
    SQLite::Statement update(database_, "UPDATE " + in_quotes(table) + " SET " + in_quotes(column) +
                                            " = ?" + row_condition(table, row));
    bind(update, 1, value);
    update.exec();
  }

  void remove(const std::string& table, std::istringstream& words) {
    int row = 0;
    if (words >> row) database_.exec("DELETE FROM " + in_quotes(table) + row_condition(table, row));
  }

  void copy(const std::string& table, std::istringstream& words) {
    int row = 0;
    std::string column;
    std::string value;
    if (!(words >> row >> column >> value)) return;
    std::string names;
    std::string values;
    SQLite::Statement columns(database_, "SELECT name FROM pragma_table_info(?)");
    columns.bind(1, table);
    while (columns.executeStep()) {
      const std::string name = columns.getColumn(0).getString();
      names += (names.empty() ? "" : ", ") + in_quotes(name);
      values += (values.empty() ? "" : ", ") + (name == column ? "?" : in_quotes(name));
    }
    SQLite::Statement insert(database_, "INSERT INTO " + in_quotes(table) + " (" + names +
                                            ") SELECT " + values + " FROM " + in_quotes(table) +
                                            row_condition(table, row));
    bind(insert, 1, value);
    insert.exec();
  }

  void rename(const std::string& table, std::istringstream& words) {
    std::string column;
    std::string name;
    if (!(words >> column >> name)) return;
    database_.exec("ALTER TABLE " + in_quotes(table) + " RENAME COLUMN " + in_quotes(column) +
                   " TO " + in_quotes(name));
  }

  void replace_in_scenarios(const Replacement& text) {
    SQLite::Statement update(database_,
                             "UPDATE variant SET scenario_text = replace(scenario_text, ?, ?)");
    update.bind(1, text.old);
    update.bind(2, text.with);
    update.exec();
  }

  SQLite::Database database_;
};

Campaign example_campaign() {
  Campaign campaign;
  campaign.name = "example";
  campaign.seeds = {.first = 0, .count = 3};
  for (const char* const name : {"one", "other"}) {
    campaign.variants.push_back({.name = name,
                                 .scenario = "example",
                                 .settings = name,
                                 .plant = {},
                                 .resolved = example_drive()});
  }
  return campaign;
}

/// Produces everything that is made of a store.
void show(const std::string& folder) {
  const CampaignStatus status = campaign_status(folder);
  (void)status_table(status);
  (void)status_json(status);
  const StoreReader store(folder);
  const CampaignStatistics statistics = campaign_statistics(store);
  (void)campaign_table(statistics);
  (void)campaign_json(statistics);
  (void)variants_csv(statistics);
  (void)differences_csv(statistics);
  (void)calibration_csv(statistics);
  (void)campaign_page(statistics);
  store.verify();
}

}  // namespace

void read_edited_store(const std::string& edits) {
  static const TemporaryFolder folder;
  static const std::string sound = [] {
    std::string path = folder / "sound";
    (void)run_campaign(example_campaign(), path, {});
    return path;
  }();
  const std::string edited = folder / "edited";
  std::filesystem::remove_all(edited);
  std::filesystem::copy(sound, edited, std::filesystem::copy_options::recursive);
  {
    EditedStore store(edited + "/" + kStoreFile);
    std::istringstream lines(edits);
    for (std::string line; std::getline(lines, line);) store.edit(line);
  }
  try {
    show(edited);
  } catch (const InputError&) {
  } catch (const IoError&) {
  }
}

}  // namespace qsmpc::testing
