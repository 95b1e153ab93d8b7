// The contents of a trace file: every dataset, its shape, units and axes. The writer creates these,
// the reader checks them, and docs/trace.md is written from them.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "harness/scenario/scenario.hpp"
#include "harness/trace/hdf5_file.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// Incremented by every change that an older reader would misread.
inline constexpr std::int64_t kTraceSchema = 1;

/// What the planner observed. In traces without it the planner observed the state itself.
inline constexpr const char* kObservationPath = "/plant/observation";

/// The residuals. For traces without them the reader computes them.
inline constexpr const char* kResidualPath = "/plant/residual";

/// The distances to the unsafe set between control instants.
inline constexpr const char* kBetweenPath = "/plant/clearance_between";

/// The vehicle's contacts with solid walls and obstacles.
inline constexpr const char* kContactForcePath = "/plant/contact_force";
inline constexpr const char* kContactTimePath = "/plant/contact_time";

/// The moving obstacles, if there are any.
inline constexpr const char* kObstaclePosePath = "/obstacles/pose";
inline constexpr const char* kObstacleSeenPath = "/obstacles/seen";
inline constexpr const char* kObstacleFinalPath = "/obstacles/final_pose";

/// The controllers' own estimates of the risk.
inline constexpr const char* kBelievedPath = "/controller/believed";

/// The gains of the policies.
inline constexpr const char* kGainsPath = "/plan/gains";

/// The root's attribute that says what caused a drive's fault; empty without a fault.
inline constexpr const char* kFaultOf = "fault_of";

/// The datasets of a trace of `scenario`, whose model `system` describes. A dataset whose first
/// axis is "step" has one row per control period. Data that the scenario's controller does not have
/// are left out.
[[nodiscard]] std::vector<DatasetSpec> trace_layout(const Scenario& scenario,
                                                    const models::SystemDescription& system);

/// Whether the dataset was added to the schema after the first traces were written, so that a trace
/// without it is still read.
[[nodiscard]] bool may_be_missing(std::string_view path);

}  // namespace qsmpc::harness
