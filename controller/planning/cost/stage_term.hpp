// One term of the expected cost: its value and gradient on the particles of a stage. A term is a
// class, and a line in the table of cost_terms.hpp.
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/parallel.hpp"

namespace qsmpc::controller {

/// Where in a period a term is evaluated.
enum class TermPlace {
  kInputs,     ///< at the particles' inputs
  kStepped,    ///< at the stepped particles, before the noise and the compression
  kParticles,  ///< at the particles of the next stage
};

/// Some particles of one stage.
struct TermBatch {
  Eigen::Index stage = 0;          ///< of the input, or of the state that the step leads to
  const Points& points;            ///< dim x n: inputs or states
  const Eigen::VectorXd& weights;  ///< n
  ParticleRange range;             ///< the particles to process
  Points& gradient;                ///< dim x n
  /// Whether the gradient is still unset in the range, and is overwritten; else it is added to.
  bool blank = false;
  /// kStepped: whether the step compresses nothing, so that each point stands only for itself.
  bool lone = false;
};

/// Zeroes a blank gradient in the range: for terms that only add to it.
inline void clear_if_blank(const TermBatch& batch) {
  if (!batch.blank) return;
  batch.gradient.middleCols(batch.range.begin, batch.range.end - batch.range.begin).setZero();
}

/// What is constant while assignments are held.
struct FrozenHorizon {
  const DiscreteMeasure& belief;             ///< stage 0
  const Eigen::MatrixXd& noise_covariance;   ///< as in the prediction
  const Eigen::MatrixXd& within_covariance;  ///< lost by the belief's quantiser
  Eigen::Index horizon = 1;
};

class StageTerm {
 public:
  virtual ~StageTerm() = default;

  [[nodiscard]] virtual TermPlace place() const = 0;
  /// Whether it contributes at a stage: 0 … horizon − 1 for inputs, else 1 … horizon.
  [[nodiscard]] virtual bool acts(Eigen::Index /*stage*/, Eigen::Index /*horizon*/) const {
    return true;
  }
  /// Whether it needs all particles of a stage at once, and divides them into chunks itself. Only
  /// allowed at kStepped, where such terms come after the others.
  [[nodiscard]] virtual bool needs_all() const { return false; }

  /// Called when assignments are frozen. The references need not outlive the call. Allocates only
  /// when the number of particles is larger than ever before.
  virtual void freeze(const FrozenHorizon& /*frozen*/) {}
  /// The part that no decision changes, over all stages.
  [[nodiscard]] virtual double fixed() const { return 0.0; }

  /// The value over the range, and its gradient. Called concurrently for several ranges unless
  /// needs_all(). run: executor of loops over many particles; no result depends on it.
  virtual double add(const TermBatch& batch, const Executor& run) = 0;
};

}  // namespace qsmpc::controller
