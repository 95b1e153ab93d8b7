// What a key must hold against the map.
#pragma once

#include <Eigen/Core>

#include "harness/scenario/keys/scenario_key.hpp"

namespace qsmpc::harness {

/// Notes that `point`, the value of `key`, is not in the safe set.
void check_safe(const ScenarioReading& reading, Section& section, const char* key,
                const Eigen::VectorXd& point);

}  // namespace qsmpc::harness
