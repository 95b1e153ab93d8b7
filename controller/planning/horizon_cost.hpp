// The expected cost of a policy over the horizon and its exact gradient.
//
// With the assignments of a prediction held, the cost is a piecewise smooth function of the nominal
// inputs, and HorizonCost evaluates it and its exact gradient by one pass forward and one backward.
//
// With f_i the stepped points and w the noise, the stage cost of Eq. 4-18 (its first line) is taken
// before this stage's compression, which would lose a part of the second moment:
//     ½ E|x − r|²_Q = ½ Σ_i ρ_i |f_i − r|²_Q + ½ tr(Q Σ_w),
// and the terminal cost (Eq. 4-19) likewise, without the ½. Penalties act on the compressed points.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/planning/penalty.hpp"
#include "controller/planning/safe_set.hpp"
#include "controller/prediction/policy.hpp"
#include "controller/prediction/prediction.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc {

/// Weights of Eq. 4-18 and 4-19 about a target state r.
struct QuadraticCost {
  Eigen::MatrixXd state;     ///< Q, state_dim x state_dim
  Eigen::MatrixXd input;     ///< R, input_dim x input_dim
  Eigen::MatrixXd terminal;  ///< Q_term, state_dim x state_dim
  Eigen::VectorXd target;    ///< r, state_dim
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

/// What the cost depends on besides the inputs; refers to objects that must outlive it.
struct HorizonCostTerms {
  const Dynamics& dynamics;
  const SafeSet& safe_set;
  const QuadraticCost& cost;
  const Penalty& penalty;
  const Eigen::MatrixXd& noise_covariance;   ///< zero where the prediction leaves the noise out
  const Eigen::MatrixXd& within_covariance;  ///< of the belief's quantiser, for stage 0
};

class HorizonCost {
 public:
  /// Holds the assignments of `prediction` and the gains, bounds and start of `policy`.
  HorizonCost(HorizonCostTerms terms, const Prediction& prediction, const Policy& policy);

  /// Expected cost under the nominal inputs `inputs` (input_dim x horizon) and its gradient with
  /// respect to them (overwritten; same shape, sized by the caller). Where an input saturates, the
  /// derivative of the clamp is zero.
  double evaluate(const Eigen::Ref<const Eigen::MatrixXd>& inputs, Eigen::MatrixXd& gradient);

  /// The parts of the value last computed.
  [[nodiscard]] const CostParts& parts() const { return parts_; }

 private:
  // Scratch of one stage; stage 0 … horizon.
  struct Stage {
    Points points;   // c
    Points adjoint;  // of c
    Points inputs;   // u at the points
    Points input_adjoint;
    Points stepped;          // f(c, u)
    Points stepped_adjoint;  // of f
    Points weighted;         // Q (f − r), or R u: scratch
    Points weighted_inputs;
  };

  void forward(const Eigen::Ref<const Eigen::MatrixXd>& inputs);
  void backward(Eigen::MatrixXd& gradient);
  void backward_policy(Eigen::Index k, Eigen::MatrixXd& gradient);

  HorizonCostTerms terms_;
  const Prediction& prediction_;
  Policy policy_;
  CostParts parts_;
  double constant_state_cost_ = 0.0;  // noise and quantiser, which no input changes
  double constant_terminal_cost_ = 0.0;
  Eigen::VectorXd zero_input_;
  std::vector<Stage> stages_;
  std::vector<StateBatch> nominal_;  // x̄, state_dim x 1 each
  StateBatch nominal_adjoint_;
  StateBatch nominal_step_adjoint_;
  StateBatch nominal_input_;
  StateBatch nominal_input_adjoint_;
};

}  // namespace qsmpc
