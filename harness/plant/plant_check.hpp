// Whether the plant of a scenario can be made, asked before anything is driven.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/errors.hpp"
#include "harness/scenario/scenario.hpp"

namespace qsmpc::harness {

/// Loads the vehicle that an analytic plant is drawn as, if it has one: what is only drawn has to
/// load as well. Throws InputError.
void try_drawn_vehicle(const Scenario& scenario);

/// Makes the plant of `scenario`, also as one of those that its disturbance draws. Throws
/// InputError as make_plant; a vehicle of those that the simulator refuses is a fault of an
/// episode.
void try_driven_plant(const Scenario& scenario);

/// Both of these.
void try_plant(const Scenario& scenario);

/// Makes the plant of `scenario`, which was loaded from `path_or_name` with `overrides`, and says
/// what is wrong with it, if anything is: the mapping names what the model does not have, the
/// vehicle does not settle, the plant lacks what the scenario asks of it. File and line are those
/// of the scenario's key.
[[nodiscard]] std::optional<InputError::Where> plant_problem(
    const Scenario& scenario, const std::string& path_or_name,
    const std::vector<std::string>& overrides = {});

}  // namespace qsmpc::harness
