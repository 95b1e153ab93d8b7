#include "tests/support/slsqp_search.hpp"

#include <algorithm>
#include <exception>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include <nlopt.h>

namespace qsmpc::testing {
namespace {

struct Call {
  const SlsqpSearch& settings;
  nlopt_opt solver = nullptr;
  std::exception_ptr error{};
};

/// NLopt is C code: exceptions must not pass through it.
double cost_for_nlopt(unsigned n, const double* x, double* gradient, void* data) {
  Call& call = *static_cast<Call*>(data);
  try {
    std::vector<double> slope(gradient == nullptr ? 0 : n);
    const double value = call.settings.cost({x, x + n}, slope);
    std::copy(slope.begin(), slope.end(), gradient);
    return value;
  } catch (...) {
    call.error = std::current_exception();
    nlopt_force_stop(call.solver);
    return std::numeric_limits<double>::infinity();
  }
}

}  // namespace

std::vector<double> run_slsqp(const SlsqpSearch& settings, std::vector<double> start) {
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> solver(
      nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(start.size())), nlopt_destroy);
  Call call{.settings = settings, .solver = solver.get()};
  nlopt_set_min_objective(solver.get(), cost_for_nlopt, &call);
  nlopt_set_lower_bounds(solver.get(), settings.lower.data());
  nlopt_set_upper_bounds(solver.get(), settings.upper.data());
  nlopt_set_ftol_rel(solver.get(), settings.relative_tolerance);
  nlopt_set_maxeval(solver.get(), settings.evaluations);
  double value = 0.0;
  const nlopt_result result = nlopt_optimize(solver.get(), start.data(), &value);
  if (call.error) std::rethrow_exception(call.error);
  if (result < 0 && result != NLOPT_ROUNDOFF_LIMITED) {
    throw std::runtime_error(std::string("NLopt: ") + nlopt_result_to_string(result));
  }
  return start;
}

}  // namespace qsmpc::testing
