// Scenarios: loading, changing, describing; and the known names.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "python/src/arrays.hpp"
#include "python/src/module.hpp"
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "controller/control/controller.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/scenario/certificate_scope.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/scenario_warnings.hpp"
#include "harness/scenario/shipped_files.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "harness/scenario/yaml_tree.hpp"
#include "harness/text/number_parse.hpp"
#include "harness/trace/summary.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::python {
namespace {

namespace nb = nanobind;
using nb::literals::operator""_a;
using harness::Scenario;

/// The obstacles that are shapes in the plane: their indices among all obstacles, and their
/// corners, N x 2.
std::vector<std::pair<std::size_t, Eigen::MatrixXd>> shape_outlines(const Scenario& scenario) {
  const std::vector<controller::Obstacle>& obstacles = scenario.safe_set.obstacles;
  std::vector<std::pair<std::size_t, Eigen::MatrixXd>> outlines;
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    if (const controller::PlanarShape* shape = obstacles[k].shape()) {
      outlines.emplace_back(k, controller::shape_outline(*shape).transpose());
    }
  }
  return outlines;
}

/// `scenario` with `overrides` (KEY=VALUE) applied.
Scenario changed(const Scenario& scenario, const std::vector<std::string>& overrides) {
  return harness::parse_scenario(harness::to_yaml(scenario),
                                 {.file = scenario.name, .overrides = overrides});
}

Scenario with_seed(Scenario scenario, std::uint64_t seed) {
  scenario.seed = seed;
  return scenario;
}

/// Parses a recorded scenario; its files need not exist.
Scenario recorded(const std::string& text) {
  return harness::parse_scenario(text, {.files_must_exist = false, .is_recorded = true});
}

/// An unquoted scalar is a number (possibly infinite), true or false if YAML reads it as such.
nb::object scalar_of(const harness::YamlNode& node) {
  if (!node.quoted) {
    if (node.text == "true") return nb::bool_(true);
    if (node.text == "false") return nb::bool_(false);
    if (const auto whole = harness::parse_integer<std::int64_t>(node.text)) return nb::cast(*whole);
    if (const auto number = harness::parse_number(node)) return nb::cast(*number);
  }
  return nb::cast(node.text);
}

nb::object object_of(const harness::YamlNode& node) {
  using Kind = harness::YamlNode::Kind;
  if (node.kind == Kind::kNull) return nb::none();
  if (node.kind == Kind::kText) return scalar_of(node);
  if (node.kind == Kind::kList) {
    nb::list items;
    for (const harness::YamlNode& item : node.items) items.append(object_of(item));
    return items;
  }
  nb::dict items;
  for (std::size_t n = 0; n < node.items.size(); ++n) {
    items[node.keys[n].c_str()] = object_of(node.items[n]);
  }
  return items;
}

nb::object as_dict(const Scenario& scenario) {
  return object_of(harness::parse_yaml(harness::to_yaml(scenario), scenario.name));
}

/// The footprint, discs x 3: radius, and the centre's offsets forward and left of the position, m.
RowMatrix footprint_of(const Scenario& scenario) {
  const std::vector<controller::Disc>& discs = scenario.safe_set.body.discs;
  RowMatrix rows(std::ssize(discs), 3);
  for (Eigen::Index k = 0; k < rows.rows(); ++k) {
    const controller::Disc& disc = discs[static_cast<std::size_t>(k)];
    rows.row(k) << disc.radius, disc.offset.x(), disc.offset.y();
  }
  return rows;
}

double cost_of(const Scenario& scenario, const Eigen::VectorXd& state,
               const Eigen::VectorXd& input) {
  if (state.size() != scenario.target.state.size() ||
      input.size() != scenario.controller.input_lower.size()) {
    throw nb::value_error("cost: expected a number for each state, and one for each input");
  }
  return harness::period_cost(scenario, state, input);
}

void add_scenario_class(nb::module_& module) {
  nb::class_<Scenario>(module, "Scenario", "An experiment, checked, with its defaults filled in.")
      .def_ro("name", &Scenario::name)
      .def_ro("description", &Scenario::description)
      .def_ro("seed", &Scenario::seed)
      .def_ro("time_step", &Scenario::time_step, "The control period, s.")
      .def_ro("step_limit", &Scenario::step_limit)
      .def_prop_ro("horizon", [](const Scenario& s) { return s.controller.horizon; })
      .def_prop_ro("system", [](const Scenario& s) { return s.model.system; })
      .def_prop_ro("controller", [](const Scenario& s) { return s.controller.kind; })
      .def_prop_ro("plant", [](const Scenario& s) { return s.plant.kind; })
      .def_prop_ro("input_lower", [](const Scenario& s) { return s.controller.input_lower; })
      .def_prop_ro("input_upper", [](const Scenario& s) { return s.controller.input_upper; })
      .def_prop_ro("target", [](const Scenario& s) { return s.target.state; })
      .def_prop_ro("target_radius", [](const Scenario& s) { return s.target.radius; })
      .def_prop_ro("initial_mean", [](const Scenario& s) { return s.initial_state.mean; })
      .def_prop_ro("initial_covariance",
                   [](const Scenario& s) { return s.initial_state.covariance; })
      .def_prop_ro("disturbance_covariance",
                   [](const Scenario& s) { return s.disturbance.covariance; })
      .def_prop_ro("bounds_lower", [](const Scenario& s) { return s.safe_set.bounds.lower; })
      .def_prop_ro("bounds_upper", [](const Scenario& s) { return s.safe_set.bounds.upper; })
      .def_prop_ro("obstacles",
                   [](const Scenario& s) {
                     std::vector<std::pair<Eigen::VectorXd, Eigen::VectorXd>> boxes;
                     for (const auto& obstacle : s.safe_set.obstacles) {
                       if (const auto* box = obstacle.box()) {
                         boxes.emplace_back(box->lower, box->upper);
                       }
                     }
                     return boxes;
                   })
      .def_prop_ro("shape_outlines", &shape_outlines)
      .def_prop_ro("footprint", &footprint_of)
      .def_prop_ro("no_bound", &harness::why_no_bound,
                   "Why certificates are not bounds here; empty if they are.")
      .def("cost", &cost_of, "state"_a, "input"_a)
      .def("changed", &changed, "overrides"_a)
      .def("with_seed", &with_seed, "seed"_a)
      .def("to_yaml", &harness::to_yaml)
      .def("to_dict", &as_dict)
      .def("warnings", &harness::scenario_warnings);
}

