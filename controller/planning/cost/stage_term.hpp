// One term of the expected cost: its value and gradient on the particles of a stage. A term is a
// class, and a line in the table of cost_terms.hpp.
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/parallel.hpp"

namespace qsmpc::controller {

/// Where in a period a term looks.
enum class TermPlace {
  kInputs,     ///< at the particles' inputs
  kStepped,    ///< at where the step takes the particles, before the noise and the compression
  kParticles,  ///< at the particles of the next stage
};

/// Some particles of one stage.
struct TermBatch {
  Eigen::Index stage = 0;          ///< of the input, or of the state that the step leads to
  const Points& points;            ///< dim x n: inputs or states
  const Eigen::VectorXd& weights;  ///< n
  ParticleRange range;             ///< those that are meant
  Points& gradient;                ///< dim x n
  /// Whether the gradient holds nothing in the range, and is overwritten; else it is added to.
  bool blank = false;
  /// kStepped: whether each point stands for itself alone, as no compression has made them.
  bool lone = false;
};

/// Zero in the range where there is nothing: for terms that add to the gradient.
inline void clear_if_blank(const TermBatch& batch) {
  if (!batch.blank) return;
  batch.gradient.middleCols(batch.range.begin, batch.range.end - batch.range.begin).setZero();
}

/// What does not change while assignments are held.
struct FrozenHorizon {
  const DiscreteMeasure& belief;             ///< stage 0
  const Eigen::MatrixXd& noise_covariance;   ///< as in the prediction
  const Eigen::MatrixXd& within_covariance;  ///< that the belief's quantiser has lost
  Eigen::Index horizon = 1;
};

class StageTerm {
 public:
  virtual ~StageTerm() = default;

  [[nodiscard]] virtual TermPlace place() const = 0;
  /// Whether it has anything to say of a stage: 0 … horizon − 1 for inputs, else 1 … horizon.
  [[nodiscard]] virtual bool acts(Eigen::Index /*stage*/, Eigen::Index /*horizon*/) const {
    return true;
  }
  /// Whether it has to see all particles of a stage at once, and divides them into chunks itself.
  /// Only terms at kStepped may; they come after the others there.
  [[nodiscard]] virtual bool needs_all() const { return false; }

  /// From now on these are held. What is referred to need not outlive the call. Allocates only for
  /// more particles than ever before.
  virtual void freeze(const FrozenHorizon& /*frozen*/) {}
  /// What no decision changes, of all stages together.
  [[nodiscard]] virtual double fixed() const { return 0.0; }

  /// The value over the range, and its gradient. Called side by side for several ranges unless
  /// needs_all(); `run` is what loops over many particles go through, and no result depends on it.
  virtual double add(const TermBatch& batch, const Executor& run) = 0;
};

}  // namespace qsmpc::controller
