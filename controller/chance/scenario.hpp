// The sample bound of the scenario approach.
#pragma once

namespace qsmpc::controller {

/// The least number S of samples such that, with at least this confidence, the solution of a convex
/// problem with `decisions` decision variables that satisfies a constraint on all S samples
/// satisfies it on a new sample with probability at least 1 − risk: Σ_{i < decisions} C(S, i) riskⁱ
/// (1 − risk)^(S − i) ≤ 1 − confidence (Campi, Garatti: "The exact feasibility of randomized
/// solutions of uncertain convex programs", 2008). For non-convex problems it is not a bound,
/// although users of the method commonly apply it. risk, confidence: in (0, 1); decisions ≥ 1.
[[nodiscard]] int scenario_samples(double risk, double confidence, int decisions);

}  // namespace qsmpc::controller
