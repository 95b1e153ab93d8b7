#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "harness/cli/commands.hpp"
#include "harness/cli/exit_codes.hpp"
#include "harness/cli/output.hpp"
#include "harness/cli/scenario_arguments.hpp"
#include "harness/doctor/diagnosis.hpp"
#include "harness/doctor/diagnosis_text.hpp"
#include "harness/doctor/gain_search.hpp"
#include "harness/errors.hpp"
#include "harness/plant/plant_check.hpp"
#include "harness/scenario/plant_choice.hpp"
#include "harness/scenario/scenario_file.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kDoctorHelp =
    "Checks a MuJoCo vehicle and its mapping by driving them: compares sign, size and delay of\n"
    "each state's response to each input with the planner's model, and finds gains with which\n"
    "they agree. Exits with 1 if something is wrong.";

struct DoctorArguments {
  std::string scenario;
  std::vector<std::string> overrides;
  std::string plant;
  bool json = false;
};

int doctor(const DoctorArguments& arguments) {
  Scenario scenario = load_scenario(arguments.scenario, arguments.overrides);
  if (!arguments.plant.empty()) scenario = with_plant(std::move(scenario), arguments.plant);
  if (scenario.plant.kind == "analytic") {
    throw InputError({.file = arguments.scenario,
                      .key = "plant.kind",
                      .found = "analytic, which is the planner's model itself",
                      .expected = "mujoco, or --plant"});
  }
  if (const auto problem = plant_problem(scenario, arguments.scenario, arguments.overrides)) {
    throw InputError(*problem);
  }
  Diagnosis diagnosis{.scenario = scenario, .answers = plant_answers(scenario)};
  const bool is_well = answer_warnings(scenario, diagnosis.answers).empty();
  if (!is_well && !diagnosis.answers.fault) {
    diagnosis.search = search_gains(scenario, diagnosis.answers);
  }
  print_result(arguments.json ? diagnosis_json(diagnosis) : diagnosis_table(diagnosis));
  return is_well ? kDone : kToldFailure;
}

}  // namespace

void add_doctor_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("doctor", kDoctorHelp);
  command->footer("Example: qsmpc doctor differential_robot");
  const auto arguments = std::make_shared<DoctorArguments>();
  add_scenario_argument(*command, arguments->scenario);
  add_set_option(*command, arguments->overrides);
  command->add_option("--plant", arguments->plant,
                      "a shipped plant, or the path of an MJCF file; default: the scenario's");
  command->add_flag("--json", arguments->json, "print JSON");
  command->callback([arguments, &exit_code] { exit_code = doctor(*arguments); });
}

}  // namespace qsmpc::harness
