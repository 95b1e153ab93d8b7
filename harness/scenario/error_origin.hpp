// The origin of a measured model error: model, control period, plant and plant variation. A
// measured error is valid for nothing else.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/scenario/keys/key_description.hpp"
#include "harness/scenario/model_error_reader.hpp"
#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// The key of `model_error` that holds the origin.
[[nodiscard]] KeyDescription error_origin_key();

/// The value of that key in `section`; nothing without it. Notes a problem where the model's
/// constants or the control period differ from those of `context`.
[[nodiscard]] std::optional<Scenario::ErrorOrigin> read_error_origin(
    Section& section, const ModelErrorContext& context);

/// The key and the known parts of `origin`, as YAML lines after `indent`.
[[nodiscard]] std::string error_origin_text(const Scenario::ErrorOrigin& origin,
                                            const std::string& indent);

/// The origin of an error that is measured with the model and the plant of `scenario`. Throws as
/// load_mujoco_model.
[[nodiscard]] Scenario::ErrorOrigin error_origin_of(const Scenario& scenario);

/// The known differences between the plant of `scenario` and the one that its model error was
/// measured on, each as "WHAT: THERE there, HERE here"; empty where nothing is known. Throws as
/// load_mujoco_model.
[[nodiscard]] std::vector<std::string> plant_differences(const Scenario& scenario);

}  // namespace qsmpc::harness
