#include "harness/scenario/scenario_reader.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "controller/estimation/estimator.hpp"
#include "harness/scenario/controller_reader.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/model_error_reader.hpp"
#include "harness/scenario/plant_choice.hpp"
#include "harness/scenario/plant_mapping_reader.hpp"
#include "harness/scenario/section_values.hpp"
#include "harness/scenario/shipped_files.hpp"
#include "harness/scenario/value_checks.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kLongestDescription = 500;  // bytes; one line
constexpr std::size_t kMostObstacles = 1000;      // every particle is held against each of them
constexpr double kShortestPeriod = 1e-4;          // s, a simulator's step at its finest
constexpr double kLongestPeriod = 10.0;           // s
constexpr double kShortestSimulatorStep = 1e-6;   // s
constexpr WholeRange kStepsRange{1, 1000000};
constexpr WholeRange kFpsRange{1, 240};
constexpr NumberRange kDeviationRange{.least = 0.0, .most = 0.5};  // of a logarithm

// The vehicle that drives, or is drawn for, a system unless the scenario names another. One that
// has no place in the plane cannot be drawn without its own simulation.
std::string default_mjcf(const models::SystemDescription& system, const std::string& kind) {
  if (kind != "mujoco" && system.position_x < 0) return "";
  std::string farthest;
  for (const ShippedPlant& plant : shipped_plants()) {
    if (plant.system == system.name) farthest = plant.mjcf;
  }
  return farthest;
}

std::vector<std::string> system_names() {
  std::vector<std::string> names;
  names.reserve(models::systems().size());
  for (const models::SystemEntry& entry : models::systems()) names.push_back(entry.name);
  return names;
}

std::vector<std::string> coordinate_names(const std::vector<models::Coordinate>& coordinates) {
  std::vector<std::string> names;
  names.reserve(coordinates.size());
  for (const models::Coordinate& coordinate : coordinates) names.push_back(coordinate.name);
  return names;
}

std::string list_of(const std::vector<models::Coordinate>& coordinates) {
  return fmt::format("{} numbers, [{}]", coordinates.size(),
                     fmt::join(coordinate_names(coordinates), ", "));
}

// make_dynamics with its refusal, if any, as text.
std::unique_ptr<const models::Dynamics> try_dynamics(const Scenario::Model& model, double time_step,
                                                     std::string& refusal) {
  try {
    return models::make_dynamics(model.system, model.parameters, time_step);
  } catch (const std::invalid_argument& error) {
    refusal = error.what();
    return nullptr;
  }
}

class ScenarioReader {
 public:
  ScenarioReader(const YamlNode& tree, const FileLookup& lookup, Problems& problems)
      : root_(tree, problems), problems_(problems), lookup_(lookup) {}

  Scenario read() {
    if (!root_.present()) return {};
    read_names();
    read_model();
    read_limit();
    read_video();
    read_plant();
    if (dynamics_ != nullptr) {
      read_safe_set();
      read_initial_state();
      read_disturbance();
      scenario_.model_error = read_model_error(
          root_, problems_,
          {.system = scenario_.model.system, .dim = state_dim(), .folder = lookup_.folder});
      read_estimator();
      read_target();
      Section controller = root_.section("controller");
      scenario_.controller = read_controller(controller, system());
    } else {
      // Sizes are not known without a system; what is wrong in here shows once it has one.
      for (const char* key :
           {"initial_state", "disturbance", "safe_set", "target", "estimator", "controller"}) {
        (void)root_.section(key);
      }
      if (!root_.holds_text("model_error")) (void)root_.section("model_error");
    }
    root_.refuse_unread();
    return std::move(scenario_);
  }

 private:
  void read_names();
  void read_model();
  void check_parameters(Section& model, const models::SystemEntry& entry);
  void read_plant();
  void read_mapping(Section& plant);
  void read_initial_state();
  void read_disturbance();
  void read_safe_set();
  void read_estimator();
  void read_target();
  void read_angles(Section& target);
  void read_limit();
  void read_video();
  [[nodiscard]] static std::vector<std::string> read_overlays(Section& section);
  void check_safe(Section& section, const std::string& key, const Eigen::VectorXd& point);

  [[nodiscard]] const models::SystemDescription& system() const { return dynamics_->description(); }
  [[nodiscard]] Eigen::Index state_dim() const { return dynamics_->state_dim(); }

  Section root_;
  Problems& problems_;
  const FileLookup& lookup_;
  Scenario scenario_;
  std::unique_ptr<const models::Dynamics> dynamics_;  // nullptr while the system is not known
};

void ScenarioReader::read_names() {
  root_.require("name", "a name for the experiment");
  scenario_.name = root_.text("name", "", kLongestName);
  if (root_.has("name") && scenario_.name.empty()) root_.note("name", "a name, not empty");
  scenario_.description = root_.text("description", "", kLongestDescription);
  scenario_.seed = root_.seed("seed", scenario_.seed);
  scenario_.time_step =
      root_.number("time_step", scenario_.time_step, {kShortestPeriod, kLongestPeriod});
}

