#include <stdexcept>

#include "controller/control/controller.hpp"
#include "controller/control/controller_entries.hpp"
#include "controller/named_entry.hpp"

namespace qsmpc::controller {

void check_situation(const Situation& situation, Eigen::Index state_dim) {
  const auto require = [](bool holds, const char* message) {
    if (!holds) throw std::invalid_argument(std::string("controller: ") + message);
  };
  const Gaussian& belief = situation.belief;
  require(belief.mean.size() == state_dim && belief.mean.allFinite(),
          "the belief's mean must be a finite state");
  require(belief.covariance.rows() == state_dim && belief.covariance.cols() == state_dim &&
              belief.covariance.allFinite(),
          "the belief's covariance must be a finite matrix of states x states");
  require(situation.observation.size() == state_dim && situation.observation.allFinite(),
          "the observation must be a finite state");
}

const std::vector<ControllerEntry>& controllers() {
  static const std::vector<ControllerEntry> table = {
      quantised_controller(), nominal_controller(),  lqr_controller(),       tube_controller(),
      cone_controller(),      cantelli_controller(), scenario_controller(),  cvar_controller(),
      drcc_controller(),      mppi_controller(),     risk_mppi_controller(), shield_controller(),
  };
  return table;
}

const ControllerEntry& controller_entry(std::string_view name) {
  return named_entry(controllers(), name, "controller");
}

std::unique_ptr<Controller> make_controller(std::string_view name, const models::Dynamics& dynamics,
                                            const ControllerSettings& settings) {
  return controller_entry(name).make(dynamics, settings);
}

}  // namespace qsmpc::controller
