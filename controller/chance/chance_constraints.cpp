#include <cmath>
#include <stdexcept>

#include "controller/chance/chance_constraint.hpp"
#include "controller/named_entry.hpp"

namespace qsmpc::controller {

void check_chance_settings(const ChanceSettings& settings) {
  const auto require = [](bool holds, const char* message) {
    if (!holds) throw std::invalid_argument(std::string("chance constraint: ") + message);
  };
  require(settings.risk > 0.0 && settings.risk < 1.0, "the risk must be between 0 and 1");
  require(settings.confidence > 0.0 && settings.confidence < 1.0,
          "the confidence must be between 0 and 1");
  require(settings.paths >= 0, "the number of paths must not be negative");
  require(settings.radius >= 0.0 && std::isfinite(settings.radius),
          "the radius must be finite and not negative");
  require(settings.smoothing > 0.0 && std::isfinite(settings.smoothing),
          "the smoothing must be finite and positive");
  require(settings.memory >= 0, "the memory must not be negative");
}

const std::vector<ChanceConstraintEntry>& chance_constraints() {
  static const std::vector<ChanceConstraintEntry> table = {
      {.name = "cone",
       .summary =
           "Gaussian law: linearised obstacles, backed off by a multiple of the standard deviation",
       .make = make_cone_constraint},
      {.name = "cantelli",
       .summary = "the same for any law with that mean and covariance, by Cantelli's inequality",
       .make = make_cantelli_constraint},
      {.name = "scenario",
       .summary = "every sampled path stays clear",
       .samples = true,
       .make = make_scenario_constraint},
      {.name = "cvar",
       .summary = "conditional value at risk of the sampled clearances",
       .samples = true,
       .make = make_cvar_constraint},
      {.name = "drcc",
       .summary = "the same for every law in a Wasserstein ball about the sampled one",
       .samples = true,
       .make = make_drcc_constraint},
  };
  return table;
}

const ChanceConstraintEntry& chance_constraint_entry(std::string_view name) {
  return named_entry(chance_constraints(), name, "chance constraint");
}

}  // namespace qsmpc::controller
