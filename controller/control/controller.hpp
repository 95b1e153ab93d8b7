// Controllers: what turns the knowledge of a period into the input that is applied in it.
//
//   const std::unique_ptr<Controller> controller = make_controller("quantised", *car, settings);
//   const Decision& decision = controller->decide({.period = k, .belief = belief, .observation =
//   y}); decision.input;   // applied now decision.policy;  // the stages ahead, if it plans any
//
// A new controller is one file with a class and its entry, and a line in the table in
// controllers.cpp. What it does not have, a plan, particles or a cost, it leaves out.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "controller/chance/chance_settings.hpp"
#include "controller/control/mppi/mppi_settings.hpp"
#include "controller/measure/measures.hpp"
#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "controller/planning/plan.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/prediction/policy.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/surroundings/obstacle_forecast.hpp"
#include "models/dynamics/dynamics.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// What is known when an input is to be chosen; refers to objects of the caller.
struct Situation {
  Eigen::Index period = 0;             ///< of the drive, from 0
  double time = 0.0;                   ///< s, when the period begins
  const Gaussian& belief;              ///< law of the state now, before it is observed
  const Eigen::VectorXd& observation;  ///< what is seen of the state now, state_dim
  /// Of the drive, this one with them, at most; a large number where that is not known.
  Eigen::Index periods_left = 1'000'000;
  /// When the input should be there; the best so far is wanted then.
  std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();
  /// What is known of where obstacles that move will be; null where none does. It is also what the
  /// regions of the drive's safe set move by.
  const ObstacleForecast* obstacles = nullptr;
  /// Arc length of the path that is followed, m, that the belief's mean is at; without it
  /// controllers take the place of the path that is nearest. Of waypoints, how many the mean has
  /// passed; without it none.
  std::optional<double> progress{};
};

/// Throws std::invalid_argument unless belief and observation are of `state_dim` and finite.
void check_situation(const Situation& situation, Eigen::Index state_dim);

/// The particles of a plan, with their errors.
struct PlannedParticles {
  const GaussianQuantisation& belief;  ///< of the situation's belief
  const Prediction& prediction;        ///< under the policy
  double noise_w2 = 0.0;               ///< W2 between the noise and what stands for it, or a bound
};

/// What a controller decided. Whatever it refers to is its own and valid until its next decision.
struct Decision {
  Eigen::VectorXd input;  ///< input_dim, within the bounds
  /// How the inputs of this and the next periods shall depend on the state, from the situation's
  /// belief on; null where nothing is planned beyond `input`.
  const Policy* policy = nullptr;
  std::optional<PlannedParticles> particles{};  ///< with a policy only
  std::optional<CostParts> cost{};              ///< of the policy, as far as the controller sees it
  /// How the optimisation ended; empty where nothing is optimised.
  std::optional<SolverStatus> status{};
  int evaluations = 0;             ///< of cost and gradient
  bool fallback = false;           ///< nothing usable came out; the previous plan goes on
  const PlanRisk* risk = nullptr;  ///< of a policy that was planned within limits; else null
  bool risk_exceeded = false;      ///< a limit of the risk is, as far as the controller certifies
  /// The controller's own estimate of the probability that the state at the end of this period is
  /// unsafe, from 0 to 1; nothing where it has none. It is what the controller believes, no bound.
  std::optional<double> believed{};
  PlanTiming timing{};
};

class Controller {
 public:
  Controller() = default;
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;
  Controller(Controller&&) = delete;
  Controller& operator=(Controller&&) = delete;
  virtual ~Controller() = default;

  /// The input for this period. Numerical trouble and a deadline that has passed are statuses,
  /// never exceptions. Throws std::invalid_argument on a situation of the wrong size, or with
  /// numbers that are not finite.
  virtual const Decision& decide(const Situation& situation) = 0;

  /// Forgets the periods so far: the next one is the first of another drive. `seed`: of that drive,
  /// for controllers that draw random numbers.
  virtual void reset(std::uint64_t seed) { (void)seed; }
  void reset() { reset(0); }

  /// What it has to say to people about the drive so far; most say nothing.
  [[nodiscard]] virtual std::string log() const { return {}; }
};

/// About what "lqr" linearises.
enum class LqrAbout {
  kPath,    ///< the noise-free path to the end of the horizon, which it improves itself
  kTarget,  ///< the target state
};

/// What the shield is about.
struct ShieldSettings {
  std::string of = "nominal";  ///< a name of `controllers` but its own
  /// Of the certified probability of being unsafe at any of the stages that it looks ahead, above
  /// which the other is overruled.
  double limit = 0.02;
  int stages = 0;  ///< how many; 0: the whole horizon
};

/// The problem that every controller is given; which parts of it it uses is its own affair.
struct ControllerSettings {
  PlannerSettings problem;  ///< with how the quantised controller solves it
  LqrAbout lqr_about = LqrAbout::kPath;
  ShieldSettings shield{};
  ChanceSettings chance{};  ///< of the controllers that keep a chance constraint
  MppiSettings mppi{};      ///< of "mppi" and "risk_mppi"
  /// Upper limit of the certified probability of ever being unsafe in a drive; infinite for none.
  double mission = std::numeric_limits<double>::infinity();
};

/// What a controller's decisions have beside the input, known before it has made any.
struct DecisionParts {
  int stages = 0;  ///< of the policy; 0 where there is none
  bool particles = false;
  bool noise = false;  ///< whether the particles carry the process noise
  bool cost = false;
  bool status = false;
};

struct ControllerEntry {
  std::string name;
  std::string summary;
  DecisionParts (*parts)(const ControllerSettings& settings) = nullptr;
  /// `dynamics` must outlive the controller. Throws std::invalid_argument on settings that make no
  /// sense.
  std::unique_ptr<Controller> (*make)(const models::Dynamics& dynamics,
                                      const ControllerSettings& settings) = nullptr;
  bool keeps_limits = false;  ///< whether it plans within limits of the risk
  bool takes_guide = false;   ///< whether its plans aim along the way that a guide knows
  bool samples = false;       ///< whether it draws input sequences, as MppiSettings says
};

/// The table of controllers; the first is the default.
[[nodiscard]] const std::vector<ControllerEntry>& controllers();

/// Throws std::invalid_argument on an unknown name.
[[nodiscard]] const ControllerEntry& controller_entry(std::string_view name);

/// Throws std::invalid_argument on an unknown name, and as the entry's `make`.
[[nodiscard]] std::unique_ptr<Controller> make_controller(std::string_view name,
                                                          const models::Dynamics& dynamics,
                                                          const ControllerSettings& settings);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
