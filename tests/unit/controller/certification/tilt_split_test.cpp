#include "controller/certification/tilt_split.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "controller/measure/normal/normal_distribution.hpp"
#include "tests/unit/controller/certification/surrogate_cases.hpp"

namespace qsmpc::controller {
namespace tilt_split_test {

using namespace testing;

constexpr double kMany = 1000.0;

std::vector<SurrogateStage> untilted(const PredictedMotion& motion) {
  return affine_surrogates(motion);
}

/// Density of the functionals' values under the law; they are N(0, 1) unless the tilt says
/// otherwise.
double density(const PathTilt& law, const Eigen::VectorXd& values) {
  double product = 1.0;
  for (Eigen::Index r = 0; r < values.size(); ++r) {
    const bool held = r < law.spreads.size();
    const double spread = held ? law.spreads[r] : 1.0;
    const double centre = held ? law.centre[r] : 0.0;
    product *= normal_density((values[r] - centre) / spread) / spread;
  }
  return product;
}

/// Splits the law, and a part of it again and again, `depth` times. Every split must exceed the law
/// that it replaces, wherever the functionals are.
void expect_splits_dominate(const PredictedMotion& motion, const std::string& name, int depth,
                            Generator& generator) {
  PathTilt law;
  for (int level = 0; level < depth; ++level) {
    const TiltSplit split = best_split(motion, law, untilted(motion), kMany, run_in_turn);
    ASSERT_FALSE(split.parts.empty()) << name << ' ' << level;
    ASSERT_EQ(split.weights.size(), static_cast<Eigen::Index>(split.parts.size()));
    EXPECT_NEAR(split.weights.sum() + split.left_out, 1.0, 0.01) << name;
    const Eigen::Index count = split.parts[0].spreads.size();
    for (int trial = 0; trial < 100; ++trial) {
      Eigen::VectorXd values = 0.7 * random_matrix(generator, count, 1);
      for (Eigen::Index r = 0; r < law.spreads.size(); ++r) {
        values[r] = law.centre[r] + law.spreads[r] * values[r];
      }
      double sum = 0.0;
      for (std::size_t i = 0; i < split.parts.size(); ++i) {
        sum += split.weights[static_cast<Eigen::Index>(i)] * density(split.parts[i], values);
      }
      EXPECT_GE(sum, 0.9999 * density(law, values)) << name << ' ' << level;
      EXPECT_LE(sum, 1.02 * density(law, values)) << name << ' ' << level;
    }
    law = split.parts[split.parts.size() / 3];
  }
}

TEST(TiltSplit, has_parts_that_together_exceed_the_law) {
  Generator generator(217);
  const Feedback lqr{.closed_loop = true};
  for (const Case& one :
       {dubins({}, 0.0, 1.0), dubins(lqr, 0.0, 1.0), bicycle(lqr), cart_pole({}, 6.0)}) {
    expect_splits_dominate(one.motion(), one.name, 3, generator);
  }
}

TEST(TiltSplit, leaves_smaller_errors) {
  const Case one = dubins({.closed_loop = true}, 0.0, 1.0);
  const PredictedMotion motion = one.motion();
  const std::vector<SurrogateStage> whole = untilted(motion);
  const TiltSplit split = best_split(motion, {}, whole, kMany, run_in_turn);
  ASSERT_FALSE(split.parts.empty());
  Eigen::VectorXd errors = Eigen::VectorXd::Zero(3);
  for (std::size_t i = 0; i < split.parts.size(); ++i) {
    errors += split.weights[static_cast<Eigen::Index>(i)] *
              affine_surrogates(motion, kWideCore, split.parts[i])[4].error.cwiseAbs2();
  }
  EXPECT_LT(errors[0], 0.25 * whole[4].error[0] * whole[4].error[0]);
  EXPECT_LT(errors[1], 0.25 * whole[4].error[1] * whole[4].error[1]);
}

TEST(TiltSplit, is_none_where_no_error_is_left) {
  const Case one = double_integrator({});
  const PredictedMotion motion = one.motion();
  EXPECT_TRUE(best_split(motion, {}, untilted(motion), kMany, run_in_turn).parts.empty());
}

TEST(TiltSplit, has_no_more_parts_than_allowed) {
  const Case one = dubins({}, 0.0, 1.0);
  const PredictedMotion motion = one.motion();
  const std::vector<SurrogateStage> whole = untilted(motion);
  const std::size_t many = best_split(motion, {}, whole, kMany, run_in_turn).parts.size();
  for (double most = 1.0; most <= kMany; most *= 1.5) {
    const std::size_t parts = best_split(motion, {}, whole, most, run_in_turn).parts.size();
    EXPECT_LE(static_cast<double>(parts), most);
    EXPECT_LE(parts, many);
  }
}

}  // namespace tilt_split_test
}  // namespace qsmpc::controller
