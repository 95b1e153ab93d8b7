// Plans of one controller for the beliefs of another one's drives. This separates two controllers
// even if chance sends their drives along different paths.
#pragma once

#include <cstdint>
#include <vector>

#include "controller/parallel.hpp"
#include "harness/reproduction/laboratory.hpp"

namespace qsmpc::harness {

/// Probabilities of being unsafe at some stage of a plan: for every drive, the mean over its plans.
struct PlanRisk {
  std::vector<double> certified;  ///< sum of the stages' certificates, at most 1
  std::vector<double> simulated;  ///< share of kPathsAPlan simulated paths
};

inline constexpr std::int64_t kPathsAPlan = 5'000;

/// The plans are those that the controller of `scenario` makes, without a warm start, for the
/// beliefs N(f(x_k, u_k), Σ) of `drives` at every tenth period. `drives` and `scenario` have the
/// same system and no measurement noise. Paths depend only on the drive's seed and the period, so
/// that controllers are simulated with the same noise. The result does not depend on `run`.
[[nodiscard]] PlanRisk plan_risk_at_beliefs(const Sample& drives, const Scenario& scenario,
                                            const controller::Executor& run);

}  // namespace qsmpc::harness
