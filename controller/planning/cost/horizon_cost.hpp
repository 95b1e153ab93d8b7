// The expected cost of a policy over the horizon and its exact gradient.
//
// With the assignments of a prediction held fixed, the cost is a piecewise smooth function of the
// nominal inputs. HorizonCost evaluates it and its exact gradient by one forward and one backward
// pass.
//
// The cost is the sum of the terms of cost_terms.hpp, each evaluated at its place in a period: at
// the inputs, at the stepped particles, or at the particles after the compression.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "controller/parallel.hpp"
#include "controller/planning/cost/cost_parts.hpp"
#include "controller/planning/cost/cost_terms.hpp"
#include "controller/planning/cost/stage_kernels.hpp"
#include "controller/planning/cost/stage_slope.hpp"
#include "controller/planning/cost/stage_term.hpp"
#include "controller/prediction/policy.hpp"
#include "controller/prediction/prediction.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

class HorizonCost {
 public:
  /// run: executor of the loops over many particles; results do not depend on it.
  explicit HorizonCost(const HorizonCostTerms& terms, Executor run = run_in_turn);
  HorizonCost(const HorizonCostTerms& terms, const Prediction& prediction, const Policy& policy);
  HorizonCost(const HorizonCostTerms& terms, const Prediction&& prediction,
              const Policy& policy) = delete;

  /// Fixes the assignments to those of `prediction`, which must stay alive and unchanged, and the
  /// gains, bounds and start to those of `policy`. Rereads the covariances and the target of the
  /// terms, which may have changed. Allocates only what the last prediction did not need.
  void freeze_assignments(const Prediction& prediction, const Policy& policy);
  void freeze_assignments(const Prediction&& prediction, const Policy& policy) = delete;

  /// Expected cost under the nominal inputs `inputs` (input_dim x horizon) and its gradient with
  /// respect to them (overwritten; same shape, sized by the caller). Where an input saturates, the
  /// derivative of the clamp is zero.
  double evaluate(const Eigen::Ref<const Eigen::MatrixXd>& inputs, Eigen::MatrixXd& gradient);

  /// The same for a decision vector z: the inputs stage by stage, optionally followed by a matrix
  /// ΔK (input_dim x state_dim, column-major) that is added to the gains of all stages. gradient:
  /// as z, sized by the caller.
  double evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& gradient);

  /// The cost without gradient; `parts` has its parts.
  double evaluate(const Eigen::VectorXd& z);

  /// Rolls out the particles under `z`, unless they are up to date.
  void rollout(const Eigen::VectorXd& z);

  /// The parts of the value last computed.
  [[nodiscard]] const CostParts& parts() const { return parts_; }

  /// Particles of stage k = 0 … horizon under the decision last evaluated, state_dim x n.
  [[nodiscard]] const Points& particles(Eigen::Index k) const { return stages_[k].points; }

  /// The gradient, with respect to the decision last evaluated, of a function of the particles of
  /// stage k ≥ 1 with derivative `slope`; `gradient` as in `evaluate`.
  void pull_back(Eigen::Index k, const StageSlope& slope, Eigen::VectorXd& gradient);

 private:
  // Scratch of one stage; stage 0 … horizon.
  struct Stage {
    Points points;   // c
    Points adjoint;  // of c; after a forward pass, only of the terms at the particles
    PackedPoints packed_adjoint;
    SparseMatrix transposed;  // shares of the map to the next stage, once a gradient is asked for
    Points inputs;            // u at the points
    Points input_gradient;    // of the terms at the inputs
    Points input_adjoint;
    Points stepped;  // f(c, u)
    PackedPoints packed_stepped;
    Points state_gradient;  // of the terms at f
    Points stepped_adjoint;
    Points pulled;             // of c, through f only
    Eigen::VectorXd constant;  // v − K x̄
  };
  // The contributions of one chunk of particles to sums.
  struct Partial {
    CostParts cost;
    Eigen::VectorXd inputs;  // Σ a
    Eigen::MatrixXd outer;   // Σ a xᵀ
  };

  struct Term {
    std::size_t part = 0;  // among cost_parts()
    TermPlace place = TermPlace::kInputs;
    bool needs_all = false;
    std::unique_ptr<StageTerm> term;
  };

  [[nodiscard]] bool is_rolled_out(const Eigen::VectorXd& z) const {
    return rolled_out_ && std::equal(decision_.begin(), decision_.end(), z.begin(), z.end());
  }
  void resize_stages();
  void transpose_maps(Eigen::Index stages);
  void set_decision(const Eigen::VectorXd& z);
  void forward(const Eigen::VectorXd& z);
  [[nodiscard]] CostParts forward_sources(Eigen::Index k, ParticleRange range);
  void add_terms_of_all(Eigen::Index k);
  [[nodiscard]] CostParts forward_clusters(Eigen::Index k, ParticleRange range);
  void backward(Eigen::Index from, bool with_cost, Eigen::VectorXd& gradient);
  void backward_sources(Eigen::Index k, bool with_cost, ParticleRange range, Partial& partial);
  void backward_nominal(Eigen::Index k, const double* sum, const double* outer,
                        Eigen::VectorXd& gradient);
  void pull_back_alone(Eigen::Index k, const StageSlope& slope, Eigen::VectorXd& gradient);
  void add_terms(TermPlace place, TermBatch batch, CostParts& parts) const;
  [[nodiscard]] StagePolicy stage_policy(Eigen::Index k) const;

  HorizonCostTerms terms_;
  Executor run_;
  std::vector<Term> terms_in_use_;  // in the order of the table
  const Prediction* prediction_ = nullptr;
  Policy policy_;                       // with the decision last evaluated
  std::vector<Eigen::MatrixXd> gains_;  // as held, without ΔK
  bool with_gain_ = false;              // whether the decision has a ΔK
  bool closed_loop_ = false;            // whether any gain is not zero
  bool lone_ = false;                   // whether no step compresses the particles
  std::vector<double> decision_;        // that the stages are rolled out for …
  bool rolled_out_ = false;             // … if any
  Eigen::Index transposed_ = 0;         // maps whose transposes the stages have
  bool adjoints_at_hand_ = false;       // whether the adjoints are still those of the terms
  CostParts parts_;
  CostParts fixed_;  // the part that no decision changes
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
