// Upper bounds of the probability that the state is unsafe, stage by stage of a plan.
//
// Each bound holds for the law of the model under the plan's policy from the plan's belief, and of
// every plant whose error is within the motion's model error, where it has one:
//   C1  worst case over the W2 ball about the particles,
//   C2  the same before the last noise, which stays Gaussian,
//   C3  a Gaussian surrogate of the state, with a bound of what separates the two,
//   C4  the same, smoothed by noise that is independent of this error.
// Proofs: docs/theory/certificates.md and surrogate.md. A bound says nothing of any other plant,
// and one of a later stage speaks of the plan as planned, not of what is planned anew in between.
#pragma once

#include <string>
#include <vector>

#include "controller/certification/error_budget.hpp"
#include "controller/parallel.hpp"
#include "controller/planning/safe_set.hpp"
#include "controller/prediction/prediction.hpp"

namespace qsmpc::controller {

struct StageCertificate {
  double value = 1.0;        ///< the least of the bounds
  std::string kind;          ///< which one it was: "c1", "c2", "c3" or "c4"
  double particles = 1.0;    ///< C1
  double mixture = 1.0;      ///< C2
  double surrogate = 1.0;    ///< C3; 1 where nothing is known of the derivatives
  double smoothed = 1.0;     ///< C4; never above C3
  double thesis = 1.0;       ///< Algorithms 3 and 4 as printed: NOT a bound
  double unsafe_mass = 0.0;  ///< weight of the particles that are unsafe: NOT a bound
};

/// How far each bound is worked out.
enum class CertificateEffort {
  kLeast,  ///< for control: C2 only where it can be the least (else it is 1), C3 and C4 without the
           ///< searches that could save no more than 1e-4 for a part of the unsafe set
  kEvery,  ///< each as good as it gets, for comparisons
};

/// Certificates of stages 1 … horizon of `motion`.
/// budgets: what `error_budget` gives for it. run: what the stages, which do not depend on one
/// another, are divided among; no result depends on it.
[[nodiscard]] std::vector<StageCertificate> certify(
    const PredictedMotion& motion, const SafeSet& safe_set, const std::vector<StageBudget>& budgets,
    CertificateEffort effort = CertificateEffort::kLeast, const Executor& run = run_in_turn);

/// The radii that the thesis would use at stages 0 … horizon, by Eq. 4-4 and 4-6: without noise and
/// without the feedback, hence too small. Where no global Lipschitz constant is known, it is that
/// of the closed loop on its region. budgets: as for `certify`.
[[nodiscard]] std::vector<double> thesis_radii(const PredictedMotion& motion,
                                               const std::vector<StageBudget>& budgets);

/// Upper bound of the probability that the state is unsafe at any of the stages: their sum, at
/// most 1.
[[nodiscard]] double horizon_bound(const std::vector<StageCertificate>& certificates);

}  // namespace qsmpc::controller
