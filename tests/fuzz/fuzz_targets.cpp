#include "tests/fuzz/fuzz_targets.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include <Eigen/Core>
#include <fmt/format.h>

#include "harness/assembly/assembly.hpp"
#include "harness/campaign/plan/campaign_reader.hpp"
#include "harness/cluster/launch/host_list.hpp"
#include "harness/contest/contest_reader.hpp"
#include "harness/control/controller_protocol.hpp"
#include "harness/errors.hpp"
#include "harness/prediction/input_table.hpp"
#include "harness/scenario/obstacle_file.hpp"
#include "harness/scenario/obstacle_reader.hpp"
#include "harness/scenario/path_file.hpp"
#include "harness/scenario/plant_mapping_reader.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "harness/scenario/yaml_tree.hpp"
#include "models/dynamics/equations/expression.hpp"
#include "tests/fuzz/edited_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace qsmpc::testing {
namespace {

using namespace harness;

const std::string kScenarios = std::string(QSMPC_SOURCE_DIR) + "/models/scenarios";

/// The scenario whose system and bounds the other readers use.
const Scenario& example() {
  static const Scenario scenario = load_scenario(kScenarios + "/dubins_obstacles.yaml");
  return scenario;
}

const models::SystemDescription& example_system() {
  static const std::shared_ptr<const models::Dynamics> model = model_of(example());
  return model->description();
}

/// A file with `bytes` for readers of files, removed when the process ends.
std::string as_file(const std::string& bytes) {
  static const TemporaryFolder folder;
  return folder.file("bytes", bytes);
}

void hold(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

void hold_within(const Eigen::MatrixXd& inputs, const controller::InputBounds& bounds) {
  hold(inputs.allFinite(), "an input is not finite");
  if (inputs.size() == 0) return;
  hold((inputs.colwise() - bounds.upper).maxCoeff() <= 0.0, "an input is above its bound");
  hold((inputs.colwise() - bounds.lower).minCoeff() >= 0.0, "an input is below its bound");
}

/// Whether `read` returns instead of refusing with a `Refusal`. Other exceptions are passed on.
template <class Refusal, class Read>
bool is_read(Read read) {
  try {
    read();
    return true;
  } catch (const Refusal&) {
    return false;
  }
}

/// An accepted scenario is written as it was read.
void read_scenario_text(const std::string& bytes) {
  const ScenarioSource source{.folder = kScenarios};
  std::string written;
  if (!is_read<InputError>([&] { written = to_yaml(parse_scenario(bytes, source)); })) return;
  ScenarioSource again = source;
  again.is_recorded = true;
  std::string rewritten;
  hold(is_read<InputError>([&] { rewritten = to_yaml(parse_scenario(written, again)); }),
       "a scenario that was written is refused");
  hold(rewritten == written, "a scenario is written differently after it was read back");
}

void read_override(const std::string& bytes) {
  static const ScenarioBase base(kScenarios + "/dubins_obstacles.yaml");
  (void)is_read<InputError>([&] { (void)to_yaml(base.load({bytes})); });
}

template <class Read>
void read_tree(const std::string& bytes, Read read) {
  (void)is_read<InputError>([&] {
    const YamlNode tree = parse_yaml(bytes, "file.yaml");
    Problems problems("file.yaml");
    (void)read(tree, "file.yaml", problems);
    (void)problems.sorted();
  });
}

void read_campaign_text(const std::string& bytes) { read_tree(bytes, read_campaign); }

void read_contest_text(const std::string& bytes) { read_tree(bytes, read_contest); }

void read_expression(const std::string& bytes) {
  models::Expression expression;
  if (is_read<models::ExpressionError>([&] { expression = models::parse_expression(bytes); })) {
    hold(!expression.steps.empty(), "a formula has no steps");
  }
}

void read_inputs(const std::string& bytes) {
  const InputTableFormat format{.inputs = example_system().inputs,
                                .bounds = {.lower = example().controller.input_lower,
                                           .upper = example().controller.input_upper}};
  Eigen::MatrixXd inputs;
  if (!is_read<InputError>([&] { inputs = parse_input_table(bytes, "in.csv", format); })) return;
  hold_within(inputs, format.bounds);
}

void read_path_text(const std::string& bytes) {
  Problems problems("path.csv");
  const std::optional<PathRows> rows = read_path_file(as_file(bytes), problems);
  hold(rows.has_value() == problems.empty(), "a path is refused without a word, or read with one");
  if (!rows) return;
  const Eigen::MatrixXd& points = rows->rows;
  hold(points.size() == 0 || points.cols() == 2 || points.cols() == 4,
       "a row has neither 2 nor 4 numbers");
  hold(std::ssize(rows->lines) == points.rows(), "there is not a line for every row");
  int notes = 0;
  const bool is_path = check_path_rows(points, comes_back(points), [&](auto&&...) { ++notes; });
  hold(is_path == (notes == 0), "a path is refused without a word, or accepted with one");
}

/// Accepted obstacles are safe to query: each one is written.
void read_obstacle_text(const std::string& bytes) {
  Problems problems("obstacles.yaml");
  const auto obstacles =
      read_obstacle_file(as_file(bytes), {.system = example_system(), .problems = problems});
  for (const controller::Obstacle& obstacle : obstacles) {
    (void)obstacle_text(obstacle, example_system());
  }
}

void read_mapping(const std::string& bytes) {
  static const models::ParameterMap parameters{{"speed", 1.0}};
  (void)is_read<InputError>([&] {
    (void)parse_plant_mapping(bytes, "car.xml",
                              {.description = example_system(), .parameters = parameters});
  });
}

/// An accepted answer can be applied: inputs of the right size, finite and within the bounds.
void read_controller_answer(const std::string& bytes) {
  (void)is_read<WrongAnswer>([&] { check_greeting(bytes); });
  const controller::InputBounds bounds{.lower = example().controller.input_lower,
                                       .upper = example().controller.input_upper};
  for (const int stages : {0, 3}) {
    ControllerAnswer answer;
    const bool read = is_read<WrongAnswer>([&] {
      answer =
          read_answer(bytes, 0, {.system = example_system(), .bounds = bounds, .stages = stages});
    });
    if (!read) continue;
    const Eigen::MatrixXd inputs =
        stages == 0 ? Eigen::MatrixXd(answer.input) : answer.policy.inputs;
    hold(inputs.rows() == bounds.lower.size() && inputs.cols() == std::max(stages, 1),
         "the inputs have the wrong size");
    hold_within(inputs, bounds);
  }
}

void read_hosts(const std::string& bytes) {
  if (!bytes.empty() && bytes.front() == '@') return;  // names a file
  (void)is_read<InputError>([&] { hold(!parse_hosts(bytes).empty(), "there is no host"); });
}

}  // namespace

const std::vector<FuzzTarget>& fuzz_targets() {
  static const std::vector<FuzzTarget> targets = {
      {.name = "scenario", .read = read_scenario_text},
      {.name = "override", .read = read_override},
      {.name = "campaign", .read = read_campaign_text},
      {.name = "contest", .read = read_contest_text},
      {.name = "expression", .read = read_expression},
      {.name = "inputs", .read = read_inputs},
      {.name = "path", .read = read_path_text},
      {.name = "obstacles", .read = read_obstacle_text},
      {.name = "mapping", .read = read_mapping},
      {.name = "answer", .read = read_controller_answer},
      {.name = "hosts", .read = read_hosts},
      {.name = "trace", .read = read_edited_trace},
      {.name = "store", .read = read_edited_store},
  };
  return targets;
}

const FuzzTarget& fuzz_target(const std::string& name) {
  std::string known;
  for (const FuzzTarget& target : fuzz_targets()) {
    if (target.name == name) return target;
    known += " " + target.name;
  }
  throw std::invalid_argument("no target '" + name + "', but there are:" + known);
}

std::vector<std::string> fuzz_seeds(const FuzzTarget& target) {
  const std::filesystem::path root = QSMPC_SOURCE_DIR;
  std::vector<std::string> seeds;
  for (const auto& folder :
       {root / "tests/fuzz/seeds" / target.name, root / "models" / (target.name + "s")}) {
    if (!std::filesystem::exists(folder)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.is_regular_file()) seeds.push_back(entry.path().string());
    }
  }
  std::sort(seeds.begin(), seeds.end());
  return seeds;
}

}  // namespace qsmpc::testing
