#include "harness/trace/trace_layout.hpp"

#include <cstddef>
#include <string>
#include <utility>

#include "harness/assembly/assembly.hpp"
#include "harness/trace/certificate_datasets.hpp"
#include "harness/trace/certificate_fields.hpp"
#include "harness/trace/coordinate_labels.hpp"
#include "harness/trace/cost_fields.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::harness {
namespace {

using Type = DatasetSpec::Type;

/// Points stored together: few enough that the last, partly filled chunk, which is rewritten at
/// every step, wastes little. They are not compressed: that would save 15 % of their size, but take
/// four times as long as everything else in writing a step.
constexpr std::size_t kPointChunk = 512;
constexpr std::size_t kMotionChunk = 256;

/// The sizes and names that shapes and attributes are made from.
struct TraceSizes {
  controller::DecisionParts parts;
  std::size_t horizon;    // of plans; 0 without any
  std::size_t certified;  // stages with a certificate
  CoordinateLabels states;
  CoordinateLabels inputs;
  std::string clearance_unit;
  bool solid;             // whether contacts are recorded
  std::size_t obstacles;  // moving ones
};

TraceSizes trace_sizes(const Scenario& scenario, const models::SystemDescription& system) {
  const controller::DecisionParts parts = decision_parts(scenario);
  return {.parts = parts,
          .horizon = static_cast<std::size_t>(parts.stages),
          .certified = static_cast<std::size_t>(certified_stages(parts)),
          .states = labels_of(system.states),
          .inputs = labels_of(system.inputs),
          .clearance_unit = clearance_unit_of(scenario.safe_set, system),
          .solid = scenario.plant.solid,
          .obstacles = controller::moving_obstacles(scenario.safe_set).size()};
}

void add_contact(std::vector<DatasetSpec>& layout) {
  layout.push_back({.path = kContactForcePath,
                    .axes = {"step"},
                    .units = {"N"},
                    .comment = "largest normal force within the period between the vehicle and a "
                               "solid wall or obstacle, at one place; 0 without contact"});
  layout.push_back({.path = kContactTimePath,
                    .axes = {"step"},
                    .units = {"s"},
                    .comment = "time of the vehicle's first contact with one within the period; "
                               "NaN without contact"});
}

void add_plant(std::vector<DatasetSpec>& layout, const TraceSizes& n) {
  layout.push_back({.path = "/plant/time",
                    .axes = {"step"},
                    .units = {"s"},
                    .comment = "when the control period begins"});
  layout.push_back({.path = "/plant/state",
                    .row_shape = {n.states.names.size()},
                    .axes = {"step", "state"},
                    .units = n.states.units,
                    .columns = n.states.names,
                    .comment = "true state at the beginning of the period"});
  layout.push_back({.path = kObservationPath,
                    .row_shape = {n.states.names.size()},
                    .axes = {"step", "state"},
                    .units = n.states.units,
                    .columns = n.states.names,
                    .comment = "the state as the planner observed it"});
  layout.push_back({.path = "/plant/input",
                    .row_shape = {n.inputs.names.size()},
                    .axes = {"step", "input"},
                    .units = n.inputs.units,
                    .columns = n.inputs.names,
                    .comment = "applied during the period"});
  layout.push_back({.path = "/plant/disturbance",
                    .row_shape = {n.states.names.size()},
                    .axes = {"step", "state"},
                    .units = n.states.units,
                    .columns = n.states.names,
                    .comment = "added to the state at the end of the period"});
  layout.push_back({.path = kResidualPath,
                    .row_shape = {n.states.names.size()},
                    .axes = {"step", "state"},
                    .units = n.states.units,
                    .columns = n.states.names,
                    .comment = "part of the state at the end of the period that neither the "
                               "planner's model nor the disturbance explains; NaN where the plant "
                               "failed"});
  layout.push_back({.path = kBetweenPath,
                    .axes = {"step"},
                    .units = {n.clearance_unit},
                    .comment = "least distance to the unsafe set at the simulator's steps within "
                               "the period, before the disturbance; NaN without them"});
  if (n.solid) add_contact(layout);
  layout.push_back({.path = "/plant/final_state",
                    .axes = {"state"},
                    .units = n.states.units,
                    .columns = n.states.names,
                    .comment = "true state after the last period; empty if the run was killed",
                    .chunk_rows = n.states.names.size()});
  layout.push_back({.path = "/plant/motion/time",
                    .axes = {"sample"},
                    .units = {"s"},
                    .chunk_rows = kMotionChunk});
  layout.push_back({.path = "/plant/motion/qpos",
                    .row_shape = {0},
                    .axes = {"sample", "coordinate"},
                    .units = {"SI"},
                    .comment = "generalised position of the MuJoCo model, for drawing",
                    .chunk_rows = kMotionChunk});
}

void add_obstacles(std::vector<DatasetSpec>& layout, std::size_t count) {
  const std::vector<std::string> pose = {"x", "y", "turn"};
  layout.push_back({.path = kObstaclePosePath,
                    .row_shape = {count, pose.size()},
                    .axes = {"step", "obstacle", "coordinate"},
                    .units = {"m", "m", "rad"},
                    .columns = pose,
                    .comment = "offset of each moving obstacle from its place in the scenario, and "
                               "its turn about its centre, at the beginning of the period"});
  layout.push_back({.path = kObstacleSeenPath,
                    .row_shape = {count, 2},
                    .axes = {"step", "obstacle", "coordinate"},
                    .units = {"m", "m"},
                    .columns = {"x", "y"},
                    .comment = "the offset as the planner observed it"});
  layout.push_back({.path = kObstacleFinalPath,
                    .row_shape = {pose.size()},
                    .axes = {"obstacle", "coordinate"},
                    .units = {"m", "m", "rad"},
                    .columns = pose,
                    .comment = "after the last period; empty if the run was killed",
                    .chunk_rows = count});
}

void add_belief(std::vector<DatasetSpec>& layout, const TraceSizes& n) {
  layout.push_back({.path = "/belief/mean",
                    .row_shape = {n.states.names.size()},
                    .axes = {"step", "state"},
                    .units = n.states.units,
                    .columns = n.states.names});
  layout.push_back({.path = "/belief/covariance",
                    .row_shape = {n.states.names.size(), n.states.names.size()},
                    .axes = {"step", "state", "state"},
                    .units = n.states.units,
                    .columns = n.states.names,
                    .comment = "an entry has the unit of its row times that of its column"});
}

void add_policy(std::vector<DatasetSpec>& layout, const TraceSizes& n) {
  layout.push_back({.path = "/plan/inputs",
                    .row_shape = {n.horizon, n.inputs.names.size()},
                    .axes = {"step", "stage", "input"},
                    .units = n.inputs.units,
                    .columns = n.inputs.names});
  layout.push_back({.path = "/plan/states",
                    .row_shape = {n.horizon + 1, n.states.names.size()},
                    .axes = {"step", "stage", "state"},
                    .units = n.states.units,
                    .columns = n.states.names,
                    .comment = "nominal states, the present one first"});
  layout.push_back({.path = kGainsPath,
                    .row_shape = {n.horizon, n.inputs.names.size(), n.states.names.size()},
                    .axes = {"step", "stage", "input", "state"},
                    .units = {"unit of the input by that of the state"},
                    .columns = n.states.names,
                    .comment = "feedback gains on the state's deviation from the nominal state"});
}

void add_solution(std::vector<DatasetSpec>& layout, const TraceSizes& n) {
  if (n.parts.cost) {
    layout.push_back({.path = "/plan/cost",
                      .row_shape = {cost_part_names().size()},
                      .axes = {"step", "part"},
                      .units = {"1"},
                      .columns = cost_part_names()});
  }
  if (!n.parts.status) return;
  layout.push_back({.path = "/plan/status",
                    .type = Type::kText,
                    .axes = {"step"},
                    .units = {"1"},
                    .comment = "the solver's status"});
  layout.push_back({.path = "/plan/fallback",
                    .type = Type::kInt64,
                    .axes = {"step"},
                    .units = {"1"},
                    .comment = "1 where the shifted previous plan was applied instead"});
  layout.push_back({.path = "/plan/iterations",
                    .type = Type::kInt64,
                    .axes = {"step"},
                    .units = {"1"},
                    .comment = "evaluations of the cost and its gradient"});
}

void add_believed(std::vector<DatasetSpec>& layout) {
  layout.push_back({.path = kBelievedPath,
                    .axes = {"step"},
                    .units = {"1"},
                    .comment = "the controller's own estimate of the probability that the state at "
                               "the end of the period is unsafe; not a bound; NaN where it has "
                               "none"});
}

void add_particles(std::vector<DatasetSpec>& layout, const TraceSizes& n) {
  const std::string slices =
      "the points of step k and stage s (0 is the present) are the rows from offsets[k, s] up to "
      "but not including offsets[k, s + 1], counted from 0";
  layout.push_back({.path = "/particles/locations",
                    .row_shape = {n.states.names.size()},
                    .axes = {"point", "state"},
                    .units = n.states.units,
                    .columns = n.states.names,
                    .comment = slices,
                    .chunk_rows = kPointChunk});
  layout.push_back({.path = "/particles/weights",
                    .axes = {"point"},
                    .units = {"1"},
                    .comment = slices,
                    .chunk_rows = kPointChunk});
  layout.push_back({.path = "/particles/offsets",
                    .type = Type::kInt64,
                    .row_shape = {n.horizon + 2},
                    .axes = {"step", "stage"},
                    .units = {"row of locations and weights"},
                    .comment = slices});
}

void add_timing(std::vector<DatasetSpec>& layout) {
  for (const char* const phase :
       {"quantise", "propagate", "optimise", "certify", "total", "simulate"}) {
    // Never compressed: different times must not shift what follows them in the file.
    layout.push_back({.path = std::string("/timing/") + phase,
                      .axes = {"step"},
                      .units = {"ms"},
                      .comment = "wall-clock time; differs from run to run"});
  }
}

}  // namespace

std::vector<DatasetSpec> trace_layout(const Scenario& scenario,
                                      const models::SystemDescription& system) {
  const TraceSizes sizes = trace_sizes(scenario, system);
  std::vector<DatasetSpec> layout;
  add_plant(layout, sizes);
  if (sizes.obstacles > 0) add_obstacles(layout, sizes.obstacles);
  add_belief(layout, sizes);
  if (sizes.parts.stages > 0) add_policy(layout, sizes);
  add_solution(layout, sizes);
  add_believed(layout);
  if (sizes.parts.particles) add_particles(layout, sizes);
  for (DatasetSpec& spec : certificate_layout(sizes.certified)) layout.push_back(std::move(spec));
  add_timing(layout);
  return layout;
}

bool may_be_missing(std::string_view path) {
  return path == kObservationPath || path == kResidualPath || path == kGainsPath ||
         path == kBetweenPath || path == kBelievedPath || path == kDynamicsPath ||
         path == kModelErrorPath || path == "/certificate/smoothed";
}

}  // namespace qsmpc::harness
