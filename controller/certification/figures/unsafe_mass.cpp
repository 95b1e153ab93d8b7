#include "controller/certification/certificate_problem.hpp"
#include "controller/certification/figures/figures.hpp"

namespace qsmpc::controller {

StageFigure unsafe_mass(const CertificateProblem& problem) {
  return [&problem](std::size_t k, double /*least*/) {
    const Eigen::VectorXd& weights = problem.motion().prediction.stages[k + 1].weights;
    return (problem.clearance(k).array() <= 0.0).select(weights.array(), 0.0).sum();
  };
}

}  // namespace qsmpc::controller
