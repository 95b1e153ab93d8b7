#include "harness/scenario/own_model_reader.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "harness/scenario/dynamics_library.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/model_dynamics.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;
using models::EquationSystem;

constexpr std::size_t kLongestFormula = 10000;  // bytes
constexpr const char* kLibrary = "library";

/// The unit under `name`; `more` becomes its section where it has one.
models::Coordinate read_coordinate(Section& section, const std::string& name, Section* more) {
  if (section.holds_text(name)) return {name, section.text(name, "", kLongestName)};
  Section parts = section.section(name);
  models::Coordinate coordinate{.name = name, .unit = parts.text("unit", "", kLongestName)};
  coordinate.is_angle = parts.flag("angle", false);
  if (more != nullptr) {
    *more = parts;
  } else {
    parts.refuse_unread();
  }
  return coordinate;
}

void read_states(Section& model, EquationSystem& system) {
  Section states = model.section("states");
  for (const std::string& name : states.keys()) {
    system.states.push_back(read_coordinate(states, name, nullptr));
  }
}

void read_inputs(Section& model, EquationSystem& system) {
  Section inputs = model.section("inputs");
  const std::vector<std::string> names = inputs.keys();
  system.input_lower.resize(std::ssize(names));
  system.input_upper.resize(std::ssize(names));
  for (std::size_t i = 0; i < names.size(); ++i) {
    Section parts = inputs;
    system.inputs.push_back(read_coordinate(inputs, names[i], &parts));
    NumberInterval bounds{0.0, 1.0};
    if (inputs.holds_text(names[i])) {
      inputs.note(names[i], "{unit: …, bounds: [lower, upper]}");
    } else if (parts.present()) {
      parts.require("bounds", "[lower, upper], two finite numbers");
      bounds = parts.interval("bounds", true).value_or(bounds);
      parts.refuse_unread();
    }
    system.input_lower[static_cast<Eigen::Index>(i)] = bounds.lower;
    system.input_upper[static_cast<Eigen::Index>(i)] = bounds.upper;
  }
}

void read_parameters(Section& model, EquationSystem& system) {
  Section parameters = model.section("parameters");
  for (const std::string& name : parameters.keys()) {
    EquationSystem::Parameter parameter{.name = name};
    if (parameters.holds_text(name)) {
      parameter.value = parameters.number(name, 0.0);
    } else {
      Section parts = parameters.section(name);
      if (parts.present()) parts.require("value", "a finite number");
      parameter.value = parts.number("value", 0.0);
      parameter.unit = parts.text("unit", "", kLongestName);
      parts.refuse_unread();
    }
    system.parameters.push_back(std::move(parameter));
  }
}

std::vector<EquationSystem::Formula> read_formulas(Section& model, const char* key) {
  std::vector<EquationSystem::Formula> formulas;
  Section section = model.section(key);
  for (const std::string& name : section.keys()) {
    formulas.push_back({name, section.text(name, "", kLongestFormula)});
  }
  return formulas;
}

int read_state_name(Section& model, const std::string& key, const std::string& name,
                    const EquationSystem& system) {
  const std::vector<std::string> known = coordinate_names(system.states);
  const auto found = std::ranges::find(known, name);
  if (found != known.end()) return static_cast<int>(found - known.begin());
  model.note(key, known.empty() ? "a state" : expected_names(name, known), name);
  return -1;
}

void read_plane(Section& model, EquationSystem& system) {
  const std::vector<std::string> position = model.texts("position", kLongestName);
  if (position.size() == 2) {
    system.position_x = read_state_name(model, "position", position[0], system);
    system.position_y = read_state_name(model, "position", position[1], system);
    if (system.position_x >= 0 && system.position_x == system.position_y) {
      model.note("position", "two states", position[0] + " twice");
    }
  } else if (model.has("position")) {
    model.note("position", "two names of states, [x, y]");
  }
  const std::string heading = model.text("heading", "", kLongestName);
  if (!heading.empty()) system.heading = read_state_name(model, "heading", heading, system);
}

