#include "harness/episode/drive.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "controller/control/decision_motion.hpp"
#include "controller/estimation/estimator.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/assembly/chosen_points.hpp"
#include "harness/elapsed.hpp"
#include "harness/episode/moving_obstacles.hpp"
#include "harness/episode/trace_header.hpp"
#include "harness/episode/true_unsafe_set.hpp"
#include "harness/errors.hpp"
#include "harness/plant/plant_registry.hpp"
#include "harness/threads/interruption.hpp"
#include "harness/trace/ending.hpp"
#include "harness/trace/residuals.hpp"
#include "harness/trace/target_progress.hpp"
#include "models/constants.hpp"
#include "models/random/random_numbers.hpp"

namespace qsmpc::harness {
namespace {

using Clock = std::chrono::steady_clock;

Scenario with_forecast(Scenario scenario,
                       const std::shared_ptr<controller::ObstacleForecast>& forecast) {
  scenario.safe_set.forecast = forecast;
  return scenario;
}

/// The largest number of stages that a controller of the scenario may look ahead.
int forecast_stages(const Scenario& scenario) {
  return std::max({scenario.controller.horizon, scenario.controller.shield.stages,
                   certified_stages(decision_parts(scenario))});
}

}  // namespace

/// The components of the closed loop, and its state between periods.
struct Drive::Parts {
  explicit Parts(const Scenario& of)
      : forecast(new_forecast(of.safe_set)),
        scenario(with_forecast(of, forecast)),
        unsafe(scenario.safe_set),
        truly_unsafe(of.safe_set),
        model(model_of(of)),
        settings(planner_settings(scenario)),
        estimator(controller::make_estimator(of.estimator.kind,
                                             {.dynamics = *model,
                                              .noise_covariance = of.disturbance.covariance,
                                              .sensor_covariance = of.disturbance.sensor})),
        motions(*model, settings),
        disturbance(Eigen::VectorXd::Zero(model->state_dim()), of.disturbance.covariance),
        sensor(Eigen::VectorXd::Zero(model->state_dim()), of.disturbance.sensor),
        others(of.safe_set, of.time_step, forecast_stages(of), forecast),
        belief(first_belief()) {}

  [[nodiscard]] controller::Gaussian first_belief() const {
    return {.mean = scenario.initial_state.mean, .covariance = scenario.initial_state.covariance};
  }

  [[nodiscard]] std::uint64_t plant_seed() const {
    return options.plant_seed.value_or(options.seed);
  }

  [[nodiscard]] const std::vector<models::NoiseSeed>& noise() const {
    return options.noise ? *options.noise : scenario.disturbance.seeds;
  }

  /// The key of this period's numbers of `stream`; they come from `seed` until another seed takes
  /// over.
  [[nodiscard]] models::RandomKey noise_key(models::RandomStream stream, std::uint64_t seed) const {
    const auto step = static_cast<std::uint64_t>(period);
    return {.seed = models::noise_seed_at(noise(), seed, step), .stream = stream, .step = step};
  }

  /// Keys of the obstacles' numbers in this period. Their motion uses the plant's seed, as a
  /// disturbance.
  [[nodiscard]] MovingObstacles::KeyOf obstacle_key() const {
    return [this](models::RandomStream stream) {
      const bool moves = stream == models::RandomStream::kObstacleMotion;
      return noise_key(stream, moves ? plant_seed() : options.seed);
    };
  }

  [[nodiscard]] Eigen::Vector2d position() const {
    const models::SystemDescription& system = model->description();
    return {state[system.position_x], state[system.position_y]};
  }

