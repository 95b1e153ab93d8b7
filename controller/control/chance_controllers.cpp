// Controllers with a chance constraint from the literature, all solved by the same optimisation
// (chance/chance_planner.hpp).
#include <algorithm>
#include <memory>
#include <string>
#include <string_view>

#include "controller/chance/chance_planner.hpp"
#include "controller/control/controller.hpp"
#include "controller/control/controller_entries.hpp"

namespace qsmpc::controller {
namespace {

ChancePlannerSettings chance_settings(const ControllerSettings& settings, std::string constraint) {
  return {
      .problem = settings.problem, .chance = settings.chance, .constraint = std::move(constraint)};
}

/// Always with feedback about the path: the tube is the spread of the closed loop under the noise.
ChancePlannerSettings tube_settings(const ControllerSettings& settings) {
  ChancePlannerSettings tube = chance_settings(settings, "cone");
  tube.problem.closed_loop = true;
  tube.tightened_inputs = true;
  tube.chance.memory = 0;
  return tube;
}

/// Feedback on the noise cannot be written as a policy in the state beyond the first stage, so such
/// decisions have only the stage that is applied.
int stages_of(const ChancePlannerSettings& settings) {
  return settings.chance.memory > 0 ? 1 : settings.problem.horizon;
}

class ChanceController final : public Controller {
 public:
  ChanceController(const models::Dynamics& dynamics, const ChancePlannerSettings& settings)
      : dynamics_(dynamics), stages_(stages_of(settings)), planner_(dynamics, settings) {}

  const Decision& decide(const Situation& situation) override {
    check_situation(situation, dynamics_.state_dim());
    const ChancePlan& plan =
        planner_.plan(situation.belief, situation.period, situation.deadline, situation.progress);
    policy_.bounds = plan.policy.bounds;
    policy_.inputs = plan.policy.inputs.leftCols(stages_);
    policy_.states = plan.policy.states.leftCols(stages_ + 1);
    policy_.gains.assign(plan.policy.gains.begin(), plan.policy.gains.begin() + stages_);
    policy_input(policy_, 0, situation.observation, offset_, decision_.input);
    decision_.policy = &policy_;
    decision_.cost = plan.cost;
    decision_.status = plan.status;
    decision_.evaluations = plan.evaluations;
    decision_.believed = plan.believed;
    decision_.timing = plan.timing;
    return decision_;
  }

  using Controller::reset;
  void reset(std::uint64_t seed) override { planner_.reset(seed); }

 private:
  const models::Dynamics& dynamics_;
  Eigen::Index stages_;
  ChancePlanner planner_;
  Policy policy_;
  Eigen::VectorXd offset_;
  Decision decision_;
};

DecisionParts parts_of(const ChancePlannerSettings& settings) {
  return {.stages = stages_of(settings), .cost = true, .status = true};
}

/// The entry of a constraint that has the same name in its own table.
template <const char* const& kName>
ControllerEntry entry_of(const char* summary) {
  return {.name = kName,
          .summary = summary,
          .parts =
              [](const ControllerSettings& settings) {
                return parts_of(chance_settings(settings, kName));
              },
          .make = [](const models::Dynamics& dynamics,
                     const ControllerSettings& settings) -> std::unique_ptr<Controller> {
            return std::make_unique<ChanceController>(dynamics, chance_settings(settings, kName));
          },
          .takes_guide = true};
}

constexpr const char* kCone = "cone";
constexpr const char* kCantelli = "cantelli";
constexpr const char* kScenario = "scenario";
constexpr const char* kCvar = "cvar";
constexpr const char* kDrcc = "drcc";

}  // namespace

ControllerEntry tube_controller() {
  return {
      .name = "tube",
      .summary =
          "plans for the mean, with a margin from the unsafe set for the noise that remains "
          "under feedback",
      .parts = [](const ControllerSettings& settings) { return parts_of(tube_settings(settings)); },
      .make = [](const models::Dynamics& dynamics,
                 const ControllerSettings& settings) -> std::unique_ptr<Controller> {
        return std::make_unique<ChanceController>(dynamics, tube_settings(settings));
      },
      .takes_guide = true};
}

ControllerEntry cone_controller() {
  return entry_of<kCone>("satisfies a chance constraint for a Gaussian law");
}

ControllerEntry cantelli_controller() {
  return entry_of<kCantelli>("the same for any law with its mean and covariance");
}

ControllerEntry scenario_controller() {
  return entry_of<kScenario>("keeps every sampled path clear");
}

ControllerEntry cvar_controller() {
  return entry_of<kCvar>("limits the conditional value at risk of sampled clearances");
}

ControllerEntry drcc_controller() {
  return entry_of<kDrcc>("the same for every law near the sampled one");
}

}  // namespace qsmpc::controller
