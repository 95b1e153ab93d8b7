#include <algorithm>

#include "controller/certification/certificate_problem.hpp"
#include "controller/certification/figures/figures.hpp"
#include "controller/certification/worst_case.hpp"

namespace qsmpc::controller {

StageFigure particle_bound(const CertificateProblem& problem) {
  return [&problem](std::size_t k, double /*least*/) {
    // Distances are to where obstacles are expected, and no more.
    if (!problem.unsafe().is_certain(static_cast<Eigen::Index>(k) + 1)) return 1.0;
    const StageBudget& budget = problem.budgets()[k + 1];
    // An error of the state moves no disc by more than this many times as much.
    const double lipschitz = problem.unsafe().lipschitz();
    const double nearest =
        worst_case_probability(problem.clearance(k).cwiseMax(0.0) / lipschitz,
                               problem.motion().prediction.stages[k + 1].weights, budget.total);
    return std::min(1.0, budget.leaving + nearest);
  };
}

}  // namespace qsmpc::controller
