#include <algorithm>

#include "controller/certification/certificate_problem.hpp"
#include "controller/certification/figures/figures.hpp"
#include "controller/certification/worst_case.hpp"

namespace qsmpc::controller {

StageFigure particle_bound(const CertificateProblem& problem) {
  return [&problem](std::size_t k, double /*least*/) {
    // The distances are to the obstacles' expected places only.
    if (!problem.unsafe().is_certain(static_cast<Eigen::Index>(k) + 1)) return 1.0;
    const StageBudget& budget = problem.budgets()[k + 1];
    // An error of the state moves a disc by at most this many times as much.
    const double lipschitz = problem.unsafe().lipschitz();
    const double nearest =
        worst_case_probability(problem.clearance(k).cwiseMax(0.0) / lipschitz,
                               problem.motion().prediction.stages[k + 1].weights, budget.total);
    return std::min(1.0, budget.leaving + nearest);
  };
}

}  // namespace qsmpc::controller
