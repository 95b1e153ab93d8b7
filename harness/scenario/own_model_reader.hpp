// A user-defined system, from the `model` section of a scenario.
#pragma once

#include <vector>

#include "harness/scenario/keys/scenario_key.hpp"

namespace qsmpc::harness {

/// Whether `model` describes a user-defined system, by equations or from a library.
[[nodiscard]] bool is_own_model(const Section& model);

/// Reads the system into the scenario and makes the reading's dynamics, or notes problems.
void read_own_model(ScenarioReading& reading, Section& model);

/// The system as YAML, in lines after the key `model`.
[[nodiscard]] std::string own_model_text(const Scenario::Model& model);

/// The keys of a user-defined system other than `system`, for tables and editors.
[[nodiscard]] std::vector<KeyDescription> own_model_keys();

}  // namespace qsmpc::harness
