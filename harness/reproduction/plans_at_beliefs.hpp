// Plans of one controller for the beliefs that drives of another one went through: what separates
// two controllers where chance sends their drives different ways.
#pragma once

#include <cstdint>
#include <vector>

#include "controller/parallel.hpp"
#include "harness/reproduction/laboratory.hpp"

namespace qsmpc::harness {

/// Probabilities of being unsafe at some stage of a plan: of every drive the mean over its plans.
struct PlanRisk {
  std::vector<double> certified;  ///< sum of the stages' certificates, at most 1
  std::vector<double> simulated;  ///< share of kPathsAPlan simulated paths
};

inline constexpr std::int64_t kPathsAPlan = 5'000;

/// The plans are those that the controller of `scenario`, with nothing to start from, makes for the
/// beliefs N(f(x_k, u_k), Σ) of `drives` at every tenth period. Both are of the same system,
/// without measurement noise. Paths depend on the drive's seed and the period alone, so that
/// controllers are simulated with the same noise. Nothing depends on `run`.
[[nodiscard]] PlanRisk plan_risk_at_beliefs(const Sample& drives, const Scenario& scenario,
                                            const controller::Executor& run);

}  // namespace qsmpc::harness
