// Model predictive path integral control in its information-theoretic form (Williams et al. 2018):
// certainty-equivalent, or with noise in every rollout.
#include "controller/control/controller_entries.hpp"
#include "controller/control/mppi/sampling_controller.hpp"

namespace qsmpc::controller {
namespace {

std::unique_ptr<Controller> make_mppi(const models::Dynamics& dynamics,
                                      const ControllerSettings& settings) {
  return std::make_unique<SamplingController>(
      dynamics, settings, settings.mppi.noise ? SampleNoise::kOwn : SampleNoise::kNone);
}

}  // namespace

ControllerEntry mppi_controller() {
  return {.name = "mppi",
          .summary = "mean of sampled input sequences, weighted by the costs of their rollouts",
          .parts = SamplingController::parts,
          .make = make_mppi,
          .takes_guide = true,
          .samples = true};
}

}  // namespace qsmpc::controller
