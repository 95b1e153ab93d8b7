#include "controller/control/mppi/mppi_settings.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace qsmpc::controller {

void check_mppi_settings(const MppiSettings& settings) {
  const auto require = [](bool holds, const char* message) {
    if (!holds) throw std::invalid_argument(std::string("mppi: ") + message);
  };
  const auto is_weight = [](double value) { return value >= 0.0 && std::isfinite(value); };
  const auto is_positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  require(settings.samples >= 2, "at least two samples are needed");
  require(settings.iterations >= 1, "at least one iteration is needed");
  require(is_weight(settings.temperature), "the temperature must be positive, or 0 if not given");
  require(settings.effective_share > 0.0 && settings.effective_share <= 1.0,
          "the effective share must be above 0 and at most 1");
  require(is_positive(settings.spread), "the spread must be positive");
  require(settings.correlation >= 0.0 && settings.correlation < 1.0,
          "the correlation must be at least 0 and below 1");
  require(settings.control_term >= 0.0 && settings.control_term <= 1.0,
          "the control term must be between 0 and 1");
  require(settings.smoothing == 0 || settings.smoothing >= 2,
          "the smoothing must be 0, or at least 2 periods on either side");
  require(is_weight(settings.obstacle_cost) && is_weight(settings.proximity_cost.value_or(0.0)),
          "costs of obstacles and of proximity must be finite and not negative");
  require(is_positive(settings.margin.value_or(1.0)), "the margin must be positive");
  require(settings.noise_paths >= 1, "at least one noise path is needed");
  require(settings.cvar >= 0.0 && settings.cvar < 1.0,
          "the level of the CVaR must be at least 0 and below 1");
}

}  // namespace qsmpc::controller
