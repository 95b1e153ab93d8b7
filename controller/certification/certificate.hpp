// Upper bounds of the probability that the state is unsafe, stage by stage of a plan.
//
// Each bound holds for the law of the model under the plan's policy from the plan's belief and,
// where the motion has a model error, for every plant whose error is within it. Proofs:
// docs/theory/certificates.md and surrogate.md. A bound says nothing about any other plant, and the
// bound of a later stage refers to the plan as planned, without replanning in between.
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

/// How much effort goes into each bound.
enum class CertificateEffort {
  kLeast,  ///< for control: no C5, C2 only where it can be the least (else 1), C4 without searches
           ///< that could gain at most 1e-4 for a part of the unsafe set, C3 as far as it lowers C4
  kEvery,  ///< every bound, for comparisons of many plans
  kTightest,  ///< every bound as tight as possible, for one plan: seconds where C5 helps
};

class CertificateProblem;

/// A figure of stage k + 1. `least` is the least bound of that stage so far: a bound that cannot be
/// less need not be computed. Called concurrently for several stages.
using StageFigure = std::function<double(std::size_t k, double least)>;

/// One bound, or a figure reported with the bounds. A new one takes a file and a line in the table.
struct CertificateEntry {
  std::string key;      ///< e.g. "c1"; its name in StageCertificate::kind and JSON
  std::string dataset;  ///< e.g. "particles"; in a trace's group /certificate
  std::string meaning;
  bool is_bound = true;    ///< whether it counts as a bound: NOT an upper bound otherwise
  bool is_last = false;    ///< whether it is computed after all others, as it uses `least`
  bool in_control = true;  ///< whether it is also computed with the effort for control
  double without = 1.0;    ///< value where it is unknown, as in traces older than the entry
  StageFigure (*prepare)(const CertificateProblem& problem) = nullptr;
};

/// The table of figures. Of bounds that may be equal, the simplest comes first.
[[nodiscard]] const std::vector<CertificateEntry>& certificate_entries();

/// The index of `key` in the table. Throws std::invalid_argument if there is none.
[[nodiscard]] std::size_t certificate_index(std::string_view key);

struct StageCertificate {
  double value = 1.0;           ///< the least of the bounds
  std::string kind;             ///< key of the least bound, the first in the table among equals
  std::vector<double> figures;  ///< as certificate_entries(); empty if only the value is known

  /// The figure named `key`, or its `without` value where it is unknown. Throws
  /// std::invalid_argument on an unknown key.
  [[nodiscard]] double of(std::string_view key) const;
};

/// The certificate if nothing is known: the value 1, and every figure's `without` value.
[[nodiscard]] StageCertificate blank_certificate();

/// Certificates of stages 1 … horizon of `motion`.
/// budgets: the result of `error_budget` for it. run: the executor that the stages, which are
/// independent of each other, are divided among; no result depends on it.
[[nodiscard]] std::vector<StageCertificate> certify(
    const PredictedMotion& motion, const UnsafeSet& unsafe, const std::vector<StageBudget>& budgets,
    CertificateEffort effort = CertificateEffort::kLeast, const Executor& run = run_in_turn);

/// Upper bound of the probability that the state is unsafe at any of the stages: the sum of the
/// stages' bounds or of their increments ("entry"), whichever is less, at most 1. 0 if there are no
/// stages.
[[nodiscard]] double horizon_bound(const std::vector<StageCertificate>& certificates);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
