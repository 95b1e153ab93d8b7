// Controllers: from what is known in a period to the input applied in it.
//
//   const std::unique_ptr<Controller> controller = make_controller("quantised", *car, settings);
//   const Decision& decision =
//       controller->decide({.period = k, .belief = belief, .observation = y});
//   decision.input;   // applied now
//   decision.policy;  // the stages ahead, if it plans any
//
// A new controller is one file with a class and its entry, and a line in the table in
// controllers.cpp. It leaves out the parts of a decision that it does not have: a plan, particles
// or a cost.
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

/// What is known when an input is chosen; refers to objects of the caller.
struct Situation {
  Eigen::Index period = 0;             ///< of the drive, from 0
  double time = 0.0;                   ///< s, when the period begins
  const Gaussian& belief;              ///< law of the present state, before it is observed
  const Eigen::VectorXd& observation;  ///< observation of the present state, state_dim
  /// Upper limit on the periods left in the drive, including this one; a large number where
  /// unknown.
  Eigen::Index periods_left = 1'000'000;
  /// When the input is due; at that time the best so far is returned.
  std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();
  /// Forecast of the moving obstacles; null where none moves. The moving regions of the drive's
  /// safe set follow the same forecast.
  const ObstacleForecast* obstacles = nullptr;
  /// Progress of the belief's mean: on a path, its arc length, m (if empty, controllers take the
  /// nearest place of the path); with waypoints, how many have been passed (if empty, none).
  std::optional<double> progress{};
};

/// Throws std::invalid_argument unless belief and observation have dimension `state_dim` and are
/// finite.
void check_situation(const Situation& situation, Eigen::Index state_dim);

/// The particles of a plan, with their errors.
struct PlannedParticles {
  const GaussianQuantisation& belief;  ///< of the situation's belief
  const Prediction& prediction;        ///< under the policy
  double noise_w2 = 0.0;               ///< W2 between the noise and its quantisation, or a bound
};

/// What a controller decided. It refers to data of the controller, valid until its next decision.
struct Decision {
  Eigen::VectorXd input;  ///< input_dim, within the bounds
  /// Policy for the inputs of this and the next periods, from the situation's belief on; null where
  /// nothing is planned beyond `input`.
  const Policy* policy = nullptr;
  std::optional<PlannedParticles> particles{};  ///< with a policy only
  std::optional<CostParts> cost{};              ///< of the policy, as the controller models it
  /// How the optimisation ended; empty if there was none.
  std::optional<SolverStatus> status{};
  int evaluations = 0;             ///< of cost and gradient
  bool fallback = false;           ///< the optimisation failed; the previous plan is continued
  const PlanRisk* risk = nullptr;  ///< of a policy planned under limits; else null
  bool risk_exceeded = false;      ///< whether the controller's own certificates exceed a limit
  /// The controller's own estimate of the probability that the state at the end of this period is
  /// unsafe, from 0 to 1; empty where it has none. It is a belief of the controller, not a bound.
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

  /// The input for this period. Numerical trouble and a missed deadline are reported as statuses,
  /// never as exceptions. Throws std::invalid_argument on a situation of the wrong size or with
  /// non-finite numbers.
  virtual const Decision& decide(const Situation& situation) = 0;

  /// Forgets the periods so far: the next one is the first of another drive. seed: of that drive,
  /// for controllers that draw random numbers.
  virtual void reset(std::uint64_t seed) { (void)seed; }
  void reset() { reset(0); }

  /// Human-readable messages about the drive so far; empty for most controllers.
  [[nodiscard]] virtual std::string log() const { return {}; }
};

/// What "lqr" linearises about.
enum class LqrAbout {
  kPath,    ///< the noise-free path over the horizon, which it optimises itself
  kTarget,  ///< the target state
};

/// Settings of the shield.
struct ShieldSettings {
  std::string of = "nominal";  ///< the shielded controller: any other name of `controllers`
  /// Limit of the certified probability of being unsafe at any stage of the look-ahead; above it
  /// the shielded controller is overruled.
  double limit = 0.02;
  int stages = 0;  ///< of the look-ahead; 0: the whole horizon
};

/// The problem that every controller is given; each uses the parts that it needs.
struct ControllerSettings {
  PlannerSettings problem;  ///< including how the quantised controller solves it
  LqrAbout lqr_about = LqrAbout::kPath;
  ShieldSettings shield{};
  ChanceSettings chance{};  ///< of the controllers with a chance constraint
  MppiSettings mppi{};      ///< of "mppi" and "risk_mppi"
  /// Upper limit of the certified probability of ever being unsafe in a drive; infinite for none.
  double mission = std::numeric_limits<double>::infinity();
};

/// The parts that a controller's decisions have beside the input, known before the first decision.
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
  /// `dynamics` must outlive the controller. Throws std::invalid_argument on invalid settings.
  std::unique_ptr<Controller> (*make)(const models::Dynamics& dynamics,
                                      const ControllerSettings& settings) = nullptr;
  bool keeps_limits = false;  ///< whether it plans within risk limits
  bool takes_guide = false;   ///< whether its plans can follow a guide
  bool samples = false;       ///< whether it samples input sequences, as set in MppiSettings
};

/// The table of controllers; the first is the default.
[[nodiscard]] const std::vector<ControllerEntry>& controllers();

/// Throws std::invalid_argument on an unknown name.
[[nodiscard]] const ControllerEntry& controller_entry(std::string_view name);

/// Throws std::invalid_argument on an unknown name, and whenever the entry's `make` does.
[[nodiscard]] std::unique_ptr<Controller> make_controller(std::string_view name,
                                                          const models::Dynamics& dynamics,
                                                          const ControllerSettings& settings);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
