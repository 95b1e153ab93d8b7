// How many sampled paths are enough.
#pragma once

namespace qsmpc::controller {

/// The least number S of samples for which a convex problem with `decisions` decisions that keeps a
/// constraint for all of them keeps it with probability at least 1 − risk for a new sample, with at
/// least this confidence: Σ_{i < decisions} C(S, i) riskⁱ (1 − risk)^(S − i) ≤ 1 − confidence
/// (Campi, Garatti: "The exact feasibility of randomized solutions of uncertain convex programs",
/// 2008). For problems that are not convex it is what users of the method take all the same, and no
/// bound. risk, confidence: in (0, 1); decisions ≥ 1.
[[nodiscard]] int scenario_samples(double risk, double confidence, int decisions);

}  // namespace qsmpc::controller
