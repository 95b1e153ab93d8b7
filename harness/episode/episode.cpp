#include "harness/episode/episode.hpp"

#include <chrono>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "controller/control/controller.hpp"
#include "controller/control/decision_motion.hpp"
#include "controller/estimation/estimator.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/errors.hpp"
#include "harness/plant/plant_registry.hpp"
#include "harness/random/random_numbers.hpp"
#include "harness/scenario/outside_controllers.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/threads/interruption.hpp"
#include "harness/trace/ending.hpp"
#include "harness/trace/residuals.hpp"
#include "harness/trace/trace_writer.hpp"
#include "harness/version.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

using Clock = std::chrono::steady_clock;

// The second plan starts from the first, as the plans of an episode do.
constexpr int kRehearsals = 2;
// A period of which the belief is predicted, as of all but the first.
constexpr int kRehearsedPeriod = 1;
constexpr double kMilliseconds = 1000.0;  // in a second

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// plant_digest; empty where the vehicle is not to be had.
std::string digest_of(const Scenario& scenario) {
  try {
    return plant_digest(scenario);
  } catch (const InputError&) {
    return {};
  }
}

Trace header_of(const Scenario& scenario, const models::SystemDescription& system,
                std::uint64_t seed) {
  Trace trace;
  trace.scenario = scenario;
  trace.scenario.seed = seed;
  trace.scenario_text = to_yaml(trace.scenario);
  trace.system = system;
  trace.seed = seed;
  trace.version = kVersion;
  return trace;
}

/// Not a number without states.
double least_clearance(const Eigen::MatrixXd& states, const controller::UnsafeSet& unsafe) {
  double least = kNotANumber;
  for (const auto& state : states.colwise()) {
    least = std::fmin(least, controller::clearance(state, unsafe));
  }
  return least;
}

}  // namespace

/// The closed loop's parts and its state between the steps.
class EpisodeDriver::Loop {
 public:
  explicit Loop(const Scenario& scenario)
      : scenario_(scenario),
        unsafe_(scenario.safe_set),
        model_(model_of(scenario)),
        settings_(controller_settings(scenario)),
        controller_(make_controller(scenario, *model_)),
        estimator_(controller::make_estimator(scenario.estimator.kind,
                                              {.dynamics = *model_,
                                               .noise_covariance = scenario.disturbance.covariance,
                                               .sensor_covariance = scenario.disturbance.sensor})),
        motions_(*model_, settings_.problem),
        disturbance_(Eigen::VectorXd::Zero(model_->state_dim()), scenario.disturbance.covariance),
        sensor_(Eigen::VectorXd::Zero(model_->state_dim()), scenario.disturbance.sensor),
        belief_(first_belief()) {
    // Those outside of the program start with the drive, and know of no other situations.
    if (!is_outside(scenario.controller)) rehearse();
  }

  Trace run(const EpisodeOptions& options) {
    options_ = options;
    unsafe_outcome_.reset();
    belief_ = first_belief();
    Trace trace = header_of(scenario_, model_->description(), options_.seed);
    if (!vehicle_digest_) vehicle_digest_ = digest_of(scenario_);
    trace.vehicle_digest = *vehicle_digest_;
    const GaussianSampler initial(belief_.mean, belief_.covariance);
    state_ = initial.sample({.seed = options_.seed, .stream = RandomStream::kInitialState});
    try {
      controller_->reset(options_.seed);
      plant_ = make_plant(scenario_, draw_variation(scenario_.disturbance,
                                                    options_.plant_seed.value_or(options_.seed)));
      trace.outcome = drive(trace);
    } catch (const Interrupted&) {
      trace.outcome = Outcome::kInterrupted;
    } catch (const SimulatorError& error) {
      trace.outcome = Outcome::kFault;
      trace.fault = error.what();
    } catch (const ControllerError& error) {
      trace.outcome = Outcome::kFault;
      trace.fault = error.what();
      trace.fault_of = FaultOf::kController;
    }
    trace.controller_log = controller_->log();
    trace.final_state = state_;
    plant_.reset();
    if (options_.writer != nullptr) options_.writer->finish(trace);
    return trace;
  }

