// Risk-aware model predictive path integral control: every sampled sequence is rolled out in the
// same M realisations of the noise; its cost is the mean of the quadratic cost plus the conditional
// value at risk of the unsafe cost. After Yin, Zhang, Tsiotras: "Risk-aware model predictive path
// integral control using conditional value-at-risk", ICRA 2023.
#include "controller/control/controller_entries.hpp"
#include "controller/control/mppi/sampling_controller.hpp"

namespace qsmpc::controller {
namespace {

std::unique_ptr<Controller> make_risk_mppi(const models::Dynamics& dynamics,
                                           const ControllerSettings& settings) {
  return std::make_unique<SamplingController>(dynamics, settings, SampleNoise::kShared);
}

}  // namespace

ControllerEntry risk_mppi_controller() {
  return {
      .name = "risk_mppi",
      .summary = "mppi with many realisations of the noise: mean cost, and CVaR of being unsafe",
      .parts = SamplingController::parts,
      .make = make_risk_mppi,
      .takes_guide = true,
      .samples = true};
}

}  // namespace qsmpc::controller
