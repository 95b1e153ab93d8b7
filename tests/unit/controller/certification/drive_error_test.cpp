// Model errors that differ in the first periods of a drive: which one applies at which stage of a
// plan, and that known offsets move the surrogate.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "controller/certification/error_truncation.hpp"
#include "models/dynamics/dubins.hpp"
#include "tests/unit/controller/certification/surrogate_cases.hpp"

namespace qsmpc::controller {
namespace drive_error_test {

using namespace testing;

// Rounding of sums and products of few terms of order one.
constexpr double kRounding = 1e-14;

/// A model error that is `size` in every norm about `offset`, and bounded by it.
ModelError bounded(const Eigen::VectorXd& size, const Eigen::VectorXd& offset = {}) {
  ModelError error = model_error_of_size(size);
  for (Eigen::VectorXd& norms : error.higher) norms = size;
  error.offset = offset;
  return error;
}

/// Errors of the first two periods and of later ones, each with its own size and offset.
ModelError of_a_drive() {
  ModelError error = bounded(Eigen::Vector3d(1e-3, 2e-3, 3e-3));
  error.first = {
      bounded(Eigen::Vector3d(0.02, 0.03, 0.04), Eigen::Vector3d(0.05, -0.06, 0.07)),
      bounded(Eigen::Vector3d(4e-3, 5e-3, 6e-3), Eigen::Vector3d(0.0, 0.01, -0.02)),
  };
  return error;
}

SafeSet walls(double width) {
  SafeSet safe_set = unbounded_safe_set(3);
  safe_set.bounds.lower[0] = -width;
  safe_set.bounds.upper[0] = width;
  return safe_set;
}

TEST(DriveError, is_its_own_in_the_first_periods_and_the_same_in_all_later_ones) {
  const ModelError error = of_a_drive();
  EXPECT_EQ(&error.of_period(0), &error.first[0]);
  EXPECT_EQ(&error.of_period(1), &error.first[1]);
  EXPECT_EQ(&error.of_period(2), &error);
  EXPECT_EQ(&error.of_period(1000), &error);
}

TEST(DriveBudget, takes_the_radius_of_every_period) {
  const Case one = dubins({});
  const ModelError error = of_a_drive();
  PredictedMotion motion = one.motion();
  motion.model_error = &error;
  for (const Eigen::Index begin : {0, 1, 2}) {
    motion.first_period = begin;
    motion.belief_error = begin == 0 ? nullptr : &error.of_period(begin - 1);
    const std::vector<StageBudget> budgets = error_budget(motion);
    EXPECT_EQ(budgets[0].model, begin == 0 ? 0.0 : error.of_period(begin - 1).radius());
    for (std::size_t k = 0; k + 1 < budgets.size(); ++k) {
      const double radius = error.of_period(begin + static_cast<Eigen::Index>(k)).radius();
      EXPECT_NEAR(budgets[k + 1].model, budgets[k].lipschitz * budgets[k].model + radius, kRounding)
          << "period " << begin << ", stage " << k;
      EXPECT_NEAR(budgets[k + 1].before_noise, budgets[k].lipschitz * budgets[k].total + radius,
                  kRounding);
    }
  }
}

TEST(DriveSurrogate, of_an_affine_system_moves_by_the_offsets_and_errs_by_the_rest) {
  const Case one = double_integrator({});
  ModelError error = bounded(Eigen::Vector2d(0.001, 0.002));
  error.first = {bounded(Eigen::Vector2d(0.02, 0.03), Eigen::Vector2d(0.3, -0.4)),
                 bounded(Eigen::Vector2d(0.005, 0.0), Eigen::Vector2d(-0.1, 0.2))};
  PredictedMotion motion = one.motion();
  const std::vector<SurrogateStage> of_model = affine_surrogates(motion);
  motion.model_error = &error;
  motion.belief_error = &error.first[0];
  motion.first_period = 1;
  const std::vector<SurrogateStage> stages = affine_surrogates(motion);
  Eigen::VectorXd moved = error.first[0].offset;
  Eigen::VectorXd sum = error.first[0].root_mean_square;
  for (std::size_t k = 0; k < stages.size(); ++k) {
    EXPECT_LE((stages[k].law.mean - of_model[k].law.mean - moved).norm(), kRounding) << k;
    EXPECT_EQ(stages[k].law.covariance, of_model[k].law.covariance);
    EXPECT_LE((stages[k].error - sum).norm(), kRounding) << k;
    EXPECT_LE((stages[k].higher[1] - sum).norm(), kRounding) << k;
    if (k + 1 == stages.size()) break;
    const ModelError& own = error.of_period(static_cast<Eigen::Index>(k) + 1);
    moved = stages[k].transition * moved;
    if (own.offset.size() > 0) moved += own.offset;
    sum = stages[k].transition.cwiseAbs() * sum + own.root_mean_square;
  }
}

/// Compares everything that certificates consist of, stage by stage.
void expect_equal(const PredictedMotion& one, const PredictedMotion& other) {
  const std::vector<StageBudget> budgets = error_budget(one);
  const std::vector<StageBudget> other_budgets = error_budget(other);
  const auto certificates = certify(one, walls(1.5), budgets);
  const auto others = certify(other, walls(1.5), other_budgets);
  for (std::size_t k = 0; k < certificates.size(); ++k) {
    EXPECT_EQ(budgets[k + 1].total, other_budgets[k + 1].total) << k;
    EXPECT_EQ(certificates[k].of("c1"), others[k].of("c1")) << k;
    EXPECT_EQ(certificates[k].of("c2"), others[k].of("c2")) << k;
    EXPECT_EQ(certificates[k].of("c3"), others[k].of("c3")) << k;
    EXPECT_EQ(certificates[k].of("c4"), others[k].of("c4")) << k;
  }
}

TEST(DriveCertificate, of_a_plan_made_later_is_that_without_the_first_periods) {
  for (const bool closed_loop : {false, true}) {
    const Case one = dubins({.closed_loop = closed_loop});
    const ModelError error = of_a_drive();
    ModelError later = error;
    later.first.clear();
    PredictedMotion motion = one.motion();
    motion.model_error = &error;
    motion.belief_error = &error.of_period(2);
    motion.first_period = 3;
    PredictedMotion plain = one.motion();
    plain.model_error = &later;
    plain.belief_error = &later;
    expect_equal(motion, plain);
  }
}

TEST(DriveCertificate, of_periods_that_are_all_alike_is_that_of_one_error) {
  const Case one = dubins({.closed_loop = true});
  const ModelError same = bounded(Eigen::Vector3d(0.01, 0.02, 0.01));
  ModelError error = same;
  error.first = {same, same, same};
  PredictedMotion motion = one.motion();
  motion.model_error = &error;
  PredictedMotion plain = one.motion();
  plain.model_error = &same;
  expect_equal(motion, plain);
}

TEST(DriveCertificate, of_a_plan_made_at_the_start_is_worse_than_that_of_one_made_later) {
  const Case one = dubins({.closed_loop = true});
  ModelError error = of_a_drive();
  for (ModelError& own : error.first) own.offset = {};
  PredictedMotion motion = one.motion();
  motion.model_error = &error;
  const auto at_the_start = certify(motion, walls(1.5), error_budget(motion));
  motion.first_period = 2;
  const auto later = certify(motion, walls(1.5), error_budget(motion));
  for (std::size_t k = 4; k < later.size(); ++k) {
    EXPECT_GT(at_the_start[k].value, later[k].value) << k;
  }
}

// A push into the wall in the first period only, with its direction known or unknown: certificates
// from the error of later periods miss it.
TEST(DriveCertificate, without_the_first_periods_error_is_no_bound) {
  constexpr double kWall = 0.25;  // m, ahead of the model's position after one period
  constexpr double kPush = 0.5;   // m, twenty-five deviations beyond the wall
  const Case one = make_case(
      "pushed", dubins_car(), around(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(0.01)),
      Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal(), Eigen::VectorXd::Zero(1), {}, 1);
  SafeSet safe_set = unbounded_safe_set(3);
  safe_set.bounds.upper[0] = dubins_car()->unicycle()->reach + kWall;
  ModelError error = bounded(Eigen::Vector3d::Constant(1e-3));
  PredictedMotion motion = one.motion();
  motion.model_error = &error;
  const auto value = [&] {
    return certify(motion, safe_set, error_budget(motion), CertificateEffort::kEvery)[0];
  };
  EXPECT_LT(value().value, 1e-3);
  const Eigen::Vector3d push(kPush, 0.0, 0.0);
  for (const ModelError& first : {bounded(push), bounded(Eigen::Vector3d::Zero(), push)}) {
    error.first = {first};
    EXPECT_GT(value().of("c1"), 1.0 - 1e-6);
    EXPECT_GT(value().of("c2"), 1.0 - 1e-6);
    EXPECT_GT(value().of("c3"), 1.0 - 1e-6);
    EXPECT_GT(value().of("c4"), 1.0 - 1e-6);
    motion.first_period = 1;
    EXPECT_LT(value().value, 1e-3);
    motion.first_period = 0;
  }
}

TEST(DriveSurrogate, cuts_each_periods_error_off_where_its_own_norms_say) {
  const Case one = dubins({});
  ModelError error = of_a_drive();
  PredictedMotion motion = one.motion();
  motion.model_error = &error;
  motion.belief_error = &error.first[0];
  motion.first_period = 1;
  const SurrogateStage start = affine_surrogates(motion).front();
  // Nine errors: those of eight periods and that of the belief.
  const TruncatedError cut = truncate_error(error.first[0], 9, kWideCore);
  EXPECT_EQ(start.largest, cut.bound.largest());
  EXPECT_EQ(start.error, error.first[0].root_mean_square);
  const SurrogateStage next = affine_surrogates(motion)[1];
  const TruncatedError own = truncate_error(error.first[1], 9, kWideCore);
  EXPECT_TRUE((next.largest.array() >= own.bound.largest().array()).all());
  // The heading's error is carried over unchanged, and no residual is added to it.
  EXPECT_NEAR(
      next.largest[models::Dubins::kHeading],
      cut.bound.largest()[models::Dubins::kHeading] + own.bound.largest()[models::Dubins::kHeading],
      1e-12);
}

}  // namespace drive_error_test
}  // namespace qsmpc::controller
