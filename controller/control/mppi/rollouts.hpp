// The costs of sampled input sequences: rolls out the model under each, a chunk of samples at a
// time.
//
// The cost of a path is the scenario's quadratic cost about the target, as in path_cost, plus, at
// each stage after the present one, the unsafe cost at the body's clearance. The cost of the
// present state, which no input changes, is left out.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/control/mppi/noise_paths.hpp"
#include "controller/control/mppi/sample_kernels.hpp"
#include "controller/measure/measures.hpp"
#include "controller/planning/cost/stage_kernels.hpp"
#include "controller/planning/planner_settings.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

/// One chunk of samples, and the scratch of its rollouts.
struct SampleChunk {
  SampleChunk(int place, Eigen::Index samples, Eigen::Index state_dim, Eigen::Index input_dim,
              Eigen::Index horizon);

  int number;     ///< its index among the chunks
  Points inputs;  ///< (horizon · input_dim) x count: input j of stage k in row k · input_dim + j
  Points states;  ///< state_dim x count
  Points next;
  Points centres;
  Points normals;
  Eigen::ArrayXd clearances;  ///< count
  Eigen::ArrayXd quadratic;   ///< of the rollout, count
  Eigen::ArrayXd unsafe;      ///< of the rollout, count

  [[nodiscard]] Eigen::Index count() const { return inputs.cols(); }
};

/// The noise of a rollout; none where both are null.
struct RolloutNoise {
  const Eigen::MatrixXd* path = nullptr;  ///< the same for all samples, as in NoisePaths
  const NoiseDraw* own = nullptr;         ///< drawn for each sample
};

class Rollouts {
 public:
  /// `dynamics` must outlive it.
  Rollouts(const models::Dynamics& dynamics, const PlannerSettings& problem,
           const UnsafeCost& unsafe_cost);

  /// Sets the start of the rollouts and the targets that their cost is about.
  void place(const Eigen::VectorXd& start, const QuadraticCost& cost);

  /// Adds Σ uᵀRu of the chunk's inputs to `totals` (count).
  void add_input_cost(const SampleChunk& chunk, Eigen::ArrayXd& totals) const;

  /// Rolls out the chunk's inputs, and sets `quadratic` and `unsafe` to the costs of the paths.
  void roll_out(const RolloutNoise& noise, SampleChunk& chunk) const;

 private:
  void add_noise(const RolloutNoise& noise, int stage, SampleChunk& chunk) const;
  void add_unsafe(int stage, SampleChunk& chunk) const;
  [[nodiscard]] Eigen::Map<const Points> inputs_of(const SampleChunk& chunk, int stage) const;

  const models::Dynamics& dynamics_;
  int horizon_;
  Eigen::Index input_dim_;
  std::vector<QuadraticForm> state_;  // one for all stages, or one per stage
  QuadraticForm input_;
  QuadraticForm terminal_;
  UnsafeSet unsafe_;
  UnsafeCost unsafe_cost_;
  Eigen::VectorXd start_;
};

}  // namespace qsmpc::controller
