#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc {
namespace {

using Errors = std::vector<InputError::Where>;

std::string as_text(const std::string& file, const Errors& errors) {
  if (errors.empty()) return file + ": ok\n";
  std::string text;
  for (const InputError::Where& error : errors)
    text += InputError(error).what() + std::string("\n");
  return text;
}

nlohmann::ordered_json as_json(const std::string& file, const Errors& errors) {
  nlohmann::ordered_json json;
  json["file"] = file;
  json["ok"] = errors.empty();
  json["errors"] = nlohmann::ordered_json::array();
  for (const InputError::Where& error : errors) {
    json["errors"].push_back({{"line", error.line},
                              {"key", error.key},
                              {"found", error.found},
                              {"expected", error.expected}});
  }
  return json;
}

int validate(const std::vector<std::string>& files, bool json) {
  bool all_valid = true;
  nlohmann::ordered_json results = nlohmann::ordered_json::array();
  std::string text;
  for (const std::string& file : files) {
    const Errors errors = validate_scenario_file(file);
    all_valid = all_valid && errors.empty();
    text += as_text(file, errors);
    results.push_back(as_json(file, errors));
  }
  // One file is one object, as documented; several are an array of them.
  const auto& value = results.size() == 1 ? results.front() : results;
  const auto replace = nlohmann::ordered_json::error_handler_t::replace;
  print_result(json ? value.dump(2, ' ', false, replace) + "\n" : text);
  return all_valid ? kDone : kBadInput;
}

}  // namespace

void add_validate_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("validate", "Checks scenario files without running them.");
  command->footer("Example: qsmpc validate my_scenario.yaml");
  const auto files = std::make_shared<std::vector<std::string>>();
  const auto json = std::make_shared<bool>(false);
  command->add_option("files", *files, "scenario files")->required();
  command->add_flag("--json", *json, "as JSON");
  command->callback([files, json, &exit_code] { exit_code = validate(*files, *json); });
}

}  // namespace qsmpc
