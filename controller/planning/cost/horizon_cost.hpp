// The expected cost of a policy over the horizon and its exact gradient.
//
// With the assignments of a prediction held, the cost is a piecewise smooth function of the nominal
// inputs, and HorizonCost evaluates it and its exact gradient by one pass forward and one backward.
//
// With f_i the stepped points and w the noise, the stage cost of Eq. 4-18 (its first line) is taken
// before this stage's compression, which would lose a part of the second moment:
//     ½ E|x − r|²_Q = ½ Σ_i ρ_i |f_i − r|²_Q + ½ tr(Q Σ_w),
// and the terminal cost (Eq. 4-19) likewise, without the ½. The smooth penalties of the bounds are
// taken there, too, in expectation (expected_bounds.hpp); the others act on the compressed points.
#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "controller/parallel.hpp"
#include "controller/planning/cost/expected_bounds.hpp"
#include "controller/planning/cost/penalty.hpp"
#include "controller/planning/cost/stage_kernels.hpp"
#include "controller/planning/safe_set.hpp"
#include "controller/prediction/policy.hpp"
#include "controller/prediction/prediction.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

/// Weights of Eq. 4-18 and 4-19 about a target state r.
struct QuadraticCost {
  Eigen::MatrixXd state;     ///< Q, state_dim x state_dim
  Eigen::MatrixXd input;     ///< R, input_dim x input_dim
  Eigen::MatrixXd terminal;  ///< Q_term, state_dim x state_dim
  Eigen::VectorXd target;    ///< r, state_dim
  /// States whose target is meant modulo 2π. A planner shifts the target, for each plan, to what is
  /// nearest to the belief's mean; HorizonCost takes it as it is.
  std::vector<int> angles{};
};

/// The parts of the expected cost (Eq. 4-21).
struct CostParts {
  double state = 0.0;
  double input = 0.0;
  double terminal = 0.0;
  double box = 0.0;
  double obstacle = 0.0;
  [[nodiscard]] double total() const { return state + input + terminal + box + obstacle; }
};

/// What the cost depends on besides the prediction; refers to objects that must outlive it.
struct HorizonCostTerms {
  const models::Dynamics& dynamics;
  const SafeSet& safe_set;
  const QuadraticCost& cost;
  const Penalty& penalty;
  const Eigen::MatrixXd& noise_covariance;   ///< zero where the prediction leaves the noise out
  const Eigen::MatrixXd& within_covariance;  ///< of the belief's quantiser, for stage 0
};

class HorizonCost {
 public:
  /// `run` is what loops over many particles go through; results do not depend on it.
  explicit HorizonCost(const HorizonCostTerms& terms, Executor run = run_in_turn);
  HorizonCost(const HorizonCostTerms& terms, const Prediction& prediction, const Policy& policy);
  HorizonCost(const HorizonCostTerms& terms, const Prediction&& prediction,
              const Policy& policy) = delete;

  /// From now on, holds the assignments of `prediction`, which must stay alive and unchanged, and
  /// the gains, bounds and start of `policy`. The covariances and the target are those of the
  /// terms, which may have changed. Allocates only what the last prediction did not need.
  void freeze_assignments(const Prediction& prediction, const Policy& policy);
  void freeze_assignments(const Prediction&& prediction, const Policy& policy) = delete;

  /// Expected cost under the nominal inputs `inputs` (input_dim x horizon) and its gradient with
  /// respect to them (overwritten; same shape, sized by the caller). Where an input saturates, the
  /// derivative of the clamp is zero.
  double evaluate(const Eigen::Ref<const Eigen::MatrixXd>& inputs, Eigen::MatrixXd& gradient);