void read_time(Section& model, EquationSystem& system) {
  const bool is_continuous =
      model.name("time", "discrete", {"discrete", "continuous"}) == "continuous";
  const bool is_euler = model.name("integrator", "rk4", {"euler", "rk4"}) == "euler";
  system.substeps = model.whole("substeps", 1, {1, models::kMostSubsteps});
  if (is_continuous) {
    system.time = is_euler ? EquationSystem::Time::kEuler : EquationSystem::Time::kRungeKutta;
    return;
  }
  for (const char* key : {"integrator", "substeps"}) {
    if (model.has(key)) model.note(key, "nothing, or model.time: continuous");
  }
}

/// The whole description of a system in the section.
EquationSystem read_described(Section& model) {
  EquationSystem system;
  system.name = model.text("system", "own_system", kLongestName);
  read_states(model, system);
  read_inputs(model, system);
  read_parameters(model, system);
  system.definitions = read_formulas(model, "define");
  system.equations = read_formulas(model, "equations");
  read_time(model, system);
  read_plane(model, system);
  system.differentiable = model.flag("derivatives", true);
  return system;
}

void note_error(Section& model, const models::EquationError& error) {
  const models::EquationError::Where& where = error.where();
  const std::string expected =
      where.known.empty() ? where.expected : expected_names(where.unknown, where.known);
  Section section = model.section(where.section);
  if (where.name.empty() || !section.present()) {
    model.note(where.section, expected, where.found);
  } else {
    section.note(where.name, expected, where.found);
  }
}

void take(ScenarioReading& reading, EquationSystem system) {
  Scenario::Model& model = reading.scenario.model;
  model.system = system.name;
  model.parameters.clear();
  for (const auto& parameter : system.parameters) {
    model.parameters[parameter.name] = parameter.value;
  }
  model.own = std::move(system);
}

void read_equations(ScenarioReading& reading, Section& model) {
  const std::size_t before = reading.problems.size();
  const EquationSystem system = read_described(model);
  for (const models::SystemEntry& entry : models::systems()) {
    if (entry.name != system.name) continue;
    model.note("system",
               "a name that no built-in system has, because the model has its own equations");
  }
  model.refuse_unread();
  if (reading.problems.size() != before) return;
  try {
    reading.dynamics = models::make_equation_dynamics(system, reading.scenario.time_step);
    take(reading, system);
  } catch (const models::EquationError& error) {
    note_error(model, error);
  }
}

/// The parameters of a library's system that the section overrides.
void read_given_parameters(Section& model, EquationSystem& system) {
  Section given = model.section("parameters");
  for (auto& parameter : system.parameters) {
    if (!given.has(parameter.name) || given.holds_text(parameter.name)) {
      parameter.value = given.number(parameter.name, parameter.value);
      continue;
    }
    Section parts = given.section(parameter.name);
    parameter.value = parts.number("value", parameter.value);
    (void)parts.holds_text("unit");
    parts.refuse_unread();
  }
  given.refuse_unread();
}

/// A resolved scenario's description of its library's system must still match the library.
void check_described(Section& model, const EquationSystem& said, const EquationSystem& system) {
  if (said.states.empty()) return;
  const bool is_same = coordinate_names(said.states) == coordinate_names(system.states) &&
                       coordinate_names(said.inputs) == coordinate_names(system.inputs);
  if (!is_same) {
    model.note("states",
               "the states and inputs of the library's current system: the file was written with "
               "another one");
  }
}

std::string library_path(const ScenarioReading& reading, Section& model) {
  std::string name = model.text(kLibrary, "", kLongestPath);
  if (name.empty()) {
    model.note(kLibrary, "the path of a shared library");
    return "";
  }
  for (const std::string& folder : {reading.lookup.folder, std::string()}) {
    if (folder.empty() && !model.is_override(kLibrary) && !reading.lookup.folder.empty()) continue;
    const fs::path path = fs::path(folder) / name;
    std::error_code error;
    if (fs::is_regular_file(path, error)) return fs::absolute(path).lexically_normal().string();
  }
  if (reading.lookup.must_exist) {
    model.note(kLibrary, "a shared library, relative to the scenario's folder", "no file " + name);
    return "";
  }
  return name;
}

