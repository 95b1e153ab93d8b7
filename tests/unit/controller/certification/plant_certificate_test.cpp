// How a model error changes budgets, surrogates and certificates.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "controller/certification/error_truncation.hpp"
#include "controller/measure/normal/normal_distribution.hpp"
#include "models/constants.hpp"
#include "models/dynamics/dubins.hpp"
#include "tests/unit/controller/certification/surrogate_cases.hpp"

namespace qsmpc::controller {
namespace certification_plant_certificate_test {

using namespace testing;
// Rounding of sums and products of few terms of order one.
constexpr double kRounding = 1e-14;

/// A model error that is `size` in every norm, and bounded by it.
ModelError bounded(const Eigen::VectorXd& size) {
  ModelError error = model_error_of_size(size);
  for (Eigen::VectorXd& norms : error.higher) norms = size;
  return error;
}

SafeSet walls(Eigen::Index dim, double width) {
  SafeSet safe_set = unbounded_safe_set(dim);
  safe_set.bounds.lower[0] = -width;
  safe_set.bounds.upper[0] = width;
  return safe_set;
}

TEST(PlantBudget, grows_by_the_radius_before_the_noise) {
  Generator generator(211);
  for (const Case& one : all_cases(generator)) {
    const ModelError error = bounded(Eigen::VectorXd::Constant(one.belief.mean.size(), 0.01));
    PredictedMotion motion = one.motion();
    motion.model_error = &error;
    motion.noise_w2 = 0.3;
    const std::vector<StageBudget> budgets = error_budget(motion);
    EXPECT_EQ(budgets[0].model, 0.0);
    for (std::size_t k = 0; k + 1 < budgets.size(); ++k) {
      const StageBudget& now = budgets[k];
      const StageBudget& next = budgets[k + 1];
      if (!std::isfinite(next.total)) continue;
      const double compression = motion.prediction.maps[k].compression_w2;
      const double apart = now.lipschitz * now.total + error.radius();
      EXPECT_GE(next.before_noise, apart - kRounding) << one.name;
      EXPECT_NEAR(next.model, now.lipschitz * now.model + error.radius(), kRounding) << one.name;
      EXPECT_NEAR(next.total, std::hypot(next.before_noise, 0.3) + compression,
                  kRounding * next.total)
          << one.name;
      EXPECT_LE(next.total,
                (1.0 + kRounding) * (next.belief + next.noise + next.compression + next.model))
          << one.name;
    }
  }
}

TEST(PlantBudget, begins_with_the_beliefs_error_and_takes_a_stated_radius) {
  const Case one = double_integrator({});
  ModelError error = bounded(Eigen::Vector2d(0.03, 0.04));
  PredictedMotion motion = one.motion();
  motion.belief_error = &error;
  EXPECT_NEAR(error_budget(motion)[0].model, 0.05, kRounding);
  EXPECT_NEAR(error_budget(motion)[0].total, motion.belief_w2 + 0.05, kRounding);
  error.stated_radius = 0.2;
  EXPECT_NEAR(error_budget(motion)[0].model, 0.2, kRounding);
}

TEST(PlantSurrogate, error_of_an_affine_system_adds_up_along_its_maps) {
  const Case one = double_integrator({});
  const ModelError error = bounded(Eigen::Vector2d(0.02, 0.03));
  PredictedMotion motion = one.motion();
  motion.model_error = &error;
  const std::vector<SurrogateStage> stages = affine_surrogates(motion);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t k = 1; k < stages.size(); ++k) {
    sum = stages[k - 1].transition.cwiseAbs() * sum + error.root_mean_square;
    EXPECT_LE((stages[k].error - sum).norm(), kRounding);
    EXPECT_LE((stages[k].higher[1] - sum).norm(), kRounding);
    // Derivative bounds are rounded outwards, so the cuts are charged for here as well.
    EXPECT_LE(stages[k].leaving, 1e-6);
  }
}

/// The error pushes away from the surrogate with full size, in every coordinate.
Points away(const Points& offset, const Eigen::VectorXd& size) {
  return size.asDiagonal() * offset.unaryExpr([](double one) { return one < 0.0 ? -1.0 : 1.0; });
}

TEST(PlantSurrogate, bounds_what_an_error_does_that_drives_the_state_away_from_it) {
  Generator generator(212);
  for (const Case& one : all_cases(generator)) {
    const Eigen::VectorXd size = 0.2 * one.settings.noise_covariance.diagonal().cwiseSqrt();
    const ModelError error = bounded(size);
    PredictedMotion motion = one.motion();
    motion.model_error = &error;
    motion.belief_error = &error;
    const std::vector<SurrogateStage> stages = affine_surrogates(motion);
    NormalSampler noise(motion.noise_covariance);
    NormalSampler belief(motion.belief.covariance);
    Points surrogate(size.size(), kSamples);
    for (int i = 0; i < kSamples; ++i) surrogate.col(i) = motion.belief.mean + belief(generator);
    Points state = surrogate.colwise() + size;
    for (std::size_t k = 0; k < stages.size(); ++k) {
      const Eigen::VectorXd distance = root_mean_squares(state - surrogate);
      for (Eigen::Index i = 0; i < distance.size(); ++i) {
        // A sample's root mean square is within 10 % of that of its law, as for the model itself.
        EXPECT_LE(distance[i], 1.1 * stages[k].error[i] + kRounding)
            << one.name << ", stage " << k << ", coordinate " << i;
      }
      EXPECT_LE(stages[k].leaving, k == 0 ? 0.0 : 2e-5) << one.name;
      if (k + 1 == stages.size()) break;
      Points inputs(motion.policy.inputs.rows(), kSamples);
      Points next(size.size(), kSamples);
      policy_inputs(motion.policy, static_cast<Eigen::Index>(k), state, inputs);
      motion.dynamics.step(state, inputs, next);
      surrogate = (stages[k].transition * (surrogate.colwise() - stages[k].law.mean)).colwise() +
                  stages[k + 1].law.mean;
      state = next + away(next - surrogate, size);
      for (int i = 0; i < kSamples; ++i) {
        const Eigen::VectorXd drawn = noise(generator);
        state.col(i) += drawn;
        surrogate.col(i) += drawn;
      }
    }
  }
}

TEST(PlantSurrogate, regions_hold_the_state_where_only_the_error_moves_it) {
  const Eigen::Vector3d size(0.02, 0.02, 0.05);
  const ModelError error = bounded(size);
  for (const bool closed_loop : {false, true}) {
    const Case one = make_case("still", dubins_car(),
                               around(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(1e-9)),
                               1e-18 * Eigen::Matrix3d::Identity(),
                               Eigen::VectorXd::Constant(1, 0.3), {.closed_loop = closed_loop});
    PredictedMotion motion = one.motion();
    motion.model_error = &error;
    motion.belief_error = &error;
    const std::vector<SurrogateStage> stages = affine_surrogates(motion);
    Points state = motion.belief.mean + size;
    for (std::size_t k = 0; k + 1 < stages.size(); ++k) {
      EXPECT_TRUE((state.array() >= stages[k].region.lower.array()).all()) << k;
      EXPECT_TRUE((state.array() <= stages[k].region.upper.array()).all()) << k;
      const Eigen::VectorXd distance = (state.col(0) - stages[k].law.mean).cwiseAbs();
      EXPECT_TRUE((distance.array() <= stages[k].largest.array() + 1e-8).all()) << k;
      Points inputs(1, 1);
      Points next(3, 1);
      policy_inputs(motion.policy, static_cast<Eigen::Index>(k), state, inputs);
      motion.dynamics.step(state, inputs, next);
      state = next + away(next.colwise() - stages[k + 1].law.mean, size);
    }
  }
}

/// An error that depends on the state, which itself is Gaussian and wide: it pushes everything near
/// the wall into it. Counting that width as smoothing would be wrong.
TEST(PlantCertificate, holds_for_an_error_that_is_zero_except_near_the_wall) {
  constexpr double kWall = 3.0;   // m, and standard deviations
  constexpr double kReach = 0.3;  // m, of the error
  constexpr double kPush = 0.05;  // m, five deviations of the noise
  const Case one =
      make_case("watched", dubins_car(),
                {.mean = Eigen::Vector3d(-dubins_car()->unicycle()->reach, 0.0, 0.0),
                 .covariance = Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal()},
                Eigen::Vector3d(1e-4, 1e-4, 0.0).asDiagonal(), Eigen::VectorXd::Zero(1), {}, 1);
  const double near = normal_cumulative(kReach - kWall) - normal_cumulative(-kWall);
  ModelError error = bounded(Eigen::Vector3d(kReach + kPush, 0.0, 0.0));
  error.root_mean_square *= std::sqrt(near);
  error.higher[0] *= std::pow(near, 1.0 / 4.0);
  error.higher[1] *= std::pow(near, 1.0 / 8.0);
  PredictedMotion motion = one.motion();
  motion.model_error = &error;
  SafeSet safe_set = unbounded_safe_set(3);
  safe_set.bounds.upper[0] = kWall;
  const StageCertificate certificate =
      certify(motion, safe_set, error_budget(motion), CertificateEffort::kEvery).front();
  // States within reach of the wall are pushed beyond it, up to five deviations of the noise; of
  // those already beyond it, which noise may bring back, half are counted.
  const double truth = near * (1.0 - 1e-6) + 0.5 * normal_cumulative(-kWall);
  EXPECT_GE(certificate.of("c1"), truth);
  EXPECT_GE(certificate.of("c2"), truth);
  EXPECT_GE(certificate.of("c3"), truth);
  EXPECT_GE(certificate.of("c4"), truth);
  EXPECT_LT(certificate.value, 0.1);
}

TEST(PlantSurrogate, cuts_are_charged_for_from_the_stage_that_rests_on_them) {
  const Case one = dubins({});
  const ModelError error = bounded(Eigen::Vector3d(0.01, 0.01, 0.01));
  PredictedMotion motion = one.motion();
  motion.model_error = &error;
  const std::vector<SurrogateStage> stages = affine_surrogates(motion);
  // At stage 0 the heading equals the surrogate's with certainty, so nothing is cut before stage 2.
  EXPECT_EQ(stages[1].leaving, 0.0);
  const TruncatedError cut = truncate_error(error, 8, kWideCore);
  EXPECT_NEAR(cut.outside, 1e-6 / 8.0, 1e-20);
  for (std::size_t k = 2; k < stages.size(); ++k) {
    EXPECT_GT(stages[k].leaving, static_cast<double>(k - 1) * cut.outside);
  }
}

TEST(ErrorCut, is_as_far_off_as_the_highest_known_norm_asks) {
  ModelError error = model_error_of_size(Eigen::Vector3d(0.1, 0.1, 0.0));
  error.higher[0][1] = 0.2;
  const TruncatedError cut = truncate_error(error, 10, kWideCore);
  // P(|e| > t) ≤ (‖e‖_p/t)^p is 1/30 of 1e-4 by order 2, and of 1e-5 by order 4.
  EXPECT_NEAR(cut.bound.largest()[0], 0.1 / std::sqrt(1e-4 / 30.0), 1e-10);
  EXPECT_NEAR(cut.bound.largest()[1], 0.2 / std::pow(1e-5 / 30.0, 0.25), 1e-10);
  EXPECT_EQ(cut.bound.largest()[2], 0.0);
  EXPECT_NEAR(cut.outside, (1e-4 + 1e-5) / 30.0, 1e-18);
  // A zero error is zero in every norm, even if only its mean square is stated.
  EXPECT_EQ(cut.bound.higher(1)[2], 0.0);
  EXPECT_EQ(cut.bound.higher(1)[0], kInfinity);
}

TEST(PlantSurrogate, unknown_norms_are_unknown_only_where_they_reach) {
  const Case one = dubins({});
  ModelError error = bounded(Eigen::Vector3d(0.01, 0.0, 0.0));
  error.higher[0][models::Dubins::kX] = kInfinity;
  error.higher[1][models::Dubins::kX] = kInfinity;
  PredictedMotion motion = one.motion();
  motion.model_error = &error;
  const SurrogateStage last = affine_surrogates(motion).back();
  EXPECT_EQ(last.higher[1][models::Dubins::kX], kInfinity);
  EXPECT_TRUE(std::isfinite(last.higher[1][models::Dubins::kY]));
  EXPECT_TRUE(last.error.allFinite());
  EXPECT_LT(last.leaving, 1e-4);
}

TEST(PlantSurrogate, what_unknown_norms_of_a_heading_do_is_bounded_by_their_cut) {
  // Straight ahead along x, a heading error affects x only through the residual's slope.
  const Case one = dubins({}, 0.0);
  const ModelError known = bounded(Eigen::Vector3d(0.0, 0.0, 0.02));
  const ModelError unknown = model_error_of_size(known.root_mean_square);
  PredictedMotion motion = one.motion();
  motion.model_error = &known;
  const SurrogateStage with_norms = affine_surrogates(motion).back();
  motion.model_error = &unknown;
  const SurrogateStage without = affine_surrogates(motion).back();
  for (std::size_t k = 0; k < kHigherOrders.size(); ++k) {
    EXPECT_TRUE(std::isfinite(without.higher[k][models::Dubins::kX]));
    EXPECT_GT(without.higher[k][models::Dubins::kX], with_norms.higher[k][models::Dubins::kX]);
    EXPECT_EQ(without.higher[k][models::Dubins::kHeading], kInfinity);
  }
}

TEST(Smoothing, is_that_of_the_last_noise_where_there_is_a_model_error) {
  const Case one = dubins({});
  const ModelError error = bounded(Eigen::Vector3d::Zero());
  PredictedMotion motion = one.motion();
  motion.model_error = &error;
  EXPECT_EQ(smoothing_covariance(motion, 5, {0, 1}), motion.noise_covariance);
  motion.model_error = nullptr;
  motion.belief_error = &error;
  EXPECT_EQ(smoothing_covariance(motion, 5, {0, 1}), motion.noise_covariance);
}

TEST(PlantCertificate, without_any_error_only_the_smoothing_is_less) {
  const Case one = dubins({});
  const SafeSet safe_set = walls(3, 2.0);
  PredictedMotion motion = one.motion();
  const std::vector<StageBudget> model_budgets = error_budget(motion);
  const auto of_model = certify(motion, safe_set, model_budgets, CertificateEffort::kEvery);
  const ModelError none = bounded(Eigen::Vector3d::Zero());
  motion.model_error = &none;
  const std::vector<StageBudget> budgets = error_budget(motion);
  const auto of_plant = certify(motion, safe_set, budgets, CertificateEffort::kEvery);
  for (std::size_t k = 0; k < of_model.size(); ++k) {
    EXPECT_EQ(budgets[k + 1].total, model_budgets[k + 1].total);
    EXPECT_EQ(of_plant[k].of("c1"), of_model[k].of("c1"));
    EXPECT_EQ(of_plant[k].of("c3"), of_model[k].of("c3"));
    EXPECT_GE(of_plant[k].of("c4"), of_model[k].of("c4"));
    EXPECT_EQ(of_plant[k].of("thesis"), of_model[k].of("thesis"));
  }
}

TEST(PlantCertificate, grows_with_the_error_and_with_what_is_unknown_of_it) {
  const Case one = dubins({.closed_loop = true});
  const SafeSet safe_set = walls(3, 2.0);
  PredictedMotion motion = one.motion();
  std::vector<double> last;
  for (const double size : {0.0, 0.002, 0.01, 0.05}) {
    const ModelError known = bounded(Eigen::Vector3d::Constant(size));
    const ModelError unknown = model_error_of_size(Eigen::Vector3d::Constant(size));
    std::vector<double> values;
    for (const ModelError* error : {&known, &unknown}) {
      motion.model_error = error;
      values.push_back(certify(motion, safe_set, error_budget(motion)).back().value);
    }
    EXPECT_LE(values[0], values[1] + kRounding);
    if (!last.empty()) {
      EXPECT_GT(values[0], last[0]);
      EXPECT_GT(values[1], last[1]);
    }
    // A small error costs little.
    if (size == 0.002) {
      EXPECT_LT(values[1], 10.0 * last[1] + 1e-3);
    }
    last = values;
  }
}

}  // namespace certification_plant_certificate_test
}  // namespace qsmpc::controller
