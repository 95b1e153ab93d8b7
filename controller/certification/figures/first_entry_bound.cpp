#include "controller/certification/certificate_problem.hpp"
#include "controller/certification/figures/figures.hpp"

namespace qsmpc::controller {

StageFigure first_entry_bound(const CertificateProblem& problem) {
  const std::vector<double>& entries = problem.first_entries();
  return [&entries](std::size_t k, double /*least*/) { return entries[k]; };
}

}  // namespace qsmpc::controller