/// A system whose description alone is known, for a scenario that is read but not run.
class DescribedDynamics final : public models::Dynamics {
 public:
  explicit DescribedDynamics(models::SystemDescription description)
      : description_(std::move(description)) {}

  [[nodiscard]] const models::SystemDescription& description() const override {
    return description_;
  }
  void step(const BatchView& /*states*/, const BatchView& /*inputs*/,
            BatchOut /*next*/) const override {
    refuse();
  }
  void pullback(const BatchView& /*states*/, const BatchView& /*inputs*/,
                const BatchView& /*next_adjoint*/, BatchOut /*state_adjoint*/,
                BatchOut /*input_adjoint*/) const override {
    refuse();
  }
  void jacobians(const Eigen::Ref<const Eigen::VectorXd>& /*state*/,
                 const Eigen::Ref<const Eigen::VectorXd>& /*input*/,
                 Eigen::Ref<Eigen::MatrixXd> /*state_jacobian*/,
                 Eigen::Ref<Eigen::MatrixXd> /*input_jacobian*/) const override {
    refuse();
  }
  [[nodiscard]] double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& /*gain*/) const override {
    refuse();
  }

 private:
  [[noreturn]] static void refuse() { throw std::logic_error("the library was not loaded"); }

  models::SystemDescription description_;
};

void load(ScenarioReading& reading, Section& model, const EquationSystem& said) {
  const std::string& path = reading.scenario.model.library;
  const std::size_t before = reading.problems.size();
  try {
    const auto library = load_dynamics_library(path);
    const std::vector<std::string> names = library->names();
    if (!model.has("system") && names.size() != 1) {
      return model.note(
          "system", names.empty() ? "a library that contains a system" : expected_names("", names));
    }
    EquationSystem system = library->system(model.has("system") ? said.name : names.front());
    read_given_parameters(model, system);
    check_described(model, said, system);
    if (reading.problems.size() != before) return;
    reading.dynamics = library->make(system, reading.scenario.time_step);
    take(reading, std::move(system));
  } catch (const InputError& error) {
    const bool is_system = error.where().key == "model.system";
    model.note(is_system ? "system" : kLibrary, error.where().expected, error.where().found);
  } catch (const std::invalid_argument& error) {
    model.note("parameters", std::string("a value that the system accepts: ") + error.what());
  }
}

void read_library(ScenarioReading& reading, Section& model) {
  const std::size_t before = reading.problems.size();
  reading.scenario.model.library = library_path(reading, model);
  for (const char* key : {"define", "equations", "time", "integrator", "substeps"}) {
    if (model.has(key)) model.note(key, "nothing, because the system comes from model.library");
  }
  Section probe = model;
  EquationSystem said = read_described(probe);
  for (const std::string& key : model.keys()) (void)model.holds_text(key);
  probe.refuse_unread();
  if (reading.problems.size() != before) return;
  if (reading.lookup.must_exist) return load(reading, model, said);
  if (said.states.empty()) {
    return model.note("states", "those of the library's system, because the library is not loaded");
  }
  reading.dynamics = std::make_unique<DescribedDynamics>(models::description_of(said));
  take(reading, std::move(said));
}

}  // namespace

bool is_own_model(const Section& model) {
  return std::ranges::any_of(std::array{kLibrary, "equations", "states", "inputs"},
                             [&](const char* key) { return model.has(key); });
}

void read_own_model(ScenarioReading& reading, Section& model) {
  if (model.has(kLibrary)) {
    read_library(reading, model);
  } else {
    read_equations(reading, model);
  }
}

}  // namespace qsmpc::harness