  /// The same for a decision vector z: the inputs stage by stage, and behind them either nothing
  /// or a matrix ΔK (input_dim x state_dim, column by column) that is added to the gains of all
  /// stages. gradient: as z, sized by the caller.
  double evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& gradient);

  /// The cost alone, of which `parts` tells more.
  double evaluate(const Eigen::VectorXd& z);

  /// Moves the particles to where `z` puts them, unless they are there.
  void rollout(const Eigen::VectorXd& z);

  /// The parts of the value last computed.
  [[nodiscard]] const CostParts& parts() const { return parts_; }

  /// Particles of stage k = 0 … horizon under the decision last evaluated, state_dim x n.
  [[nodiscard]] const Points& particles(Eigen::Index k) const { return stages_[k].points; }

  /// The gradient, with respect to the decision last evaluated, of coordinate `axis` of one
  /// particle of stage k ≥ 1; as in `evaluate`.
  void particle_gradient(Eigen::Index k, Eigen::Index particle, Eigen::Index axis,
                         Eigen::VectorXd& gradient);

 private:
  // Scratch of one stage; stage 0 … horizon.
  struct Stage {
    Points points;   // c
    Points adjoint;  // of c; after a forward pass that of the penalties
    PackedPoints packed_adjoint;
    Points inputs;          // u at the points
    Points input_gradient;  // of the input cost
    Points input_adjoint;
    Points stepped;  // f(c, u)
    PackedPoints packed_stepped;
    Points state_gradient;  // of the state or terminal cost, at f
    Points stepped_adjoint;
    Points pulled;             // of c, through f alone
    Eigen::VectorXd constant;  // v − K x̄
  };
  // What one chunk of particles adds to sums.
  struct Partial {
    CostParts cost;
    PenaltyValue penalty;
    Eigen::VectorXd inputs;  // Σ a
    Eigen::MatrixXd outer;   // Σ a xᵀ
  };

  [[nodiscard]] bool is_rolled_out(const Eigen::VectorXd& z) const {
    return rolled_out_ && std::equal(decision_.begin(), decision_.end(), z.begin(), z.end());
  }
  void resize_stages();
  void set_decision(const Eigen::VectorXd& z);
  void forward(const Eigen::VectorXd& z);
  [[nodiscard]] CostParts forward_sources(Eigen::Index k, ParticleRange range);
  [[nodiscard]] double evaluate_bounds(Eigen::Index k);
  [[nodiscard]] PenaltyValue forward_clusters(Eigen::Index k, ParticleRange range);
  void backward(Eigen::Index from, bool with_cost, Eigen::VectorXd& gradient);
  void backward_sources(Eigen::Index k, bool with_cost, ParticleRange range, Partial& partial);
  void backward_nominal(Eigen::Index k, const double* sum, const double* outer,
                        Eigen::VectorXd& gradient);
  void lone_particle_gradient(Eigen::Index k, Eigen::Index particle, Eigen::Index axis,
                              Eigen::VectorXd& gradient);
  [[nodiscard]] StagePolicy stage_policy(Eigen::Index k) const;

  HorizonCostTerms terms_;
  Executor run_;
  QuadraticForm state_form_;
  QuadraticForm terminal_form_;
  QuadraticForm input_form_;
  PenaltyTable penalties_;          // at the particles
  ExpectedBounds expected_bounds_;  // before noise and compression
  Eigen::VectorXd noise_deviations_;
  const Prediction* prediction_ = nullptr;
  Policy policy_;                       // with the decision last evaluated
  std::vector<Eigen::MatrixXd> gains_;  // as held, without ΔK
  bool with_gain_ = false;              // whether the decision has a ΔK
  bool closed_loop_ = false;            // whether any gain is not zero
  bool lone_ = false;                   // whether no particle ever meets another
  std::vector<double> decision_;        // that the stages belong to …
  bool rolled_out_ = false;             // … if any
  bool penalties_at_hand_ = false;      // whether the adjoints are still those of the penalties
  CostParts parts_;
  double constant_state_cost_ = 0.0;  // noise and quantiser, which no input changes
  double constant_terminal_cost_ = 0.0;
  std::vector<Stage> stages_;
  std::vector<Partial> partials_;
  Eigen::VectorXd flat_;  // scratch of the matrix form of `evaluate`
  Eigen::VectorXd flat_gradient_;
  Eigen::VectorXd nominal_adjoint_;
  Eigen::VectorXd nominal_step_adjoint_;
  Eigen::VectorXd nominal_input_adjoint_;
  Eigen::VectorXd input_sum_;
  Eigen::MatrixXd outer_sum_;
  Eigen::VectorXd lone_adjoint_;
  Eigen::VectorXd lone_next_;
};

}  // namespace qsmpc::controller