void ScenarioReader::read_model() {
  Section model = root_.section("model");
  const std::vector<std::string> names = system_names();
  model.require("system", expected_names("", names));
  scenario_.model.system = model.name("system", "", names);
  for (const models::SystemEntry& entry : models::systems()) {
    if (entry.name != scenario_.model.system) continue;
    check_parameters(model, entry);
    model.refuse_unread();
  }
}

// A refusal is tied to the parameter that causes it by trying each alone among the defaults.
void ScenarioReader::check_parameters(Section& model, const models::SystemEntry& entry) {
  const double time_step = scenario_.time_step;
  std::string refusal;
  scenario_.model.parameters = entry.defaults;
  for (const auto& [name, fallback] : entry.defaults) {
    const double value = model.number(name, fallback);
    Scenario::Model alone{.system = entry.name, .parameters = entry.defaults};
    alone.parameters[name] = value;
    if (value == fallback || try_dynamics(alone, time_step, refusal) != nullptr) {
      scenario_.model.parameters[name] = value;
    } else {
      model.note(name, "what the system accepts: " + refusal);
    }
  }
  dynamics_ = try_dynamics(scenario_.model, time_step, refusal);
  if (dynamics_ == nullptr) {
    root_.note("model", "what the system accepts: " + refusal,
               "parameters that do not go together");
    scenario_.model.parameters = entry.defaults;
    dynamics_ = try_dynamics(scenario_.model, time_step, refusal);
  }
}

void ScenarioReader::read_plant() {
  Section plant = root_.section("plant");
  scenario_.plant.kind = plant.name("kind", scenario_.plant.kind, plant_kind_names());
  const std::string fallback =
      dynamics_ == nullptr ? "" : default_mjcf(system(), scenario_.plant.kind);
  const std::string name = plant.text("mjcf", fallback, kLongestPath);
  const bool is_needed = scenario_.plant.kind == "mujoco" && dynamics_ != nullptr;
  std::string path = find_mjcf(name, lookup_.folder);
  if (path.empty() && plant.is_override("mjcf")) path = find_mjcf(name, "");
  scenario_.plant.mjcf = path.empty() && !lookup_.must_exist ? name : path;
  if (name.empty() && is_needed) {
    plant.note("mjcf", "a MuJoCo XML file, since the plant's kind is mujoco");
  } else if (scenario_.plant.mjcf.empty() && (is_needed || plant.has("mjcf")) && !name.empty()) {
    plant.note("mjcf",
               "a file beside the scenario, or " + expected_names(name, shipped_mjcf_names()),
               "no file " + name);
  }
  read_mapping(plant);
  plant.refuse_unread();
}

void ScenarioReader::read_mapping(Section& plant) {
  if (plant.has("time_step")) {
    scenario_.plant.time_step = plant.number("time_step", kShortestSimulatorStep,
                                             {kShortestSimulatorStep, scenario_.time_step});
  } else {
    (void)plant.number("time_step", kShortestSimulatorStep);
  }
  if (dynamics_ == nullptr) return;
  scenario_.plant.mapping = read_plant_mapping(
      plant, {.description = system(), .parameters = scenario_.model.parameters});
}

void ScenarioReader::check_safe(Section& section, const std::string& key,
                                const Eigen::VectorXd& point) {
  if (const auto problem = why_unsafe(point, scenario_.safe_set, system().states)) {
    section.note(key, "a state in the safe set", *problem);
  }
}

void ScenarioReader::read_initial_state() {
  Section section = root_.section("initial_state");
  section.require("mean", list_of(system().states));
  Scenario::GaussianValue& initial = scenario_.initial_state;
  const auto mean = section.vector("mean", state_dim());
  initial.mean = mean.value_or(Eigen::VectorXd::Zero(state_dim()));
  if (mean) check_safe(section, "mean", *mean);
  initial.covariance =
      semidefinite(section, "covariance", Eigen::MatrixXd::Zero(state_dim(), state_dim()));
  section.refuse_unread();
}

void ScenarioReader::read_disturbance() {
  Section section = root_.section("disturbance");
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(state_dim(), state_dim());
  scenario_.disturbance.covariance = semidefinite(section, "covariance", none);
  scenario_.disturbance.sensor = semidefinite(section, "sensor", none);
  Scenario::Disturbance& disturbance = scenario_.disturbance;
  disturbance.kind = section.name("kind", disturbance.kind, disturbance_kind_names());
  disturbance.friction = section.number("friction", disturbance.friction, kDeviationRange);
  disturbance.mass = section.number("mass", disturbance.mass, kDeviationRange);
  disturbance.wheelbase = section.number("wheelbase", disturbance.wheelbase, kDeviationRange);
  if (disturbance.kind == "force" && scenario_.plant.kind == "analytic") {
    section.note("kind", "state, or plant.kind: mujoco");
  }
  section.refuse_unread();
}

