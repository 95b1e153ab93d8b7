// What a trace file consists of: every dataset, its shape, units and axes. The writer makes these,
// the reader checks them, and docs/trace.md is written from them.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "harness/scenario/scenario.hpp"
#include "harness/trace/hdf5_file.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Grows with every change that an older reader would misread.
inline constexpr std::int64_t kTraceSchema = 1;

/// Of what the planner saw. Traces without it are of planners that saw the state itself.
inline constexpr const char* kObservationPath = "/plant/observation";

/// Of the residuals. For traces without it the reader works them out.
inline constexpr const char* kResidualPath = "/plant/residual";

/// Of the distances from the unsafe set between control instants.
inline constexpr const char* kBetweenPath = "/plant/clearance_between";

/// Of how the vehicle touched what is solid.
inline constexpr const char* kContactForcePath = "/plant/contact_force";
inline constexpr const char* kContactTimePath = "/plant/contact_time";

/// Of the obstacles that move, where there are any.
inline constexpr const char* kObstaclePosePath = "/obstacles/pose";
inline constexpr const char* kObstacleSeenPath = "/obstacles/seen";
inline constexpr const char* kObstacleFinalPath = "/obstacles/final_pose";

/// Of what controllers believe of the risk that they take.
inline constexpr const char* kBelievedPath = "/controller/believed";

/// Of the policies' gains.
inline constexpr const char* kGainsPath = "/plan/gains";

/// The root's attribute that says who broke a drive; empty where nothing did.
inline constexpr const char* kFaultOf = "fault_of";

/// The datasets of a trace of `scenario` and `system`, which describes its model. A dataset whose
/// first axis is "step" has one row a control period; what the scenario's controller does not have
/// is not among them.
[[nodiscard]] std::vector<DatasetSpec> trace_layout(const Scenario& scenario,
                                                    const models::SystemDescription& system);

/// Whether the dataset came to the schema after the first traces were written: a trace without it
/// is read all the same.
[[nodiscard]] bool may_be_missing(std::string_view path);

}  // namespace qsmpc::harness
