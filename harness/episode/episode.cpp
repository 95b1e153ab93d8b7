#include "harness/episode/episode.hpp"

#include <chrono>
#include <cmath>
#include <iterator>
#include <memory>
#include <span>
#include <utility>

#include "controller/certification/certificate.hpp"
#include "controller/planning/cost/angular_target.hpp"
#include "controller/planning/planner.hpp"
#include "harness/episode/assembly.hpp"
#include "harness/errors.hpp"
#include "harness/plant/plant_registry.hpp"
#include "harness/random/random_numbers.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/trace_file.hpp"
#include "harness/version.hpp"

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

bool at_target(const Scenario& scenario, const models::SystemDescription& description,
               const Eigen::VectorXd& state) {
  const Eigen::VectorXd offset =
      controller::target_offset(scenario.target.state, scenario.target.angles, state);
  const int x = description.position_x;
  const int y = description.position_y;
  const double distance = x >= 0 && y >= 0 ? std::hypot(offset[x], offset[y]) : offset.norm();
  return distance <= scenario.target.radius;
}

}  // namespace

/// The closed loop's parts and its state between the steps.
class EpisodeDriver::Loop {
 public:
  explicit Loop(const Scenario& scenario)
      : scenario_(scenario),
        model_(model_of(scenario)),
        planner_(*model_, planner_settings(scenario)),
        disturbance_(Eigen::VectorXd::Zero(model_->state_dim()), scenario.disturbance.covariance),
        sensor_(Eigen::VectorXd::Zero(model_->state_dim()), scenario.disturbance.sensor),
        belief_(first_belief()) {
    rehearse();
  }

  Trace run(const EpisodeOptions& options) {
    options_ = options;
    planner_.reset();
    belief_ = first_belief();
    Trace trace = trace_header(scenario_, options_.seed);
    const GaussianSampler initial(belief_.mean, belief_.covariance);
    state_ = initial.sample({.seed = options_.seed, .stream = RandomStream::kInitialState});
    try {
      plant_ = make_plant(scenario_, draw_variation(scenario_.disturbance,
                                                    options_.plant_seed.value_or(options_.seed)));
      trace.outcome = drive(trace);
    } catch (const SimulatorError& error) {
      trace.outcome = Outcome::kFault;
      trace.fault = error.what();
    }
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
    return outcome.value_or(Outcome::kTimeout);
  }

  /// How the episode ends in the present state, if it does.
  [[nodiscard]] std::optional<Outcome> outcome_now() const {
    if (scenario_.stop_when_unsafe && controller::clearance(state_, scenario_.safe_set) <= 0.0) {
      return Outcome::kLeftSafeSet;
    }
    if (at_target(scenario_, model_->description(), state_)) return Outcome::kReached;
    return std::nullopt;
  }

