#include "controller/certification/certificate_problem.hpp"
#include "controller/certification/figures/figures.hpp"

namespace qsmpc::controller {

StageFigure surrogate_bound(const CertificateProblem& problem) {
  const std::vector<RegionProbability>& bounds = problem.surrogate_bounds().bounds;
  return [&bounds](std::size_t k, double /*least*/) { return bounds[k].markov; };
}

StageFigure smoothed_surrogate_bound(const CertificateProblem& problem) {
  const std::vector<RegionProbability>& bounds = problem.surrogate_bounds().bounds;
  return [&bounds](std::size_t k, double /*least*/) { return bounds[k].smooth; };
}

}  // namespace qsmpc::controller