/// The planner's model, as a Python class.
class Model {
 public:
  explicit Model(const Scenario& scenario) : dynamics_(harness::model_of(scenario)) {}

  [[nodiscard]] const models::SystemDescription& system() const { return dynamics_->description(); }

  /// states: N x n, inputs: N x m, or one input for all.
  [[nodiscard]] RowMatrix step(const RowMatrix& states, const RowMatrix& inputs) const {
    check(states.cols(), system().states.size(), "states");
    check(inputs.cols(), system().inputs.size(), "inputs");
    if (inputs.rows() != states.rows() && inputs.rows() != 1) {
      throw nb::value_error("step: expected as many inputs as states, or one");
    }
    const models::StateBatch from = states.transpose();
    models::StateBatch by = inputs.transpose();
    if (by.cols() != from.cols()) by = by.col(0).replicate(1, from.cols()).eval();
    models::StateBatch next(from.rows(), from.cols());
    dynamics_->step(from, by, next);
    return next.transpose();
  }

  [[nodiscard]] std::pair<RowMatrix, RowMatrix> jacobians(const Eigen::VectorXd& state,
                                                          const Eigen::VectorXd& input) const {
    check(state.size(), system().states.size(), "state");
    check(input.size(), system().inputs.size(), "input");
    Eigen::MatrixXd by_state(state.size(), state.size());
    Eigen::MatrixXd by_input(state.size(), input.size());
    dynamics_->jacobians(state, input, by_state, by_input);
    return {by_state, by_input};
  }

 private:
  static void check(Eigen::Index found, std::size_t expected, const char* what) {
    if (found == static_cast<Eigen::Index>(expected)) return;
    const std::string words = std::string(what) + ": found " + std::to_string(found) +
                              " numbers, expected " + std::to_string(expected);
    throw nb::value_error(words.c_str());
  }

  std::unique_ptr<const models::Dynamics> dynamics_;
};

void add_model_class(nb::module_& module) {
  nb::class_<Model>(module, "Model", "x⁺ = f(x, u) over one control period.")
      .def(nb::init<const Scenario&>(), "scenario"_a)
      .def_prop_ro("name", [](const Model& m) { return m.system().name; })
      .def_prop_ro("states", [](const Model& m) { return units_of(m.system().states); })
      .def_prop_ro("inputs", [](const Model& m) { return units_of(m.system().inputs); })
      .def_prop_ro("angles",
                   [](const Model& m) {
                     std::vector<bool> angles;
                     for (const auto& one : m.system().states) angles.push_back(one.is_angle);
                     return angles;
                   })
      .def_prop_ro(
          "position",
          [](const Model& m) { return std::pair(m.system().position_x, m.system().position_y); })
      .def_prop_ro("heading", [](const Model& m) { return m.system().heading; })
      .def("step", &Model::step, "states"_a, "inputs"_a)
      .def("jacobians", &Model::jacobians, "state"_a, "input"_a);
}

template <class Entries>
Described listed(const Entries& entries) {
  Described list;
  for (const auto& entry : entries) list.emplace_back(entry.name, entry.summary);
  return list;
}

Described shipped(const std::vector<harness::ShippedFile>& files) {
  Described list;
  for (const auto& file : files) list.emplace_back(file.name, file.description);
  return list;
}

}  // namespace

Described units_of(const std::vector<models::Coordinate>& coordinates) {
  Described described;
  for (const models::Coordinate& one : coordinates) described.emplace_back(one.name, one.unit);
  return described;
}

void add_scenarios(nb::module_& module) {
  add_scenario_class(module);
  add_model_class(module);
  module.def("load_scenario", &harness::load_scenario, "path_or_name"_a, "overrides"_a);
  module.def(
      "parse_scenario",
      [](const std::string& text, const std::string& folder,
         const std::vector<std::string>& overrides) {
        return harness::parse_scenario(text, {.folder = folder, .overrides = overrides});
      },
      "text"_a, "folder"_a, "overrides"_a);
  module.def("recorded_scenario", &recorded, "text"_a);
  module.def("scenarios", [] { return shipped(harness::shipped_scenarios()); });
  module.def("campaigns", [] { return shipped(harness::shipped_campaigns()); });
  module.def("systems", [] { return listed(models::systems()); });
  module.def("controllers", [] { return listed(controller::controllers()); });
}

}  // namespace qsmpc::python