 private:
  [[nodiscard]] controller::Gaussian first_belief() const {
    return {.mean = scenario_.initial_state.mean, .covariance = scenario_.initial_state.covariance};
  }

  [[nodiscard]] Outcome drive(Trace& trace) {
    trace.motion.push_back(plant_->reset(state_));
    std::optional<Outcome> outcome = outcome_now();
    for (int k = 0; !outcome && k < scenario_.step_limit; ++k) {
      if (options_.should_stop && options_.should_stop()) return Outcome::kInterrupted;
      outcome = step(k, trace);
    }
    return outcome.value_or(unsafe_outcome_.value_or(Outcome::kTimeout));
  }

  /// How the episode ends in the present state, if it does.
  [[nodiscard]] std::optional<Outcome> outcome_now() {
    if (!unsafe_outcome_) {
      unsafe_outcome_ = outcome_in(controller::unsafe_part(state_, unsafe_));
    }
    if (scenario_.stop_when_unsafe && unsafe_outcome_) return unsafe_outcome_;
    if (!at_target(scenario_, model_->description(), state_)) return std::nullopt;
    return unsafe_outcome_.value_or(Outcome::kReached);
  }

  std::optional<Outcome> step(int k, Trace& trace) {
    const std::size_t motion_begin = k == 0 ? 0 : trace.motion.size();
    trace.steps.push_back(decide(k));
    StepRecord& record = trace.steps.back();
    const auto start = Clock::now();
    PlantStep result = advance(trace);
    record.timing.simulate = milliseconds_since(start);
    record.clearance_between = least_clearance(result.between, unsafe_);
    record.contact = result.contact;
    if (!result.fault) record.residual = one_step_residual(*model_, record, result.state);
    trace.motion.insert(trace.motion.end(), std::make_move_iterator(result.motion.begin()),
                        std::make_move_iterator(result.motion.end()));
    if (options_.writer != nullptr) {
      options_.writer->append(record, std::span(trace.motion).subspan(motion_begin));
    }
    if (options_.on_step) options_.on_step(trace);
    observe(record, result.state);
    if (result.fault) {
      trace.fault = *result.fault;
      return Outcome::kFault;
    }
    return outcome_now();
  }

  /// Drives the period of the last record, which is dropped where the process is asked to stop.
  PlantStep advance(Trace& trace) {
    try {
      return plant_->advance(trace.steps.back().input, trace.steps.back().disturbance);
    } catch (const Interrupted&) {
      trace.steps.pop_back();
      throw;
    }
  }

  /// Decides and certifies for beliefs like those that will come, and forgets the decisions: what
  /// is slow the first time, tables and memory, is then over before the loop begins.
  void rehearse() {
    const controller::InputBounds& bounds = settings_.problem.bounds;
    const controller::Gaussian later = estimator_->predict(
        estimator_->correct(belief_, belief_.mean), 0.5 * (bounds.lower + bounds.upper));
    for (const Eigen::MatrixXd& covariance : {later.covariance, belief_.covariance}) {
      const controller::Gaussian belief{.mean = belief_.mean, .covariance = covariance};
      for (int n = 0; n < kRehearsals; ++n) {
        const StepRecord record = decide(belief, belief.mean, kRehearsedPeriod);
        // What takes longer than a period anyway is not to be waited for twice.
        if (record.timing.total > kMilliseconds * scenario_.time_step) break;
      }
    }
  }

  /// What is seen of the state in period k.
  [[nodiscard]] Eigen::VectorXd observation(int k) const {
    if (scenario_.disturbance.sensor.isZero(0.0)) return state_;
    return state_ + sensor_.sample({.seed = options_.seed,
                                    .stream = RandomStream::kSensor,
                                    .step = static_cast<std::uint64_t>(k)});
  }