void ScenarioReader::read_safe_set() {
  Section section = root_.section("safe_set");
  const controller::Box everywhere = controller::unbounded_safe_set(state_dim()).bounds;
  Section bounds = section.section("bounds");
  scenario_.safe_set.bounds = read_intervals(bounds, system().states, {.fallback = everywhere}).box;
  const std::size_t count = section.list_size("obstacles");
  if (count > kMostObstacles) {
    section.note("obstacles", fmt::format("at most {} obstacles", kMostObstacles));
  }
  for (std::size_t i = 0; i < std::min(count, kMostObstacles); ++i) {
    Section item = section.item("obstacles", i);
    NamedIntervals obstacle = read_intervals(item, system().states, {.fallback = everywhere});
    if (obstacle.any) {
      scenario_.safe_set.obstacles.push_back(std::move(obstacle.box));
    } else if (item.present() && item.keys().empty()) {
      item.note_here(fmt::format("an interval of at least one of {}",
                                 fmt::join(coordinate_names(system().states), ", ")),
                     "an obstacle that fills the whole space");
    }
  }
  section.refuse_unread();
}

void ScenarioReader::read_estimator() {
  Section section = root_.section("estimator");
  const bool noisy = !scenario_.disturbance.sensor.isZero(0.0);
  const std::string fallback = noisy ? "last_measurement" : "exact";
  scenario_.estimator.kind = section.name("kind", fallback, estimator_names());
  if (noisy && controller::estimator_entry(scenario_.estimator.kind).needs_exact_sensor) {
    section.note("kind", fallback + ", since disturbance.sensor is not zero");
  }
  section.refuse_unread();
}

void ScenarioReader::read_target() {
  Section section = root_.section("target");
  section.require("state", list_of(system().states));
  const auto state = section.vector("state", state_dim());
  scenario_.target.state = state.value_or(Eigen::VectorXd::Zero(state_dim()));
  if (state) check_safe(section, "state", *state);
  scenario_.target.radius = section.number("radius", scenario_.target.radius, kPositive);
  read_angles(section);
  section.refuse_unread();
}

void ScenarioReader::read_angles(Section& section) {
  std::vector<std::string> known;
  for (const models::Coordinate& state : system().states) {
    if (state.is_angle) known.push_back(state.name);
  }
  std::vector<int>& angles = scenario_.target.angles;
  for (const std::string& name : section.texts("angles", kLongestName)) {
    const int index = system().state_index(name);
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      section.note("angles",
                   known.empty() ? "no names, since no state of the system is an angle"
                                 : "states that are angles, " + expected_names(name, known),
                   name);
    } else if (std::find(angles.begin(), angles.end(), index) != angles.end()) {
      section.note("angles", "each state once", name + " a second time");
    } else {
      angles.push_back(index);
    }
  }
}

void ScenarioReader::read_limit() {
  Section section = root_.section("limit");
  scenario_.step_limit = section.whole("steps", scenario_.step_limit, kStepsRange);
  scenario_.stop_when_unsafe = section.flag("stop_when_unsafe", scenario_.stop_when_unsafe);
  section.refuse_unread();
}

std::vector<std::string> ScenarioReader::read_overlays(Section& section) {
  const std::vector<std::string>& known = overlay_names();
  std::vector<std::string> wanted;
  for (const std::string& name : section.texts("overlays", kLongestName)) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      section.note("overlays", expected_names(name, known), name);
    } else if (std::find(wanted.begin(), wanted.end(), name) != wanted.end()) {
      section.note("overlays", "each overlay once", name + " a second time");
    } else {
      wanted.push_back(name);
    }
  }
  return wanted;
}

void ScenarioReader::read_video() {
  Section section = root_.section("video");
  Scenario::Video& video = scenario_.video;
  video.camera = section.name("camera", video.camera, camera_names());
  const std::string fallback = fmt::format("{}x{}", video.width, video.height);
  if (const auto size = parse_frame_size(section.text("size", fallback, kLongestName))) {
    video.width = size->width;
    video.height = size->height;
  } else {
    section.note("size", expected_frame_size());
  }
  video.fps = section.whole("fps", video.fps, kFpsRange);
  const std::vector<std::string> overlays = read_overlays(section);
  if (section.has("overlays")) video.overlays = overlays;
  section.refuse_unread();
}

}  // namespace

Scenario read_scenario(const YamlNode& tree, const FileLookup& lookup, Problems& problems) {
  return ScenarioReader(tree, lookup, problems).read();
}

}  // namespace qsmpc::harness
