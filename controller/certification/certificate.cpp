#include "controller/certification/certificate.hpp"

#include <algorithm>
#include <cmath>

#include "controller/certification/affine_surrogate.hpp"
#include "controller/certification/smoothed_bound.hpp"
#include "controller/certification/unsafe_region_bound.hpp"
#include "controller/certification/worst_case.hpp"

namespace qsmpc::controller {
namespace {

// What a part of the unsafe set may add without being worked out further.
constexpr double kNegligible = 1e-8;
// What it may add without a search that takes long.
constexpr double kWorthwhile = 1e-4;
// From where on another core, which alone costs some 1e-2, may help.
constexpr double kTryNarrow = 0.03;

double unsafe_mass(const Eigen::VectorXd& clearance, const Eigen::VectorXd& weights) {
  return (clearance.array() <= 0.0).select(weights.array(), 0.0).sum();
}

/// C3 and C4 of one stage. C4 takes the better of the two for every part of the unsafe set.
struct SurrogateBounds {
  double markov = 1.0;
  double smooth = 1.0;
};

SurrogateBounds surrogate_bounds(const PredictedMotion& motion,
                                 const std::vector<UnsafeRegion>& parts, Eigen::Index stage,
                                 const SurrogateStage& surrogate, CertificateEffort effort) {
  const double worthwhile = effort == CertificateEffort::kEvery ? kNegligible : kWorthwhile;
  if (surrogate.leaving >= 1.0) return {};
  SurrogateBounds bounds{.markov = surrogate.leaving, .smooth = surrogate.leaving};
  for (const UnsafeRegion& part : parts) {
    // One value of the highest order settles the parts that are far away.
    const std::size_t highest = kHigherOrders.size() - 1;
    double markov = far_region_bound(surrogate.law, surrogate.higher[highest],
                                     kHigherOrders[highest], part, kNegligible);
    double smooth = markov;
    if (markov > kNegligible) {
      const Eigen::MatrixXd smoothing = smoothing_covariance(motion, stage, part.axes);
      const PerturbedGaussian state{
          .law = surrogate.law, .error = surrogate.error, .smoothing = smoothing};
      markov = std::min(markov, markov_region_bound(state, part));
      smooth = std::min(markov, smooth_region_bound(state, part));
    }
    // Searches in two coordinates are dear: only where they can matter.
    for (std::size_t k = kHigherOrders.size(); k-- > 0 && smooth > worthwhile;) {
      markov = std::min(
          markov, tail_region_bound(surrogate.law, surrogate.higher[k], kHigherOrders[k], part));
      smooth = std::min(smooth, markov);
    }
    bounds.markov += markov;
    bounds.smooth += smooth;
  }
  return {.markov = std::min(1.0, bounds.markov), .smooth = std::min(1.0, bounds.smooth)};
}

/// C3 and C4 of all stages. Where they are large, the surrogate with the narrow core is tried, too:
/// it is left more often, and its residuals are smaller.
std::vector<SurrogateBounds> surrogate_bounds_of_stages(const PredictedMotion& motion,
                                                        const SafeSet& safe_set,
                                                        CertificateEffort effort,
                                                        const Executor& run) {
  const std::vector<UnsafeRegion> parts = unsafe_regions(safe_set);
  std::vector<SurrogateBounds> least(motion.policy.horizon());
  for (const double core : {kWideCore, kNarrowCore}) {
    const std::vector<SurrogateStage> surrogates = affine_surrogates(motion, core);
    const auto stage = [&](int k) {
      // Neither bound can be less than the probability of leaving, nor C3 less than C4.
      if (least[k].markov <= surrogates[k + 1].leaving) return;
      const SurrogateBounds bounds = surrogate_bounds(
          motion, parts, static_cast<Eigen::Index>(k) + 1, surrogates[k + 1], effort);
      least[k] = {.markov = std::min(least[k].markov, bounds.markov),
                  .smooth = std::min(least[k].smooth, bounds.smooth)};
    };
    run(static_cast<int>(least.size()), stage);
    double largest = 0.0;
    for (const SurrogateBounds& bounds : least) largest = std::max(largest, bounds.smooth);
    // Without a core in use the narrow one changes nothing.
    if (largest < kTryNarrow || surrogates.back().leaving == 0.0) break;
  }
  return least;
}

/// The certificate of stage k + 1; `radius` is the one that the thesis would use there.
StageCertificate certify_stage(const PredictedMotion& motion, const SafeSet& safe_set,
                               const StageBudget& budget, const SurrogateBounds& surrogate,
                               double radius, std::size_t k, CertificateEffort effort) {
  StageCertificate certificate;
  const DiscreteMeasure& particles = motion.prediction.stages[k + 1];
  certificate.surrogate = surrogate.markov;
  certificate.smoothed = surrogate.smooth;
  const double leaving = budget.leaving;
  const Eigen::VectorXd clearance = clearances(particles.locations, safe_set);
  const double nearest =
      worst_case_probability(clearance.cwiseMax(0.0), particles.weights, budget.total);
  certificate.particles = std::min(1.0, leaving + nearest);
  const double least =
      std::min({certificate.particles, certificate.surrogate, certificate.smoothed});
  const GaussianMixture stepped{.centres = motion.prediction.stepped[k],
                                .weights = motion.prediction.stages[k].weights,
                                .covariance = motion.noise_covariance};
  const double useful = effort == CertificateEffort::kEvery ? 1.0 : least - leaving;
  certificate.mixture =
      std::min(1.0, leaving + smoothed_probability(stepped, safe_set, budget.before_noise, useful));
  certificate.thesis = thesis_probability(particles, safe_set, radius);
  certificate.unsafe_mass = unsafe_mass(clearance, particles.weights);
  certificate.value = std::min(least, certificate.mixture);
  // Of equal bounds the simplest is named.
  certificate.kind = certificate.value == certificate.particles   ? "c1"
                     : certificate.value == certificate.mixture   ? "c2"
                     : certificate.value == certificate.surrogate ? "c3"
                                                                  : "c4";
  return certificate;
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

std::vector<StageCertificate> certify(const PredictedMotion& motion, const SafeSet& safe_set,
                                      const std::vector<StageBudget>& budgets,
                                      CertificateEffort effort, const Executor& run) {
  const std::vector<SurrogateBounds> surrogates =
      surrogate_bounds_of_stages(motion, safe_set, effort, run);
  const std::vector<double> radii = thesis_radii(motion, budgets);
  std::vector<StageCertificate> certificates(motion.policy.horizon());
  const auto stage = [&](int k) {
    certificates[k] = certify_stage(motion, safe_set, budgets[k + 1], surrogates[k], radii[k + 1],
                                    static_cast<std::size_t>(k), effort);
  };
  run(static_cast<int>(certificates.size()), stage);
  return certificates;
}

double horizon_bound(const std::vector<StageCertificate>& certificates) {
  double sum = 0.0;
  for (const StageCertificate& certificate : certificates) sum += certificate.value;
  return std::min(1.0, sum);
}

}  // namespace qsmpc::controller
