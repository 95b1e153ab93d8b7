#include "controller/control/mppi/sampling_controller.hpp"

#include <algorithm>
#include <cmath>

#include "controller/control/mppi/sample_weights.hpp"
#include "controller/planning/guide/guided_target.hpp"
#include "controller/planning/start/first_guess.hpp"
#include "models/constants.hpp"
#include "models/random/random_numbers.hpp"

namespace qsmpc::controller {
namespace {

using Clock = std::chrono::steady_clock;

// Samples per task: few enough for their states to stay in the L1 cache.
constexpr Eigen::Index kSampleChunk = 128;

PlannerSettings checked(const models::Dynamics& dynamics, const ControllerSettings& settings) {
  check_planner_settings(settings.problem, dynamics.state_dim(), dynamics.input_dim());
  check_mppi_settings(settings.mppi);
  return settings.problem;
}

UnsafeCost unsafe_cost(const MppiSettings& settings, const Penalty& penalty, SampleNoise noise) {
  Penalty otherwise;
  if (noise != SampleNoise::kShared) {
    otherwise.obstacle = MppiSettings::kFirmness * penalty.obstacle;
    otherwise.length = penalty.length;
  }
  return {.collision = settings.obstacle_cost,
          .proximity = settings.proximity_cost.value_or(otherwise.obstacle),
          .margin = settings.margin.value_or(otherwise.length)};
}

int chunk_count(int samples) {
  return static_cast<int>((samples + kSampleChunk - 1) / kSampleChunk);
}

}  // namespace

SamplingController::SamplingController(const models::Dynamics& dynamics,
                                       const ControllerSettings& settings, SampleNoise noise)
    : dynamics_(dynamics),
      problem_(checked(dynamics, settings)),
      settings_(settings.mppi),
      noise_(noise),
      rest_(resting_input(problem_.bounds)),
      deviations_(settings_.spread * (problem_.bounds.upper - problem_.bounds.lower)),
      rollouts_(dynamics, problem_, unsafe_cost(settings_, problem_.penalty, noise)),
      paths_(noise == SampleNoise::kShared ? settings_.noise_paths : 0, problem_.horizon,
             dynamics.state_dim()),
      smoothing_(settings_.smoothing, rest_),
      slopes_(dynamics.input_dim(), problem_.horizon),
      costs_(settings_.samples),
      tilts_(Eigen::ArrayXd::Zero(settings_.samples)),
      weights_(settings_.samples),
      cost_(problem_.cost),
      guide_(make_guide(dynamics, problem_)) {
  for (int n = 0; n < chunk_count(settings_.samples); ++n) {
    const Eigen::Index count =
        std::min<Eigen::Index>(kSampleChunk, settings_.samples - n * kSampleChunk);
    samples_.push_back({.chunk = SampleChunk(n, count, dynamics.state_dim(), dynamics.input_dim(),
                                             problem_.horizon),
                        .drift = Points(dynamics.input_dim(), count),
                        .cost = Eigen::ArrayXd(count),
                        .tilt = Eigen::ArrayXd(count),
                        .unsafe = Points(paths_.count(), count),
                        .tail = Eigen::VectorXd(paths_.count())});
  }
  policy_.bounds = problem_.bounds;
  policy_.gains.assign(static_cast<std::size_t>(problem_.horizon),
                       Eigen::MatrixXd::Zero(dynamics.input_dim(), dynamics.state_dim()));
  reset(0);
}

void SamplingController::reset(std::uint64_t seed) {
  seed_ = seed;
  draws_ = 0;
  policy_.inputs = rest_.replicate(1, problem_.horizon);
  smoothing_.reset();
  under_way_ = false;
}

const Decision& SamplingController::decide(const Situation& situation) {
  const auto begin = Clock::now();
  check_situation(situation, dynamics_.state_dim());
  prepare(situation);
  decision_.evaluations = 1;
  decision_.status = improve(situation.deadline);
  smoothing_.smooth(policy_.inputs);
  clamp_inputs(policy_.bounds, policy_.inputs);
  nominal_states(dynamics_, situation.belief.mean, policy_.inputs, policy_.states);
  // Inputs whose path is not finite cannot warm-start the next period.
  under_way_ = policy_.states.allFinite();
  if (!under_way_) decision_.status = SolverStatus::kNumericalTrouble;
  decision_.input = policy_.inputs.col(0);
  smoothing_.note_applied(decision_.input);
  decision_.policy = &policy_;
  decision_.cost = path_cost(policy_, cost_, cost_scratch_);
  decision_.timing = {.optimise =
                          std::chrono::duration<double, std::milli>(Clock::now() - begin).count()};
  return decision_;
}

/// Sets the initial inputs, targets and noise of the period.
void SamplingController::prepare(const Situation& situation) {
  const Gaussian& belief = situation.belief;
  if (under_way_) {
    shift_inputs(policy_.inputs, shifted_);
    std::swap(policy_.inputs, shifted_);
  } else {
    policy_.inputs = rest_.replicate(1, problem_.horizon);
  }
  place_guided_target(guide_, problem_, dynamics_.description(), belief.mean, situation.progress,
                      cost_);
  rollouts_.place(belief.mean, cost_);
  if (noise_ != SampleNoise::kNone) {
    noise_draw_.emplace(NoiseDraw{.start_root = belief_root_.of(belief.covariance),
                                  .step_root = noise_root_.of(problem_.noise_covariance),
                                  .seed = seed_});
  }
}

SolverStatus SamplingController::improve(Clock::time_point deadline) {
  for (int n = 0; n < settings_.iterations; ++n) {
    ++draws_;
    if (noise_draw_) noise_draw_->draw = draws_;
    if (noise_ == SampleNoise::kShared && n == 0) paths_.draw(*noise_draw_);
    place_tilt();
    problem_.run(static_cast<int>(samples_.size()), [&](int task) {
      Samples& samples = samples_[static_cast<std::size_t>(task)];
      if (Clock::now() < deadline) {
        evaluate(samples);
      } else {
        samples.cost.setConstant(kInfinity);
        samples.tilt.setZero();
      }
    });
    if (!take_mean()) {
      return Clock::now() < deadline ? SolverStatus::kNumericalTrouble : SolverStatus::kDeadline;
    }
    if (Clock::now() >= deadline) return SolverStatus::kDeadline;
  }
  return SolverStatus::kIterationLimit;
}

/// Sets `slopes_` to the derivative of γ/λ · uᵀΣ⁻¹v by v: with a(k) = (u(k) − ρ u(k−1)) / ((1 − ρ²)
/// σ²), but a(0) = u(0) / σ² at the first stage, the entries are γ/λ (a(k) − ρ a(k+1)).
void SamplingController::place_tilt() {
  const double keep = settings_.correlation;
  const Eigen::Index horizon = slopes_.cols();
  for (Eigen::Index j = 0; j < slopes_.rows(); ++j) {
    const double scale = settings_.control_term / (deviations_[j] * deviations_[j]);
    double later = 0.0;
    for (Eigen::Index k = horizon - 1; k >= 0; --k) {
      const double input = policy_.inputs(j, k);
      const double innovation =
          k == 0 ? input : (input - keep * policy_.inputs(j, k - 1)) / (1.0 - keep * keep);
      slopes_(j, k) = scale * (innovation - keep * later);
      later = innovation;
    }
  }
}

/// Draws and rolls out a chunk of samples.
void SamplingController::evaluate(Samples& samples) const {
  draw(samples);
  SampleChunk& chunk = samples.chunk;
  samples.cost.setZero();
  rollouts_.add_input_cost(chunk, samples.cost);
  if (noise_ == SampleNoise::kShared) {
    evaluate_in_shared_noise(samples);
  } else {
    rollouts_.roll_out({.own = noise_ == SampleNoise::kOwn ? &*noise_draw_ : nullptr}, chunk);
    samples.cost += chunk.quadratic + chunk.unsafe;
  }
  for (double& cost : samples.cost) {
    if (!std::isfinite(cost)) cost = kInfinity;
  }
}

/// Draws the chunk's inputs, and computes their tilts.
void SamplingController::draw(Samples& samples) const {
  SampleChunk& chunk = samples.chunk;
  const Eigen::Index inputs = slopes_.rows();
  models::standard_normals({.seed = seed_,
                            .episode = static_cast<std::uint64_t>(chunk.number),
                            .stream = models::RandomStream::kSampledInputs,
                            .step = draws_},
                           {chunk.inputs.data(), static_cast<std::size_t>(chunk.inputs.size())});
  // The first sample is the nominal inputs themselves.
  if (chunk.number == 0) chunk.inputs.col(0).setZero();
  const double keep = settings_.correlation;
  samples.drift.setZero();
  samples.tilt.setZero();
  for (Eigen::Index row = 0; row < chunk.inputs.rows(); ++row) {
    const Eigen::Index stage = row / inputs;
    const Eigen::Index j = row % inputs;
    draw_inputs({.nominal = policy_.inputs(j, stage),
                 .deviation = deviations_[j],
                 .lower = problem_.bounds.lower[j],
                 .upper = problem_.bounds.upper[j],
                 .keep = stage == 0 ? 0.0 : keep,
                 .add = stage == 0 ? 1.0 : std::sqrt(1.0 - keep * keep)},
                chunk.count(), samples.drift.row(j).data(), chunk.inputs.row(row).data());
    if (settings_.control_term > 0.0) {
      samples.tilt += slopes_(j, stage) * chunk.inputs.row(row).transpose().array();
    }
  }
}

void SamplingController::evaluate_in_shared_noise(Samples& samples) const {
  SampleChunk& chunk = samples.chunk;
  const double share = 1.0 / static_cast<double>(paths_.count());
  for (Eigen::Index n = 0; n < paths_.count(); ++n) {
    rollouts_.roll_out({.path = &paths_.path(n)}, chunk);
    samples.cost += share * chunk.quadratic;
    samples.unsafe.row(n) = chunk.unsafe.transpose();
  }
  for (Eigen::Index i = 0; i < chunk.count(); ++i) {
    samples.tail = samples.unsafe.col(i);
    samples.cost[i] += conditional_value_at_risk(
        {samples.tail.data(), static_cast<std::size_t>(samples.tail.size())}, settings_.cvar);
  }
}

/// Sets the inputs to the weighted mean of the samples. Returns whether any sample has a finite
/// cost.
bool SamplingController::take_mean() {
  for (std::size_t n = 0; n < samples_.size(); ++n) {
    const Samples& samples = samples_[n];
    const Eigen::Index begin = static_cast<Eigen::Index>(n) * kSampleChunk;
    costs_.segment(begin, samples.cost.size()) = samples.cost;
    tilts_.segment(begin, samples.cost.size()) = samples.tilt;
  }
  const SampleCosts samples{.cost = costs_, .tilt = tilts_};
  const double rolled_out = static_cast<double>((costs_ < kInfinity).count());
  if (rolled_out == 0.0) return false;
  const double temperature =
      settings_.temperature > 0.0
          ? settings_.temperature
          : effective_temperature(samples, settings_.effective_share * rolled_out, weights_);
  if (softmin_weights(samples, temperature, weights_) == 0.0) return false;
  const Eigen::Index inputs = policy_.inputs.rows();
  for (Eigen::Index row = 0; row < policy_.inputs.size(); ++row) {
    double mean = 0.0;
    for (const Samples& part : samples_) {
      mean +=
          weighted_total(part.chunk.inputs.row(row).data(),
                         weights_.data() + part.chunk.number * kSampleChunk, part.chunk.count());
    }
    policy_.inputs(row % inputs, row / inputs) = mean;
  }
  clamp_inputs(policy_.bounds, policy_.inputs);
  decision_.evaluations += static_cast<int>(rolled_out);
  return true;
}

}  // namespace qsmpc::controller
