#include "controller/certification/certificate.hpp"

#include <algorithm>
#include <cmath>

#include "controller/certification/smoothed_bound.hpp"
#include "controller/certification/unicycle_surrogate.hpp"
#include "controller/certification/worst_case.hpp"

namespace qsmpc {
namespace {

double unsafe_mass(const DiscreteMeasure& measure, const SafeSet& safe_set) {
  double mass = 0.0;
  for (Eigen::Index i = 0; i < measure.size(); ++i) {
    if (clearance(measure.locations.col(i), safe_set) <= 0.0) mass += measure.weights[i];
  }
  return mass;
}

/// Whether being safe depends on the coordinate `axis`, through the bounds or through an obstacle.
bool restricts(const SafeSet& safe_set, int axis) {
  const auto bounded = [axis](const Box& box) {
    return std::isfinite(box.lower[axis]) || std::isfinite(box.upper[axis]);
  };
  return bounded(safe_set.bounds) ||
         std::any_of(safe_set.obstacles.begin(), safe_set.obstacles.end(), bounded);
}

/// C3 of all stages; 1 where it does not apply.
std::vector<double> surrogate_bounds(const PredictedMotion& motion, const SafeSet& safe_set) {
  const Eigen::Index horizon = motion.policy.horizon();
  std::vector<double> bounds(horizon, 1.0);
  const std::optional<UnicycleStructure> unicycle = motion.dynamics.unicycle();
  if (!unicycle) return bounds;
  const bool open_loop = std::all_of(motion.policy.gains.begin(), motion.policy.gains.end(),
                                     [](const auto& gain) { return gain.isZero(0.0); });
  // The input of a stage moves the heading alone, so the position of stage 1 is that of open loop.
  Eigen::Index stages = horizon;
  if (!open_loop) stages = restricts(safe_set, unicycle->heading) ? 0 : 1;
  const std::vector<GaussianSurrogate> surrogates = unicycle_surrogates(
      *unicycle, motion.belief, motion.policy.inputs.row(unicycle->input).head(stages),
      motion.noise_covariance);
  for (Eigen::Index k = 0; k < stages; ++k) {
    const DiscreteMeasure centre{.locations = surrogates[k].law.mean,
                                 .weights = Eigen::VectorXd::Ones(1)};
    bounds[k] =
        smoothed_probability(centre, surrogates[k].law.covariance, safe_set, surrogates[k].radius);
  }
  return bounds;
}

/// The radius that the thesis would use: Eq. 4-4 and 4-6, without noise and without the feedback.
std::vector<double> thesis_radii(const PredictedMotion& motion) {
  const Eigen::MatrixXd no_gain =
      Eigen::MatrixXd::Zero(motion.policy.inputs.rows(), motion.policy.states.rows());
  const double lipschitz = motion.dynamics.lipschitz(no_gain);
  std::vector<double> radii = {motion.belief_w2};
  for (const StageMap& map : motion.prediction.maps) {
    radii.push_back(lipschitz * radii.back() + map.compression_w2);
  }
  return radii;
}

}  // namespace

std::vector<StageCertificate> certify(const PredictedMotion& motion, const SafeSet& safe_set,
                                      const std::vector<StageBudget>& budgets) {
  const std::vector<double> surrogates = surrogate_bounds(motion, safe_set);
  const std::vector<double> radii = thesis_radii(motion);
  std::vector<StageCertificate> certificates(motion.policy.horizon());
  for (std::size_t k = 0; k < certificates.size(); ++k) {
    StageCertificate& certificate = certificates[k];
    const DiscreteMeasure& particles = motion.prediction.stages[k + 1];
    const DiscreteMeasure stepped{.locations = motion.prediction.stepped[k],
                                  .weights = motion.prediction.stages[k].weights};
    certificate.particles = worst_case_probability(particles, safe_set, budgets[k + 1].total);
    // Without an error before the step there is none after it, whatever the Lipschitz constant.
    const double before_noise =
        budgets[k].total == 0.0 ? 0.0 : budgets[k].lipschitz * budgets[k].total;
    certificate.mixture =
        smoothed_probability(stepped, motion.noise_covariance, safe_set, before_noise);
    certificate.surrogate = surrogates[k];
    certificate.thesis = thesis_probability(particles, safe_set, radii[k + 1]);
    certificate.unsafe_mass = unsafe_mass(particles, safe_set);
    certificate.value =
        std::min({certificate.particles, certificate.mixture, certificate.surrogate});
    // Of equal bounds the simplest is named.
    certificate.kind = certificate.value == certificate.particles ? "c1"
                       : certificate.value == certificate.mixture ? "c2"
                                                                  : "c3";
  }
  return certificates;
}

double horizon_bound(const std::vector<StageCertificate>& certificates) {
  double sum = 0.0;
  for (const StageCertificate& certificate : certificates) sum += certificate.value;
  return std::min(1.0, sum);
}

}  // namespace qsmpc
