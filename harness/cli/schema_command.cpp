#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/campaign/plan/campaign_keys.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"
#include "harness/contest/contest_keys.hpp"
#include "harness/scenario/keys/key_schema.hpp"
#include "harness/scenario/keys/key_tables.hpp"
#include "harness/text/json_text.hpp"

namespace qsmpc::harness {
namespace {

/// Each table, preceded by a line with its place in the documentation.
std::string tables_text(const std::vector<DocumentTable>& tables) {
  std::string text;
  for (const DocumentTable& table : tables) {
    text += fmt::format("<!-- {}: table: {} -->\n{}", table.file, table.name, table.text);
  }
  return text;
}

/// What is available for a kind of file.
struct FileKind {
  const char* name;
  nlohmann::ordered_json (*schema)();
  std::vector<DocumentTable> (*tables)();
};

constexpr std::array<FileKind, 3> kFileKinds{{{"scenario", scenario_schema, scenario_tables},
                                              {"campaign", campaign_schema, campaign_tables},
                                              {"contest", contest_schema, contest_tables}}};

int print_schema(const std::string& kind, bool as_markdown) {
  const auto* found = std::ranges::find(kFileKinds, kind, &FileKind::name);
  print_result(as_markdown ? tables_text(found->tables()) : json_text(found->schema()));
  return kDone;
}

}  // namespace

void add_schema_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "schema", "Prints the JSON Schema of scenario, campaign or contest files, for editors.");
  command->footer("Example: qsmpc schema > qsmpc-scenario.schema.json");
  const auto kind = std::make_shared<std::string>("scenario");
  const auto format = std::make_shared<std::string>("json");
  command->add_option("kind", *kind, "scenario (default), campaign or contest")
      ->check(CLI::IsMember({"scenario", "campaign", "contest"}));
  command->add_option("--format", *format, "json (default), or markdown: tables of the keys")
      ->check(CLI::IsMember({"json", "markdown"}));
  command->callback(
      [kind, format, &exit_code] { exit_code = print_schema(*kind, *format == "markdown"); });
}

}  // namespace qsmpc::harness
