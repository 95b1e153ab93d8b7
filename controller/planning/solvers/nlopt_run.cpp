#include "controller/planning/solvers/nlopt_run.hpp"

#include <algorithm>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <vector>

#include <nlopt.h>

namespace qsmpc::controller {
namespace {

// Pairs of steps and gradient changes that L-BFGS remembers.
constexpr unsigned kVectorStorage = 20;

/// State of the callbacks. NLopt is C, and no exception may pass through it, so one is stored and
/// rethrown afterwards.
struct Context {
  const NloptRun& run;
  nlopt_opt handle = nullptr;
  Eigen::VectorXd x{};
  Eigen::VectorXd gradient{};
  Eigen::VectorXd values{};
  Eigen::MatrixXd gradients{};
  bool stopped = false;
  bool lost = false;  // NLopt asked for a point that is not finite
  std::exception_ptr thrown{};
};

void stop(Context& context) {
  context.stopped = true;
  nlopt_force_stop(context.handle);
}

// SLSQP's subproblem may give NaN if constraint gradients are nearly dependent.
bool take(Context& context, const double* x, unsigned n) {
  context.x = Eigen::Map<const Eigen::VectorXd>(x, n);
  context.lost = !context.x.allFinite();
  return !context.lost;
}

double cost(unsigned n, const double* x, double* gradient, void* data) {
  Context& context = *static_cast<Context*>(data);
  if (!context.stopped) {
    try {
      const bool finite = take(context, x, n);
      const std::optional<double> value =
          finite ? context.run.cost(context.x, context.gradient) : std::nullopt;
      if (value) {
        if (gradient != nullptr) std::copy_n(context.gradient.data(), n, gradient);
        return *value;
      }
    } catch (...) {
      context.thrown = std::current_exception();
    }
  }
  stop(context);
  return std::numeric_limits<double>::max();
}

void constraints(unsigned m, double* values, unsigned n, const double* x, double* gradients,
                 void* data) {
  Context& context = *static_cast<Context*>(data);
  bool answered = false;
  if (!context.stopped) {
    try {
      answered = take(context, x, n) &&
                 context.run.constraints(context.x, context.values, context.gradients);
    } catch (...) {
      context.thrown = std::current_exception();
    }
  }
  if (!answered) {
    stop(context);
    context.values.setZero();
    context.gradients.setZero();
  }
  std::copy_n(context.values.data(), m, values);
  // NLopt's layout, m x n row-major, is n x m column-major.
  if (gradients != nullptr) std::copy_n(context.gradients.data(), m * n, gradients);
}

}  // namespace

NloptEnd run_nlopt(const NloptRun& run, const Eigen::VectorXd& start) {
  const Eigen::Index n = start.size();
  Context context{.run = run};
  context.gradient.resize(n);
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> owner(
      nlopt_create(run.method == NloptMethod::kLbfgs ? NLOPT_LD_LBFGS : NLOPT_LD_SLSQP,
                   static_cast<unsigned>(n)),
      nlopt_destroy);
  if (owner == nullptr) throw std::bad_alloc();
  context.handle = owner.get();
  nlopt_set_min_objective(owner.get(), cost, &context);
  nlopt_set_ftol_rel(owner.get(), run.relative_tolerance);
  nlopt_set_vector_storage(owner.get(), kVectorStorage);
  if (run.lower.size() == n) nlopt_set_lower_bounds(owner.get(), run.lower.data());
  if (run.upper.size() == n) nlopt_set_upper_bounds(owner.get(), run.upper.data());
  if (run.constraint_count > 0) {
    context.values.resize(run.constraint_count);
    context.gradients.resize(n, run.constraint_count);
    const std::vector<double> tolerances(run.constraint_count, run.constraint_tolerance);
    nlopt_add_inequality_mconstraint(owner.get(), static_cast<unsigned>(run.constraint_count),
                                     constraints, &context, tolerances.data());
  }
  Eigen::VectorXd x = start;
  double value = 0.0;
  const nlopt_result result = nlopt_optimize(owner.get(), x.data(), &value);
  if (context.thrown) std::rethrow_exception(context.thrown);
  if (context.lost) return NloptEnd::kStalled;
  if (context.stopped) return NloptEnd::kStopped;
  return result > 0 ? NloptEnd::kConverged : NloptEnd::kStalled;
}

}  // namespace qsmpc::controller
