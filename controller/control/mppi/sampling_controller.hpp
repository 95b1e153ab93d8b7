// Model predictive path integral control: the inputs of a period are the weighted mean of many
// sampled sequences, with weights from their rollouts' costs. Implements "mppi" and "risk_mppi".
//
// From the inputs u of the last period, shifted by one stage, an iteration draws v = clamp(u + ε),
// ε ~ N(0, Σ) where the standard deviations in Σ are a share of the input range and ε is correlated
// along the horizon; rolls out each sequence; and sets u = Σ w v with w ∝ exp(−S / λ − γ/λ ·
// uᵀΣ⁻¹v), Algorithm 2 of Williams et al. 2018 (see mppi_settings.hpp). The first sample is u
// itself.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "controller/control/controller.hpp"
#include "controller/control/mppi/input_smoothing.hpp"
#include "controller/control/mppi/noise_paths.hpp"
#include "controller/control/mppi/rollouts.hpp"
#include "controller/control/path_cost.hpp"
#include "controller/planning/guide/guide.hpp"

namespace qsmpc::controller {

/// How a sequence's rollouts include noise, and how its cost is computed from them.
enum class SampleNoise {
  kNone,  ///< one rollout without noise
  kOwn,   ///< one rollout, with its own noise realisation
  /// One rollout in each of M noise realisations that all sequences share; the cost is the mean of
  /// the quadratic cost plus the conditional value at risk of the unsafe cost.
  kShared,
};

class SamplingController final : public Controller {
 public:
  /// `dynamics` must outlive it. Throws std::invalid_argument as check_planner_settings and
  /// check_mppi_settings do.
  SamplingController(const models::Dynamics& dynamics, const ControllerSettings& settings,
                     SampleNoise noise);

  [[nodiscard]] static DecisionParts parts(const ControllerSettings& settings) {
    return {.stages = settings.problem.horizon, .cost = true, .status = true};
  }

  const Decision& decide(const Situation& situation) override;
  using Controller::reset;
  void reset(std::uint64_t seed) override;

 private:
  /// A chunk of samples and the results of their rollouts.
  struct Samples {
    SampleChunk chunk;
    Points drift;          // of the perturbations, input_dim x count
    Eigen::ArrayXd cost;   // count
    Eigen::ArrayXd tilt;   // count
    Points unsafe;         // paths x count
    Eigen::VectorXd tail;  // of one sample, paths
  };

  void prepare(const Situation& situation);
  [[nodiscard]] SolverStatus improve(std::chrono::steady_clock::time_point deadline);
  void place_tilt();
  void evaluate(Samples& samples) const;
  void draw(Samples& samples) const;
  void evaluate_in_shared_noise(Samples& samples) const;
  [[nodiscard]] bool take_mean();

  const models::Dynamics& dynamics_;
  PlannerSettings problem_;
  MppiSettings settings_;
  SampleNoise noise_;
  Eigen::VectorXd rest_;        // the feasible inputs nearest to zero
  Eigen::VectorXd deviations_;  // of the perturbations
  Rollouts rollouts_;
  CovarianceRoot belief_root_;
  CovarianceRoot noise_root_;
  std::optional<NoiseDraw> noise_draw_;
  NoisePaths paths_;
  InputSmoothing smoothing_;
  std::vector<Samples> samples_;
  Eigen::MatrixXd slopes_;  // derivative of the tilt by the inputs, input_dim x horizon
  Eigen::ArrayXd costs_;    // S
  Eigen::ArrayXd tilts_;    // S
  Eigen::ArrayXd weights_;  // S
  std::uint64_t seed_ = 0;
  std::uint64_t draws_ = 0;  // number of draws in the drive so far
  bool under_way_ = false;   // whether the inputs come from the last period
  QuadraticCost cost_;       // about the target nearest to the belief, or the guide's aim
  std::optional<Guide> guide_;
  Policy policy_;
  Eigen::MatrixXd shifted_;
  PathCostScratch cost_scratch_;
  Decision decision_;
};

}  // namespace qsmpc::controller
