#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "controller/certification/affine_surrogate.hpp"
#include "tests/unit/controller/certification/surrogate_cases.hpp"

namespace qsmpc::controller {
namespace surrogate_core_test {

using namespace testing;

using Event = Eigen::Array<bool, Eigen::Dynamic, 1>;

/// Whether each component of the surrogate's feedback K(z − m), and each coordinate in which the
/// step is not affine, is within `core` deviations of its mean.
Event within_core(const PredictedMotion& motion, Eigen::Index k, const SurrogateStage& stage,
                  const Points& surrogate, double core) {
  const std::vector<bool> affine = affine_coordinates(motion.dynamics);
  Event within = Event::Constant(surrogate.cols(), true);
  const Points offset = surrogate.colwise() - stage.law.mean;
  const auto restrict = [&](const Eigen::RowVectorXd& values, double variance) {
    within = within && (values.transpose().array().abs() <= core * std::sqrt(variance) + 1e-12);
  };
  for (Eigen::Index a = 0; a < offset.rows(); ++a) {
    if (!affine[a]) restrict(offset.row(a), stage.law.covariance(a, a));
  }
  const Eigen::MatrixXd& gain = motion.policy.gains[k];
  for (Eigen::Index b = 0; b < gain.rows(); ++b) {
    restrict(gain.row(b) * offset, gain.row(b) * stage.law.covariance * gain.row(b).transpose());
  }
  return within;
}

/// Share of the paths in the event.
double share(const Event& event) {
  return static_cast<double>(event.count()) / static_cast<double>(event.size());
}

// Some paths leave a narrow core; the error bounds hold on all others.
TEST(SurrogateCore, bounds_hold_inside_of_a_core_that_is_left) {
  Generator generator(115);
  int left = 0;
  for (const Case& one : all_cases(generator)) {
    const PredictedMotion motion = one.motion();
    const std::vector<SurrogateStage> stages = affine_surrogates(motion, kNarrowCore);
    const Pairs pairs = simulate_pairs(motion, stages, generator);
    Event in_cores = Event::Constant(kSamples, true);  // of all stages so far
    Event inside = in_cores;
    for (std::size_t k = 0; k < stages.size(); ++k) {
      const std::string where = one.name + ", stage " + std::to_string(k);
      const double leaving = stages[k].leaving;
      EXPECT_LE(1.0 - share(inside), leaving + 5.0 * std::sqrt(leaving / kSamples)) << where;
      const Points error = pairs.state[k] - pairs.surrogate[k];
      const Points kept = error.array().rowwise() * inside.transpose().cast<double>();
      const Eigen::VectorXd root = root_mean_squares(kept);
      for (Eigen::Index i = 0; i < root.size(); ++i) {
        EXPECT_LE(root[i], 1.1 * stages[k].error[i] + 1e-14) << where << ", coordinate " << i;
      }
      if (k + 1 == stages.size()) continue;
      in_cores = in_cores && within_core(motion, static_cast<Eigen::Index>(k), stages[k],
                                         pairs.surrogate[k], kNarrowCore);
      // Only steps that need their core are charged, including the cores of the steps before them.
      if (stages[k + 1].leaving == leaving) continue;
      inside = in_cores;
      for (int i = 0; i < kSamples; ++i) {
        if (!inside[i]) continue;
        const auto beyond = error.col(i).cwiseAbs().array() > stages[k].largest.array() + 1e-12;
        EXPECT_FALSE(beyond.any()) << where << ", path " << i;
        const auto state = pairs.state[k].col(i).array();
        EXPECT_TRUE((state >= stages[k].region.lower.array() - 1e-12).all() &&
                    (state <= stages[k].region.upper.array() + 1e-12).all())
            << where << ", path " << i;
      }
    }
    left += static_cast<int>(kSamples - inside.count());
  }
  EXPECT_GT(left, 100);
}

// The purpose of the narrow core: for large deviations, leaving it costs less than it saves.
TEST(SurrogateCore, narrow_one_is_left_more_often_and_has_smaller_errors) {
  const Feedback lqr{.closed_loop = true};
  for (const Case& one : {bicycle(lqr), dubins(lqr, 0.3, 0.3), cart_pole(lqr)}) {
    const PredictedMotion motion = one.motion();
    const SurrogateStage wide = affine_surrogates(motion, kWideCore).back();
    const SurrogateStage narrow = affine_surrogates(motion, kNarrowCore).back();
    EXPECT_GT(narrow.leaving, 10.0 * wide.leaving) << one.name;
    EXPECT_LT(narrow.leaving, 0.05) << one.name;
    EXPECT_LT(narrow.largest.norm(), 0.8 * wide.largest.norm()) << one.name;
    EXPECT_LE(narrow.error.norm(), wide.error.norm() * (1.0 + 1e-12)) << one.name;
  }
}

}  // namespace surrogate_core_test
}  // namespace qsmpc::controller
