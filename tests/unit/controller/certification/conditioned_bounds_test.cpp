#include "controller/certification/conditioned_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "controller/certification/surrogate_bounds.hpp"
#include "controller/certification/tilt_split.hpp"
#include "tests/support/executors.hpp"
#include "tests/support/simulated_truth.hpp"
#include "tests/unit/controller/certification/surrogate_cases.hpp"
#include "tests/unit/controller/certification/unsafe_ends.hpp"

namespace qsmpc::controller {
namespace conditioned_bounds_test {

using namespace testing;

constexpr int kPaths = 20000;

SurrogateBounds plain_bounds(const PredictedMotion& motion, const UnsafeSet& unsafe) {
  return surrogate_bounds(motion, unsafe, CertificateEffort::kEvery, run_in_turn);
}

/// A case, its unsafe region, and the maximum of C5 at the last stage relative to the truth and to
/// C4.
struct Hard {
  Case one;
  Eigen::Index axis;
  double over_truth;
  double of_plain;
};

std::vector<Hard> hard_cases() {
  const auto gain = [](const Eigen::MatrixXd& matrix) {
    return Feedback{.closed_loop = true, .gain = matrix};
  };
  return {
      // A heading that is almost unknown.
      {.one = dubins({}, 0.0, 1.0), .axis = 1, .over_truth = 1.2, .of_plain = 0.5},
      // A feedback that is clamped half of the time.
      {.one = double_integrator(gain(Eigen::RowVector2d(-6.0, -4.0)), 0.5, 0.3),
       .axis = 0,
       .over_truth = 2.0,
       .of_plain = 0.1},
      // A pole that has fallen by an uncertain amount.
      {.one = cart_pole({}, 6.0), .axis = 2, .over_truth = 1.3, .of_plain = 0.2},
  };
}

TEST(ConditionedBounds, are_near_the_truth_where_c4_is_not) {
  Generator generator(216);
  for (const Hard& hard : hard_cases()) {
    const PredictedMotion motion = hard.one.motion();
    const SafeSet safe_set = unsafe_at_the_end(hard.one, hard.axis, 0.01);
    const UnsafeSet unsafe(safe_set);
    const SurrogateBounds plain = plain_bounds(motion, unsafe);
    const double bound =
        conditioned_bounds(motion, unsafe, plain, CertificateEffort::kEvery, run_in_turn)
            .stages.back();
    const UnsafeCounts counts = simulate(motion, safe_set, kPaths, generator);
    const double truth = static_cast<double>(counts.stages.back()) / kPaths;
    EXPECT_GE(bound, truth - 5.0 * std::sqrt(truth / kPaths)) << hard.one.name;
    EXPECT_LE(bound, hard.over_truth * truth) << hard.one.name;
    EXPECT_LE(bound, hard.of_plain * plain.bounds.back().smooth) << hard.one.name;
  }
}

TEST(ConditionedBounds, fall_with_the_effort_and_stay_above_the_truth) {
  Generator generator(218);
  // Clamped at every stage: a hundred laws are too few.
  const Case one =
      double_integrator({.closed_loop = true, .gain = Eigen::RowVector2d(-6.0, -4.0)}, 0.5, 0.3);
  const PredictedMotion motion = one.motion();
  const SafeSet safe_set = unsafe_at_the_end(one, 0, 0.01);
  const UnsafeSet unsafe(safe_set);
  const SurrogateBounds plain = plain_bounds(motion, unsafe);
  const auto last = [&](CertificateEffort effort) {
    const ConditionedBounds bounds = conditioned_bounds(motion, unsafe, plain, effort, run_in_turn);
    EXPECT_GE(*std::min_element(bounds.entries.begin(), bounds.entries.end()), 0.0);
    return bounds.stages.back();
  };
  const double every = last(CertificateEffort::kEvery);
  const double tightest = last(CertificateEffort::kTightest);
  const UnsafeCounts counts = simulate(motion, safe_set, kPaths, generator);
  const double truth = static_cast<double>(counts.stages.back()) / kPaths;
  EXPECT_LT(tightest, 0.95 * every);
  EXPECT_GE(tightest, truth - 5.0 * std::sqrt(truth / kPaths));
}

TEST(ConditionedBounds, count_as_unsafe_what_no_part_covers) {
  const Case one = dubins({}, 0.0, 1.0);
  const PredictedMotion motion = one.motion();
  SafeSet safe_set = unbounded_safe_set(3);
  safe_set.bounds.upper[1] = 9.0;  // eight deviations away: the parts' bounds are about 1e-11
  const UnsafeSet unsafe(safe_set);
  const SurrogateBounds plain = plain_bounds(motion, unsafe);
  const TiltSplit split = best_split(motion, {}, plain.surrogates, 100.0, run_in_turn);
  ASSERT_GT(split.left_out, 0.0);
  const ConditionedBounds bounds =
      conditioned_bounds(motion, unsafe, plain, CertificateEffort::kEvery, run_in_turn);
  ASSERT_LT(bounds.stages.back(), plain.bounds.back().smooth);
  EXPECT_GE(bounds.stages.back(), split.left_out);
}

TEST(ConditionedBounds, do_not_depend_on_the_order_of_the_work) {
  const Case one = dubins({}, 0.0, 1.0);
  const PredictedMotion motion = one.motion();
  const SafeSet safe_set = unsafe_at_the_end(one, 1, 0.01);
  const UnsafeSet unsafe(safe_set);
  const SurrogateBounds plain = plain_bounds(motion, unsafe);
  const ConditionedBounds bounds =
      conditioned_bounds(motion, unsafe, plain, CertificateEffort::kEvery, run_in_turn);
  EXPECT_LT(*std::min_element(bounds.stages.begin(), bounds.stages.end()), 1.0);
  for (const Executor& run : {Executor(run_backwards), Executor(run_on_threads)}) {
    const ConditionedBounds again =
        conditioned_bounds(motion, unsafe, plain, CertificateEffort::kEvery, run);
    EXPECT_EQ(again.stages, bounds.stages);
    EXPECT_EQ(again.entries, bounds.entries);
  }
}

TEST(ConditionedBounds, are_not_worked_out_where_there_is_nothing_to_gain) {
  // The step is affine and nothing is clamped: C4 is the exact probability.
  const Case one = double_integrator({});
  const SafeSet safe_set = unsafe_at_the_end(one, 0, 0.01);
  const UnsafeSet unsafe(safe_set);
  const PredictedMotion motion = one.motion();
  const ConditionedBounds none = conditioned_bounds(motion, unsafe, plain_bounds(motion, unsafe),
                                                    CertificateEffort::kEvery, run_in_turn);
  EXPECT_EQ(none.stages, std::vector<double>(8, 1.0));
  EXPECT_TRUE(none.entries.empty());
}

TEST(ConditionedBounds, say_nothing_of_a_plant_with_a_model_error) {
  const Case one = dubins({}, 0.0, 1.0);
  const SafeSet safe_set = unsafe_at_the_end(one, 1, 0.01);
  const UnsafeSet unsafe(safe_set);
  const ModelError error = model_error_of_size(Eigen::Vector3d::Constant(1e-3));
  PredictedMotion motion = one.motion();
  motion.model_error = &error;
  const ConditionedBounds none = conditioned_bounds(motion, unsafe, plain_bounds(motion, unsafe),
                                                    CertificateEffort::kEvery, run_in_turn);
  EXPECT_EQ(none.stages, std::vector<double>(8, 1.0));
  EXPECT_TRUE(none.entries.empty());
}

}  // namespace conditioned_bounds_test
}  // namespace qsmpc::controller
