// What a model error was measured of: model, control period, plant and what varies about it. A
// measured error holds for nothing else.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/scenario/keys/key_description.hpp"
#include "harness/scenario/model_error_reader.hpp"
#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// The key of `model_error` that holds it.
[[nodiscard]] KeyDescription error_origin_key();

/// What that key in `section` says; nothing without it. Notes constants of the model and a control
/// period that are not those of `context`.
[[nodiscard]] std::optional<Scenario::ErrorOrigin> read_error_origin(
    Section& section, const ModelErrorContext& context);

/// The key and what is known of `origin`, as YAML lines after `indent`.
[[nodiscard]] std::string error_origin_text(const Scenario::ErrorOrigin& origin,
                                            const std::string& indent);

/// Of an error that is measured with the model and the plant of `scenario`. Throws as
/// load_mujoco_model.
[[nodiscard]] Scenario::ErrorOrigin error_origin_of(const Scenario& scenario);

/// In what the plant of `scenario` is known to differ from the one that its model error was
/// measured of, each "WHAT: THERE there, HERE here"; empty where nothing is known. Throws as
/// load_mujoco_model.
[[nodiscard]] std::vector<std::string> plant_differences(const Scenario& scenario);

}  // namespace qsmpc::harness
