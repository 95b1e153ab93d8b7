#include <memory>
#include <vector>

#include "controller/certification/certificate_problem.hpp"
#include "controller/certification/conditioned_bounds.hpp"
#include "controller/certification/figures/figures.hpp"

namespace qsmpc::controller {

StageFigure conditioned_bound(const CertificateProblem& problem) {
  auto bounds = std::make_shared<const std::vector<double>>(conditioned_bounds(
      problem.motion(), problem.unsafe(), problem.surrogate_bounds(), problem.run()));
  return [bounds](std::size_t k, double /*least*/) { return (*bounds)[k]; };
}

}  // namespace qsmpc::controller
