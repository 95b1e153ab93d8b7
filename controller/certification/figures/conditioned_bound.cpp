#include <vector>

#include "controller/certification/certificate_problem.hpp"
#include "controller/certification/figures/figures.hpp"

namespace qsmpc::controller {

StageFigure conditioned_bound(const CertificateProblem& problem) {
  const std::vector<double>& bounds = problem.conditioned_bounds().stages;
  return [&bounds](std::size_t k, double /*least*/) { return bounds[k]; };
}

}  // namespace qsmpc::controller
