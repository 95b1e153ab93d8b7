// Upper bounds of the probability that the state is unsafe, stage by stage of a plan.
//
// Each bound holds for the law of the model under the plan's policy from the plan's belief, and of
// every plant whose error is within the motion's model error, where it has one. Proofs:
// docs/theory/certificates.md and surrogate.md. A bound says nothing of any other plant, and one of
// a later stage speaks of the plan as planned, not of what is planned anew in between.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "controller/certification/error_budget.hpp"
#include "controller/parallel.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/regions/unsafe_set.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// How far each bound is worked out.
enum class CertificateEffort {
  kLeast,  ///< for control: no C5, C2 only where it can be the least (else it is 1), C3 and C4
           ///< without the searches that could save no more than 1e-4 for a part of the unsafe set
  kEvery,  ///< each as good as it gets, for comparisons
};

class CertificateProblem;

/// A number of stage k + 1. `least` is the least bound of that stage so far: what cannot be less
/// need not be worked out. Called side by side for several stages.
using StageFigure = std::function<double(std::size_t k, double least)>;

/// One bound, or a number that is shown beside the bounds; a new one is a file, and a line in the
/// table.
struct CertificateEntry {
  std::string key;      ///< "c1"; what StageCertificate::kind and JSON call it
  std::string dataset;  ///< "particles"; in a trace's group /certificate
  std::string meaning;
  bool is_bound = true;    ///< whether it counts: NOT an upper bound otherwise
  bool is_last = false;    ///< whether it comes after all others, as it is told the least
  bool in_control = true;  ///< whether it is worked out with the effort for control, too
  double without = 1.0;    ///< where it is not known, as in traces from before it was there
  StageFigure (*prepare)(const CertificateProblem& problem) = nullptr;
};

/// The table, in which the simplest of equal bounds comes first.
[[nodiscard]] const std::vector<CertificateEntry>& certificate_entries();

/// The place of `key` in the table. Throws std::invalid_argument if there is none.
[[nodiscard]] std::size_t certificate_index(std::string_view key);

struct StageCertificate {
  double value = 1.0;           ///< the least of the bounds
  std::string kind;             ///< which one it was, the first in the table that is as small
  std::vector<double> figures;  ///< as certificate_entries(); empty where only the value is known

  /// The figure called `key`, or what stands for it where it is not known. Throws
  /// std::invalid_argument on an unknown key.
  [[nodiscard]] double of(std::string_view key) const;
};

/// One without anything known: 1, and what stands for each figure.
[[nodiscard]] StageCertificate blank_certificate();

/// Certificates of stages 1 … horizon of `motion`.
/// budgets: what `error_budget` gives for it. run: what the stages, which do not depend on one
/// another, are divided among; no result depends on it.
[[nodiscard]] std::vector<StageCertificate> certify(
    const PredictedMotion& motion, const UnsafeSet& unsafe, const std::vector<StageBudget>& budgets,
    CertificateEffort effort = CertificateEffort::kLeast, const Executor& run = run_in_turn);

/// Upper bound of the probability that the state is unsafe at any of the stages: the sum of the
/// stages' bounds or of what each adds ("entry"), whichever is less, at most 1. 0 for no stages.
[[nodiscard]] double horizon_bound(const std::vector<StageCertificate>& certificates);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
