// Checks that the plant of a scenario can be made, before anything is driven.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/errors.hpp"
#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// Loads the vehicle that an analytic plant is drawn as, if it has one: a purely visual vehicle
/// must load as well. Throws InputError.
void try_drawn_vehicle(const Scenario& scenario);

/// Makes the plant of `scenario`, also with a variation drawn from its disturbance. Throws
/// InputError as make_plant; a drawn vehicle that the simulator rejects is a fault of its episode,
/// not an error here.
void try_driven_plant(const Scenario& scenario);

/// try_drawn_vehicle and try_driven_plant.
void try_plant(const Scenario& scenario);

/// Makes the plant of `scenario`, which was loaded from `path_or_name` with `overrides`, and
/// returns the problem, if any: the mapping names elements that the model does not have, the
/// vehicle does not settle, or the plant lacks a feature that the scenario requests. File and line
/// are those of the scenario's key.
[[nodiscard]] std::optional<InputError::Where> plant_problem(
    const Scenario& scenario, const std::string& path_or_name,
    const std::vector<std::string>& overrides = {});

}  // namespace qsmpc::harness
