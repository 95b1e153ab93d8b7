#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/campaign/plan/campaign_keys.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"
#include "harness/scenario/keys/key_schema.hpp"
#include "harness/scenario/keys/key_tables.hpp"
#include "harness/text/json_text.hpp"

namespace qsmpc::harness {
namespace {

/// Each table after a line that says where in the documentation it stands.
std::string tables_text(const std::vector<DocumentTable>& tables) {
  std::string text;
  for (const DocumentTable& table : tables) {
    text += fmt::format("<!-- {}: table: {} -->\n{}", table.file, table.name, table.text);
  }
  return text;
}

int print_schema(bool of_campaign, bool as_markdown) {
  if (as_markdown) {
    print_result(tables_text(of_campaign ? campaign_tables() : scenario_tables()));
  } else {
    print_result(json_text(of_campaign ? campaign_schema() : scenario_schema()));
  }
  return kDone;
}

}  // namespace

void add_schema_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "schema", "Prints the JSON Schema of scenario or campaign files, for editors.");
  command->footer("Example: qsmpc schema > qsmpc-scenario.schema.json");
  const auto kind = std::make_shared<std::string>("scenario");
  const auto format = std::make_shared<std::string>("json");
  command->add_option("kind", *kind, "scenario (default) or campaign")
      ->check(CLI::IsMember({"scenario", "campaign"}));
  command->add_option("--format", *format, "json (default), or markdown: tables of the keys")
      ->check(CLI::IsMember({"json", "markdown"}));
  command->callback([kind, format, &exit_code] {
    exit_code = print_schema(*kind == "campaign", *format == "markdown");
  });
}

}  // namespace qsmpc::harness
