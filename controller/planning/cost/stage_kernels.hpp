// The loops over the particles of one stage, except those of the system: policy and quadratic
// costs, forwards and backwards, for the processor's widest vectors. Each works only on the
// particles begin … end − 1, so that several threads can share a stage.
#pragma once

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/parallel.hpp"

namespace qsmpc::controller {

/// One stage of a policy in the form that the loops use: u = clamp(constant + K x).
struct StagePolicy {
  const double* constant = nullptr;  ///< v − K x̄, input_dim
  const double* gain = nullptr;      ///< K, input_dim x state_dim, column-major
  const double* lower = nullptr;     ///< input_dim
  const double* upper = nullptr;     ///< input_dim
  bool closed_loop = false;          ///< whether K has an entry that is not zero
};

/// inputs = clamp(constant + K x). states: state_dim x n; inputs: input_dim x n.
void apply_policy(const StagePolicy& policy, const Points& states, ParticleRange range,
                  Points& inputs);

/// Reverse mode: adds Kᵀ a to `state_adjoint`, a being the input's adjoint where the clamp is not
/// active and 0 where it is (everywhere `a` in open loop, where the clamp never is). Adds Σ a to
/// `sum` (input_dim) and, unless null, Σ a xᵀ to `outer` (input_dim x state_dim, column-major).
void pullback_policy(const StagePolicy& policy, const Points& states, const Points& inputs,
                     const Points& input_adjoint, ParticleRange range, Points& state_adjoint,
                     double* sum, double* outer);

/// A quadratic form about a centre, in the form that the loops use.
struct QuadraticForm {
  /// Symmetric matrix (d x d) and centre (d).
  QuadraticForm(const Eigen::MatrixXd& symmetric, const Eigen::VectorXd& about);

  Eigen::MatrixXd matrix;
  Eigen::VectorXd centre;
  bool diagonal = false;
};

/// Whether a gradient is overwritten or added to.
enum class GradientUse { kOverwrite, kAdd };

/// factor · Σ ρ_i (x_i − r)ᵀW(x_i − r); its gradient 2 factor ρ_i W (x_i − r) goes into `gradient`
/// (d x n).
double weighted_quadratic(const QuadraticForm& form, double factor, const Points& points,
                          const Eigen::VectorXd& weights, ParticleRange range, Points& gradient,
                          GradientUse use = GradientUse::kOverwrite);

/// a += b in the range.
void add_points(const Points& b, ParticleRange range, Points& a);

}  // namespace qsmpc::controller