  void begin(const DriveOptions& how) {
    options = how;
    period = 0;
    motion_begin = 0;
    outcome.reset();
    unsafe_outcome.reset();
    progress.reset();
    believed_progress.reset();
    belief = first_belief();
    trace = trace_header(scenario, model->description(), options.seed, noise());
    if (!vehicle_digest) vehicle_digest = digest_if_there(scenario);
    trace.vehicle_digest = *vehicle_digest;
    const models::GaussianSampler initial(belief.mean, belief.covariance);
    state = initial.sample({.seed = options.seed, .stream = models::RandomStream::kInitialState});
    others.begin(obstacle_key());
    guarded([&] {
      take_plant();
      plant->move_obstacles(others.poses(), others.poses());
      trace.motion.push_back(plant->reset(state));
      observe_state();
    });
  }

  /// Makes the plant of this drive. If all drives share it, it is made only once, since a vehicle
  /// takes long to load and to settle.
  void take_plant() {
    if (plant && !varies(scenario.disturbance)) return;
    plant = make_plant(scenario, draw_variation(scenario.disturbance, plant_seed()));
  }

  /// Does `work`; a simulator error is a fault, and an interrupt ends the episode and propagates.
  template <class Work>
  void guarded(const Work& work) {
    try {
      work();
    } catch (const SimulatorError& error) {
      end(Outcome::kFault, error.what());
    } catch (const Interrupted&) {
      end(Outcome::kInterrupted);
      throw;
    }
  }

  void end(Outcome how, const std::string& fault = {}, FaultOf fault_of = FaultOf::kPlant) {
    outcome = how;
    trace.outcome = how;
    trace.fault = fault;
    trace.fault_of = fault_of;
    trace.final_state = state;
    trace.final_obstacles = others.poses();
    // A plant that failed or was interrupted is not reused.
    if (how == Outcome::kFault || how == Outcome::kInterrupted) plant.reset();
  }

  /// Updates after a control instant: the observation, and the end of the episode.
  void observe_state() {
    trace.final_state = state;
    trace.final_obstacles = others.poses();
    observation = seen();
    others.see(obstacle_key());
    truly_unsafe.place(others.poses());
    progress.advance(state);
    believed_progress.advance(belief.mean);
    if (const std::optional<Outcome> now = outcome_now()) {
      end(*now);
    } else if (period >= scenario.step_limit) {
      end(unsafe_outcome.value_or(Outcome::kTimeout));
    }
  }

  /// The outcome in the present state, if the episode ends there.
  [[nodiscard]] std::optional<Outcome> outcome_now() {
    if (!unsafe_outcome) unsafe_outcome = outcome_in(truly_unsafe.part(state));
    if (scenario.stop_when_unsafe && unsafe_outcome) return unsafe_outcome;
    if (!at_target(scenario, model->description(), state, progress.now())) return std::nullopt;
    return unsafe_outcome.value_or(Outcome::kReached);
  }

  /// The observation of the state in this period.
  [[nodiscard]] Eigen::VectorXd seen() const {
    if (scenario.disturbance.sensor.isZero(0.0)) return state;
    return state + sensor.sample(noise_key(models::RandomStream::kSensor, options.seed));
  }

  [[nodiscard]] controller::Situation situation_of(int at, const controller::Gaussian& believed,
                                                   const Eigen::VectorXd& observed) const {
    return {.period = at,
            .time = at * scenario.time_step,
            .belief = believed,
            .observation = observed,
            .periods_left = scenario.step_limit - at,
            .deadline = deadline(),
            .obstacles = forecast.get(),
            .progress = believed_progress.now()};
  }