  /// What the controller does in period k, with the disturbance that the plant will have in it.
  [[nodiscard]] StepRecord decide(int k) {
    StepRecord record = decide(belief_, observation(k), k);
    record.state = state_;
    const RandomKey key{.seed = options_.plant_seed.value_or(options_.seed),
                        .stream = RandomStream::kDisturbance,
                        .step = static_cast<std::uint64_t>(k)};
    record.disturbance = disturbance_.sample(key);
    record.residual = unknown_residual(state_.size());
    return record;
  }

  /// The controller's decision, its certificates, and how long both took.
  [[nodiscard]] StepRecord decide(const controller::Gaussian& belief,
                                  const Eigen::VectorXd& observation, int k) {
    StepRecord record;
    record.time = k * scenario_.time_step;
    record.observation = observation;
    record.belief_mean = belief.mean;
    record.belief_covariance = belief.covariance;
    const controller::Situation situation{.period = k,
                                          .time = record.time,
                                          .belief = belief,
                                          .observation = record.observation,
                                          .periods_left = scenario_.step_limit - k,
                                          .deadline = deadline()};
    const controller::Decision& decision = controller_->decide(situation);
    certify(situation, decision, record);
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
    record.timing.quantise = decision.timing.quantise;
    record.timing.propagate = decision.timing.propagate;
    record.timing.optimise = decision.timing.optimise;
    record.timing.total = record.timing.quantise + record.timing.propagate +
                          record.timing.optimise + record.timing.certify;
    return record;
  }

  void certify(const controller::Situation& situation, const controller::Decision& decision,
               StepRecord& record) {
    const auto start = Clock::now();
    const controller::Gaussian posterior =
        estimator_->correct(situation.belief, situation.observation);
    const controller::PredictedMotion motion =
        of_plant(motions_.of(situation, decision, posterior), scenario_, situation.period,
                 decision.policy != nullptr ? BeliefOf::kPrediction : BeliefOf::kState);
    record.budgets = controller::error_budget(motion);
    record.certificates =
        controller::certify(motion, unsafe_, record.budgets, controller::CertificateEffort::kLeast,
                            settings_.problem.run);
    record.timing.certify = milliseconds_since(start);
  }

  [[nodiscard]] Clock::time_point deadline() const {
    const double seconds = scenario_.controller.deadline;
    if (!std::isfinite(seconds)) return Clock::time_point::max();
    return Clock::now() +
           std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

  /// What is known of the next state before it is seen, and then the state itself.
  void observe(const StepRecord& record, const Eigen::VectorXd& next_state) {
    belief_ = estimator_->predict(estimator_->correct(belief_, record.observation), record.input);
    state_ = next_state;
  }

  const Scenario& scenario_;
  controller::UnsafeSet unsafe_;
  std::unique_ptr<const models::Dynamics> model_;
  controller::ControllerSettings settings_;
  std::unique_ptr<controller::Controller> controller_;
  std::unique_ptr<const controller::Estimator> estimator_;
  controller::DecisionMotion motions_;
  GaussianSampler disturbance_;
  GaussianSampler sensor_;
  // Of the episode at hand.
  EpisodeOptions options_;
  std::unique_ptr<Plant> plant_;
  controller::Gaussian belief_;
  std::optional<std::string> vehicle_digest_;  // once it is known
  Eigen::VectorXd state_;
  std::optional<Outcome> unsafe_outcome_;  // what the first unsafe state of it makes of it
};

Trace trace_header(const Scenario& scenario, std::uint64_t seed) {
  Trace header = header_of(scenario, model_of(scenario)->description(), seed);
  header.vehicle_digest = digest_of(scenario);
  return header;
}

EpisodeDriver::EpisodeDriver(const Scenario& scenario) : loop_(std::make_unique<Loop>(scenario)) {}
EpisodeDriver::EpisodeDriver(EpisodeDriver&&) noexcept = default;
EpisodeDriver& EpisodeDriver::operator=(EpisodeDriver&&) noexcept = default;
EpisodeDriver::~EpisodeDriver() = default;

Trace EpisodeDriver::run(const EpisodeOptions& options) { return loop_->run(options); }

Trace run_episode(const Scenario& scenario, const EpisodeOptions& options) {
  return EpisodeDriver(scenario).run(options);
}

}  // namespace qsmpc::harness
