// A user's own system as the `model` section of a scenario says it.
#pragma once

#include <vector>

#include "harness/scenario/keys/scenario_key.hpp"

namespace qsmpc::harness {

/// Whether `model` says a system of the user's, by equations or from a library.
[[nodiscard]] bool is_own_model(const Section& model);

/// Reads it into the scenario, and makes the reading's dynamics, or notes what is wrong.
void read_own_model(ScenarioReading& reading, Section& model);

/// It as YAML, in lines after the key `model`.
[[nodiscard]] std::string own_model_text(const Scenario::Model& model);

/// Its keys beside `system`, for tables and editors.
[[nodiscard]] std::vector<KeyDescription> own_model_keys();

}  // namespace qsmpc::harness