  [[nodiscard]] Clock::time_point deadline() const {
    const double seconds = scenario.controller.deadline;
    if (!std::isfinite(seconds)) return Clock::time_point::max();
    return Clock::now() +
           std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

  [[nodiscard]] StepRecord record_of(const controller::Situation& now,
                                     const controller::Decision& decision, bool certified) {
    StepRecord record;
    record.time = now.time;
    record.observation = now.observation;
    record.obstacles = others.poses();
    record.obstacles_seen = others.seen();
    record.belief_mean = now.belief.mean;
    record.belief_covariance = now.belief.covariance;
    if (certified) certify(now, decision, record);
    record.input = decision.input;
    if (decision.policy != nullptr) {
      record.plan_inputs = decision.policy->inputs;
      record.plan_states = decision.policy->states;
      record.plan_gains = decision.policy->gains;
    }
    if (decision.particles) record.particles = decision.particles->prediction.stages;
    record.cost = decision.cost.value_or(controller::CostParts::all(kNotANumber));
    if (decision.status) record.solver_status = controller::solver_status_name(*decision.status);
    record.fallback = decision.fallback;
    record.iterations = decision.evaluations;
    record.believed = decision.believed.value_or(kNotANumber);
    record.timing.quantise = decision.timing.quantise;
    record.timing.propagate = decision.timing.propagate;
    record.timing.optimise = decision.timing.optimise;
    record.timing.total = record.timing.quantise + record.timing.propagate +
                          record.timing.optimise + record.timing.certify;
    return record;
  }

  void certify(const controller::Situation& now, const controller::Decision& decision,
               StepRecord& record) {
    const auto start = Clock::now();
    const controller::Gaussian posterior = estimator->correct(now.belief, now.observation);
    const controller::PredictedMotion motion =
        of_plant(motions.of(now, decision, posterior), scenario, now.period,
                 decision.policy != nullptr ? BeliefOf::kPrediction : BeliefOf::kState);
    record.budgets = controller::error_budget(motion);
    record.certificates = controller::certify(motion, unsafe, record.budgets,
                                              controller::CertificateEffort::kLeast, settings.run);
    record.timing.certify = milliseconds_since(start);
  }

  void advance(const controller::Decision& decision) {
    motion_begin = period == 0 ? 0 : trace.motion.size();
    trace.steps.push_back(
        record_of(situation_of(period, belief, observation), decision, options.certify));
    StepRecord& record = trace.steps.back();
    record.state = state;
    record.disturbance =
        disturbance.sample(noise_key(models::RandomStream::kDisturbance, plant_seed()));
    record.residual = unknown_residual(state.size());
    if (others.count() > 0) {
      others.advance(position(), obstacle_key());
      plant->move_obstacles(others.last_poses(), others.poses());
    }
    const auto start = Clock::now();
    PlantStep result = drive_plant();
    record.timing.simulate = milliseconds_since(start);
    record.clearance_between = truly_unsafe.least_clearance(result.between, others);
    record.contact = result.contact;
    if (!result.fault) record.residual = one_step_residual(*model, record, result.state);
    trace.motion.insert(trace.motion.end(), std::make_move_iterator(result.motion.begin()),
                        std::make_move_iterator(result.motion.end()));
    belief = estimator->predict(estimator->correct(belief, record.observation), record.input);
    state = result.state;
    ++period;
    if (result.fault) {
      end(Outcome::kFault, *result.fault);
    } else {
      observe_state();
    }
  }

  /// Drives the plant through the last record's period, and drops the record if interrupted.
  PlantStep drive_plant() {
    try {
      return plant->advance(trace.steps.back().input, trace.steps.back().disturbance);
    } catch (const Interrupted&) {
      trace.steps.pop_back();
      throw;
    }
  }

  std::shared_ptr<controller::ObstacleForecast> forecast;  // of moving obstacles; or null
  Scenario scenario;
  controller::UnsafeSet unsafe;  // as far as known to the controller
  TrueUnsafeSet truly_unsafe;
  std::unique_ptr<const models::Dynamics> model;
  controller::PlannerSettings settings;
  std::unique_ptr<const controller::Estimator> estimator;
  controller::DecisionMotion motions;
  models::GaussianSampler disturbance;
  models::GaussianSampler sensor;
  MovingObstacles others;
  std::optional<std::string> vehicle_digest;  // once known
  std::unique_ptr<Plant> plant;               // of the last drive, reset for each one
  // Of the current episode.
  DriveOptions options;
  int period = 0;
  controller::Gaussian belief;
  Eigen::VectorXd state;
  Eigen::VectorXd observation;
  Trace trace;
  std::size_t motion_begin = 0;
  std::optional<Outcome> outcome;
  TargetProgress progress{scenario, model->description()};           // of the true state
  TargetProgress believed_progress{scenario, model->description()};  // of the belief's mean
  std::optional<Outcome> unsafe_outcome;  // the outcome that its first unsafe state determines
};

Drive::Drive(const Scenario& scenario)
    : parts_(std::make_unique<Parts>(with_chosen_points(scenario))) {
  parts_->outcome = Outcome::kInterrupted;  // no episode has begun
}
Drive::Drive(Drive&&) noexcept = default;
Drive& Drive::operator=(Drive&&) noexcept = default;
Drive::~Drive() = default;

const models::Dynamics& Drive::model() const { return *parts_->model; }

const Scenario& Drive::scenario() const { return parts_->scenario; }

void Drive::know_obstacles(const std::vector<controller::PlacesByStage>& obstacles) {
  const std::size_t count = parts_->forecast ? parts_->forecast->size() : 0;
  if (obstacles.size() != count) {
    throw std::invalid_argument(fmt::format("{} obstacles, but {} move", obstacles.size(), count));
  }
  const auto needed = static_cast<std::size_t>(forecast_stages(parts_->scenario)) + 1;
  for (std::size_t n = 0; n < count; ++n) {
    if (obstacles[n].size() < needed) {
      throw std::invalid_argument(
          fmt::format("a forecast of {} stages, but {} are needed", obstacles[n].size(), needed));
    }
    parts_->forecast->set(n, obstacles[n]);
  }
}

double Drive::clearance() const { return parts_->truly_unsafe.clearance(parts_->state); }

void Drive::begin(const DriveOptions& options) { parts_->begin(options); }

std::optional<double> Drive::progress() const { return parts_->progress.now(); }

int Drive::period() const { return parts_->period; }

controller::Situation Drive::situation() const {
  return parts_->situation_of(parts_->period, parts_->belief, parts_->observation);
}

const Eigen::VectorXd& Drive::state() const { return parts_->state; }

const StepRecord& Drive::advance(const controller::Decision& decision) {
  if (parts_->outcome) throw std::invalid_argument("the episode is over");
  const Eigen::Index inputs = parts_->model->input_dim();
  if (decision.input.size() != inputs || !decision.input.allFinite()) {
    throw std::invalid_argument(fmt::format("an input needs {} finite numbers", inputs));
  }
  parts_->guarded([&] { parts_->advance(decision); });
  return parts_->trace.steps.back();
}

std::size_t Drive::motion_begin() const { return parts_->motion_begin; }

const std::optional<Outcome>& Drive::outcome() const { return parts_->outcome; }

void Drive::end(Outcome outcome, const std::string& fault, FaultOf fault_of) {
  parts_->end(outcome, fault, fault_of);
}

const Trace& Drive::trace() const { return parts_->trace; }

Trace Drive::take() {
  parts_->outcome = parts_->trace.outcome;
  return std::move(parts_->trace);
}

controller::Gaussian Drive::later_belief() const {
  const controller::InputBounds& bounds = parts_->settings.bounds;
  const controller::Gaussian first = parts_->first_belief();
  return parts_->estimator->predict(parts_->estimator->correct(first, first.mean),
                                    0.5 * (bounds.lower + bounds.upper));
}

controller::Situation Drive::situation_of(const controller::Gaussian& belief, int period) const {
  return parts_->situation_of(period, belief, belief.mean);
}

StepRecord Drive::record_of(const controller::Situation& situation,
                            const controller::Decision& decision, bool certify) {
  return parts_->record_of(situation, decision, certify);
}

}  // namespace qsmpc::harness
