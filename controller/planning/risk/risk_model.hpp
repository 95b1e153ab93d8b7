// The certified risk of each stage as a smooth function of a plan's decision, with an exact
// gradient; the optimiser constrains it between two certifications. Derivation:
// docs/theory/planning.md, "Risk".
//
// From a plan's surrogate it holds, for each stage, the offset of the mean from the noise-free
// path, the covariance (a function of the gain change, if that is part of the decision), the
// linearised rotation of each disc, and the factor that scales the tails to the certificate. Only
// the noise-free path varies.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/certification/surrogate_bounds.hpp"
#include "controller/measure/measures.hpp"
#include "controller/prediction/policy.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

class RiskModel {
 public:
  /// Keeps references to both.
  RiskModel(const models::Dynamics& dynamics, const UnsafeSet& unsafe);

  /// Holds the surrogate of `motion`. The factors are unchanged.
  void hold(const PredictedMotion& motion, const std::vector<SurrogateStage>& surrogates);
  /// Scales the risks so that at the held plan they equal the certificates (stages 1 … horizon);
  /// where these are 1, the risks measure the depth.
  void calibrate(const std::vector<double>& certified);
  /// Shifts the factors by one stage, as the plan moves on: each stage takes those of the next.
  void shift_factors();
  /// All factors become 1.
  void forget_factors();

  /// Risks of stages 1 … horizon for a decision as in HorizonCost: inputs stage by stage,
  /// optionally followed by a change of all gains. ≥ 0; more than 1 deep in the unsafe set.
  const Eigen::VectorXd& risks(const Eigen::VectorXd& z);
  /// The last result of `risks`.
  [[nodiscard]] const Eigen::VectorXd& last_risks() const { return risks_; }
  /// Adds Σ_k weights_k ∂risk_k/∂z at the decision of the last call of `risks`.
  void add_gradient(const Eigen::VectorXd& weights, Eigen::VectorXd& gradient);

  [[nodiscard]] Eigen::Index horizon() const { return static_cast<Eigen::Index>(held_.size()); }

 private:
  /// Stage k + 1, and the step to it.
  struct Held {
    Eigen::VectorXd shift;                 ///< offset of the mean from the noise-free path
    Eigen::MatrixXd covariance;            ///< with unchanged gains
    Eigen::MatrixXd transition;            ///< of the step
    Eigen::MatrixXd by_gain;               ///< of the step: B times the slopes of the clamps
    std::vector<double> reach;             ///< of each disc, shrunk by the heading's spread
    std::vector<Eigen::MatrixXd> turn;     ///< of each disc: its law's covariance is turn S turnᵀ
    std::vector<Gaussian> laws;            ///< of each disc; the mean is set on evaluation
    std::vector<Eigen::VectorXd> centres;  ///< means of the discs' laws at the held plan
    std::vector<std::vector<double>>
        silent;          ///< distance_without_tail of each disc's regions there
    bool finite = true;  ///< whether their covariances are
  };
  /// The ingredients of a risk at the current decision.
  struct Evaluated {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
    Eigen::VectorXd by_mean;
    Eigen::MatrixXd by_covariance;
    double tails = 0.0;
    bool by_gains = false;  ///< whether the covariance depends on the decision
  };

  void hold_discs(Eigen::Index stage, const Gaussian& law, Held& held) const;
  void roll_out(const Eigen::VectorXd& z);
  void add_tails(Eigen::Index k);
  void add_disc_tails(Eigen::Index k, std::size_t disc);
  void pull_back_gains(const Eigen::VectorXd& weights, Eigen::VectorXd& gradient);

  const models::Dynamics& dynamics_;
  const UnsafeSet& unsafe_;
  std::vector<Held> held_;
  std::vector<Evaluated> stages_;
  Eigen::VectorXd factors_;
  Eigen::VectorXd floors_;
  Eigen::VectorXd leaving_;
  Eigen::MatrixXd first_covariance_;
  Eigen::MatrixXd noise_;
  Eigen::VectorXd start_;
  Eigen::VectorXd decision_;  // current; empty if none
  Eigen::VectorXd held_decision_;
  Eigen::Index inputs_ = 0;
  models::StateBatch path_;  // the noise-free path, one column per stage
  Eigen::VectorXd risks_;
  TailSum tails_;
  Gaussian changed_law_;  // of a disc, under changed gains
  // Scratch of the backward pass, one column each.
  models::StateBatch state_;
  models::StateBatch input_;
  models::StateBatch next_;
  models::StateBatch adjoint_;
  models::StateBatch state_adjoint_;
  models::StateBatch input_adjoint_;
};

}  // namespace qsmpc::controller
