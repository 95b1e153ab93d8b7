#include "controller/planning/lbfgs_solver.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <new>

#include <nlopt.h>

namespace qsmpc {
namespace {

// A start nearer to a bound than this fraction of the range is moved inwards: on the flat ends of
// the sigmoid the gradient vanishes and the solver could not leave the bound again.
constexpr double kStartMargin = 0.02;
constexpr unsigned kVectorStorage = 20;

/// v = lower + (upper − lower) σ(θ), Eq. 5-3 for bounds that need not be symmetric.
class Sigmoid {
 public:
  Sigmoid(const InputBounds& bounds, Eigen::Index horizon)
      : lower_(bounds.lower.replicate(1, horizon)),
        upper_(bounds.upper.replicate(1, horizon)),
        range_(upper_ - lower_) {}

  [[nodiscard]] Eigen::MatrixXd inputs(const Eigen::Ref<const Eigen::MatrixXd>& theta) const {
    // Rounding may carry lower + (upper − lower) beyond upper.
    return (lower_.array() + range_.array() * sigma(theta)).min(upper_.array());
  }
  [[nodiscard]] Eigen::MatrixXd slope(const Eigen::Ref<const Eigen::MatrixXd>& theta) const {
    const Eigen::ArrayXXd value = sigma(theta);
    return range_.array() * value * (1.0 - value);
  }
  [[nodiscard]] Eigen::MatrixXd theta(const Eigen::MatrixXd& inputs) const {
    const Eigen::ArrayXXd share =
        ((inputs - lower_).array() / range_.array()).max(kStartMargin).min(1.0 - kStartMargin);
    return (share / (1.0 - share)).log();
  }

 private:
  [[nodiscard]] static Eigen::ArrayXXd sigma(const Eigen::Ref<const Eigen::MatrixXd>& theta) {
    return (1.0 + (-theta.array()).exp()).inverse();
  }
  Eigen::MatrixXd lower_;
  Eigen::MatrixXd upper_;
  Eigen::MatrixXd range_;
};

/// What NLopt's callback works on. NLopt is C: no exception may pass through it, so one is kept and
/// thrown again afterwards.
struct Problem {
  const CostFunction& cost;
  const Sigmoid& sigmoid;
  nlopt_opt handle = nullptr;
  Eigen::Index rows = 0;
  Eigen::Index cols = 0;
  int max_evaluations = 1;
  Eigen::MatrixXd gradient{};
  SolverResult best{};
  bool trouble = false;
  std::exception_ptr thrown{};
};

double stop(Problem& problem) {
  nlopt_force_stop(problem.handle);
  return std::numeric_limits<double>::max();
}

double evaluate(unsigned /*n*/, const double* theta_data, double* gradient_data, void* data) {
  Problem& problem = *static_cast<Problem*>(data);
  // NLopt may ask once more after its limit, and after a forced stop.
  if (problem.trouble || problem.thrown || problem.best.evaluations >= problem.max_evaluations) {
    return stop(problem);
  }
  try {
    const Eigen::Map<const Eigen::MatrixXd> theta(theta_data, problem.rows, problem.cols);
    const Eigen::MatrixXd inputs = problem.sigmoid.inputs(theta);
    const double value = problem.cost(inputs, problem.gradient);
    ++problem.best.evaluations;
    if (!std::isfinite(value) || !problem.gradient.allFinite()) {
      problem.trouble = true;
      return stop(problem);
    }
    if (value < problem.best.value) {
      problem.best.value = value;
      problem.best.inputs = inputs;
    }
    if (gradient_data != nullptr) {
      Eigen::Map<Eigen::MatrixXd>(gradient_data, problem.rows, problem.cols) =
          problem.gradient.cwiseProduct(problem.sigmoid.slope(theta));
    }
    return value;
  } catch (...) {
    problem.thrown = std::current_exception();
    return stop(problem);
  }
}

SolverStatus status_of(nlopt_result result, bool trouble) {
  if (trouble) return SolverStatus::kNumericalTrouble;
  if (result == NLOPT_MAXEVAL_REACHED || result == NLOPT_FORCED_STOP) {
    return SolverStatus::kIterationLimit;
  }
  return result > 0 ? SolverStatus::kConverged : SolverStatus::kStalled;
}

}  // namespace

SolverResult LbfgsSolver::minimise(const CostFunction& cost, const Eigen::MatrixXd& start,
                                   const InputBounds& bounds, const SolverOptions& options) const {
  const Sigmoid sigmoid(bounds, start.cols());
  Problem problem{.cost = cost, .sigmoid = sigmoid};
  problem.rows = start.rows();
  problem.cols = start.cols();
  problem.max_evaluations = options.max_evaluations;
  problem.gradient.resize(start.rows(), start.cols());
  problem.best.inputs = start;
  problem.best.value = std::numeric_limits<double>::infinity();

  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> owner(
      nlopt_create(NLOPT_LD_LBFGS, static_cast<unsigned>(start.size())), nlopt_destroy);
  if (owner == nullptr) throw std::bad_alloc();
  problem.handle = owner.get();
  nlopt_set_min_objective(owner.get(), evaluate, &problem);
  nlopt_set_maxeval(owner.get(), options.max_evaluations);
  nlopt_set_ftol_rel(owner.get(), options.relative_tolerance);
  nlopt_set_vector_storage(owner.get(), kVectorStorage);

  Eigen::MatrixXd theta = sigmoid.theta(start);
  double value = 0.0;
  const nlopt_result result = nlopt_optimize(owner.get(), theta.data(), &value);
  if (problem.thrown) std::rethrow_exception(problem.thrown);
  problem.best.status = status_of(result, problem.trouble);
  return problem.best;
}

}  // namespace qsmpc