  std::optional<Outcome> step(int k, Trace& trace) {
    const std::size_t motion_begin = k == 0 ? 0 : trace.motion.size();
    trace.steps.push_back(decide(k));
    StepRecord& record = trace.steps.back();
    const auto start = Clock::now();
    PlantStep result = plant_->advance(record.input, record.disturbance);
    record.timing.simulate = milliseconds_since(start);
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

  /// Plans and certifies for beliefs like those that will come, and forgets the plans: what is slow
  /// the first time, tables and memory, is then over before the loop begins.
  void rehearse() {
    const controller::InputBounds& bounds = planner_.settings().bounds;
    const controller::Gaussian later = predicted(belief_.mean, 0.5 * (bounds.lower + bounds.upper));
    for (const Eigen::MatrixXd& covariance : {later.covariance, belief_.covariance}) {
      const controller::Gaussian belief{.mean = belief_.mean, .covariance = covariance};
      for (int n = 0; n < kRehearsals; ++n) {
        const StepRecord record = certified(belief, kRehearsedPeriod, planner_.plan(belief));
        // What takes longer than a period anyway is not to be waited for twice.
        if (record.timing.total > kMilliseconds * scenario_.time_step) break;
      }
    }
  }

  /// The certificates of `plan`, made for `belief` in `period`, and how long both took.
  [[nodiscard]] StepRecord certified(const controller::Gaussian& belief, int period,
                                     const controller::Plan& plan) const {
    const auto start = Clock::now();
    StepRecord record;
    const controller::PredictedMotion motion =
        of_plant(controller::motion_of(planner_, belief, plan), scenario_, period);
    record.budgets = controller::error_budget(motion);
    const controller::PlannerSettings& settings = planner_.settings();
    record.certificates = controller::certify(motion, settings.safe_set, record.budgets,
                                              controller::CertificateEffort::kLeast, settings.run);
    record.timing.certify = milliseconds_since(start);
    record.timing.quantise = plan.timing.quantise;
    record.timing.propagate = plan.timing.propagate;
    record.timing.optimise = plan.timing.optimise;
    record.timing.total = record.timing.quantise + record.timing.propagate +
                          record.timing.optimise + record.timing.certify;
    return record;
  }

  /// What the planner sees of the state in period k.
  [[nodiscard]] Eigen::VectorXd observation(int k) const {
    if (scenario_.disturbance.sensor.isZero(0.0)) return state_;
    return state_ + sensor_.sample({.seed = options_.seed,
                                    .stream = RandomStream::kSensor,
                                    .step = static_cast<std::uint64_t>(k)});
  }

  /// Plans for the belief, certifies the plan, and evaluates its first stage at the observed state.
  [[nodiscard]] StepRecord decide(int k) {
    const controller::Plan& plan = planner_.plan(belief_);
    StepRecord record = certified(belief_, k, plan);
    record.time = k * scenario_.time_step;
    record.state = state_;
    record.observation = observation(k);
    record.input = controller::policy_input(plan.policy, 0, record.observation);
    const RandomKey key{.seed = options_.plant_seed.value_or(options_.seed),
                        .stream = RandomStream::kDisturbance,
                        .step = static_cast<std::uint64_t>(k)};
    record.disturbance = disturbance_.sample(key);
    record.belief_mean = belief_.mean;
    record.belief_covariance = belief_.covariance;
    record.plan_inputs = plan.policy.inputs;
    record.plan_states = plan.policy.states;
    record.cost = plan.cost;
    record.solver_status = controller::solver_status_name(plan.status);
    record.fallback = plan.fallback;
    record.iterations = plan.evaluations;
    record.particles = plan.prediction.stages;
    return record;
  }

  /// What is known of the next state before it is seen, and then the state itself.
  void observe(const StepRecord& record, const Eigen::VectorXd& next_state) {
    belief_ = predicted(record.observation, record.input);
    state_ = next_state;
  }

  /// The law of the next state once y has been seen and u applied: N(f(y, u), A R Aᵀ + Σ_w) with
  /// A = ∂f/∂x at (y, u) and R the sensor's covariance. This takes the state to be N(y, R), which
  /// is what y alone says of it, under a flat prior: what was seen before is left out, which a
  /// filter would weigh in. Of f it is the linearisation; without sensor noise it is exact.
  [[nodiscard]] controller::Gaussian predicted(const Eigen::VectorXd& seen,
                                               const Eigen::VectorXd& applied) const {
    const models::StateBatch state = seen;
    const models::StateBatch input = applied;
    models::StateBatch next(state.rows(), 1);
    model_->step(state, input, next);
    controller::Gaussian belief{.mean = next.col(0),
                                .covariance = scenario_.disturbance.covariance};
    const Eigen::MatrixXd& sensor = scenario_.disturbance.sensor;
    if (sensor.isZero(0.0)) return belief;
    Eigen::MatrixXd by_state(seen.size(), seen.size());
    Eigen::MatrixXd by_input(seen.size(), applied.size());
    model_->jacobians(seen, applied, by_state, by_input);
    const Eigen::MatrixXd carried = by_state * sensor * by_state.transpose();
    belief.covariance += 0.5 * (carried + carried.transpose());  // symmetric to the last bit
    return belief;
  }

  const Scenario& scenario_;
  std::unique_ptr<const models::Dynamics> model_;
  controller::Planner planner_;
  GaussianSampler disturbance_;
  GaussianSampler sensor_;
  // Of the episode at hand.
  EpisodeOptions options_;
  std::unique_ptr<Plant> plant_;
  controller::Gaussian belief_;
  Eigen::VectorXd state_;
};

Trace trace_header(const Scenario& scenario, std::uint64_t seed) {
  Trace trace;
  trace.scenario = scenario;
  trace.scenario.seed = seed;
  trace.scenario_text = to_yaml(trace.scenario);
  trace.seed = seed;
  trace.version = kVersion;
  return trace;
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
