#include "controller/certification/published_certificate.hpp"

#include <cmath>

#include "controller/certification/certificate_problem.hpp"
#include "controller/certification/figures/figures.hpp"
#include "controller/certification/worst_case.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

/// Algorithm 3 with p = 2 for every point; unbounded dimensions have no faces and do not count.
Eigen::VectorXd thesis_distances(const Points& points, const Box& bounds) {
  const Eigen::Index count = points.cols();
  Eigen::ArrayXd squares = Eigen::ArrayXd::Zero(count);
  Eigen::ArrayXd least = Eigen::ArrayXd::Constant(count, kInfinity);
  for (Eigen::Index axis = 0; axis < points.rows(); ++axis) {
    const double lower = bounds.lower[axis];
    const double upper = bounds.upper[axis];
    if (std::isinf(lower) && std::isinf(upper)) continue;
    const Eigen::Map<const Eigen::ArrayXd> x(points.data() + axis * count, count);
    const Eigen::ArrayXd nearest = (x - lower).min(upper - x);
    squares += nearest.square();
    least = least.min(nearest);
  }
  const bool bounded = least.size() > 0 && !std::isinf(least[0]);
  if (!bounded) return Eigen::VectorXd::Constant(count, kInfinity);
  return (least < 0.0).select(0.0, squares.sqrt()).matrix();
}

}  // namespace

std::vector<double> thesis_radii(const PredictedMotion& motion,
                                 const std::vector<StageBudget>& budgets) {
  const Eigen::MatrixXd no_gain =
      Eigen::MatrixXd::Zero(motion.policy.inputs.rows(), motion.policy.states.rows());
  const double global = motion.dynamics.lipschitz(no_gain);
  std::vector<double> radii = {motion.belief_w2};
  for (std::size_t k = 0; k < motion.prediction.maps.size(); ++k) {
    const double lipschitz = std::isfinite(global) ? global : budgets[k].lipschitz;
    radii.push_back(lipschitz * radii.back() + motion.prediction.maps[k].compression_w2);
  }
  return radii;
}

double thesis_probability(const DiscreteMeasure& measure, const Box& bounds, double radius) {
  return transported_mass(thesis_distances(measure.locations, bounds), measure.weights, radius);
}

double linear_transport_probability(const DiscreteMeasure& measure, const UnsafeSet& unsafe,
                                    double radius) {
  return transported_mass(clearances(measure.locations, unsafe).cwiseMax(0.0) / unsafe.lipschitz(),
                          measure.weights, radius);
}

StageFigure published_probability(const CertificateProblem& problem) {
  return [&problem, radii = thesis_radii(problem.motion(), problem.budgets())](std::size_t k,
                                                                               double /*least*/) {
    return thesis_probability(problem.motion().prediction.stages[k + 1], problem.unsafe().bounds(),
                              radii[k + 1]);
  };
}

}  // namespace qsmpc::controller
