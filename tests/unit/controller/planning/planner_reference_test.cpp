// Prediction and cost along a horizon against their plain versions.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "controller/planning/cost/horizon_cost.hpp"
#include "controller/prediction/prediction.hpp"
#include "tests/support/plain_planner.hpp"
#include "tests/unit/controller/measure/reference_cases.hpp"

namespace qsmpc::controller {
namespace planner_reference_test {

using namespace testing;

// Relative to the values' scale: rounding of some ten thousand operations, amplified along the
// horizon.
constexpr double kTolerance = 1e-9;

double scale_of(const Eigen::Ref<const Eigen::MatrixXd>& values) {
  return std::max(1.0, values.cwiseAbs().maxCoeff());
}

void expect_same_prediction(const Prediction& fast, const PlainPrediction& plain) {
  ASSERT_EQ(fast.stages.size(), plain.stages.size());
  for (std::size_t k = 0; k < fast.stages.size(); ++k) {
    const DiscreteMeasure& stage = fast.stages[k];
    ASSERT_EQ(stage.size(), static_cast<Eigen::Index>(plain.stages[k].size())) << "stage " << k;
    const double scale = scale_of(stage.locations);
    double apart = 0.0;
    double weights_apart = 0.0;
    for (Eigen::Index i = 0; i < stage.size(); ++i) {
      const PlainParticle& particle = plain.stages[k][i];
      apart = std::max(apart, (stage.locations.col(i) - particle.state).cwiseAbs().maxCoeff());
      weights_apart = std::max(weights_apart, std::abs(stage.weights[i] - particle.weight));
    }
    EXPECT_LE(apart, kTolerance * scale) << "stage " << k;
    EXPECT_LE(weights_apart, kTolerance) << "stage " << k;
    if (k > 0) {
      EXPECT_NEAR(fast.maps[k - 1].compression_w2, plain.w2[k - 1], kTolerance * scale);
    }
  }
}

class Reference : public ::testing::TestWithParam<ReferenceCase> {};

TEST_P(Reference, prediction_cost_and_gradient_agree) {
  const ReferenceProblem problem(GetParam());
  const Policy& policy = problem.policy();
  const PlainPrediction plain =
      plain_predict(problem.dynamics(), problem.start(), policy, problem.plain_noise());
  const Prediction fast = problem.predict();
  expect_same_prediction(fast, plain);
  if (HasFailure()) return;

  HorizonCost cost(problem.terms(), fast, policy);
  Generator generator(77);
  // At the policy itself and close to it, with the maps held fixed.
  for (const double step : {0.0, 0.05}) {
    const Eigen::MatrixXd inputs =
        policy.inputs + random_matrix(generator, policy.inputs.rows(), policy.horizon(), step);
    const Eigen::MatrixXd change =
        random_matrix(generator, policy.inputs.rows(), policy.states.rows(), step);
    for (const bool with_gain : {false, true}) {
      if (with_gain && !GetParam().closed_loop) continue;
      Eigen::VectorXd z(inputs.size() + (with_gain ? change.size() : 0));
      z.head(inputs.size()) = inputs.reshaped();
      if (with_gain) z.tail(change.size()) = change.reshaped();
      Eigen::VectorXd gradient = Eigen::VectorXd::Constant(z.size(), std::nan(""));
      const double value = cost.evaluate(z, gradient);
      const PlainCost expected =
          plain_cost(problem.terms(), plain, policy, inputs,
                     with_gain ? change : Eigen::MatrixXd(0.0 * change), with_gain);
      const double scale = std::max(1.0, expected.parts.total());
      EXPECT_NEAR(value, expected.parts.total(), kTolerance * scale);
      EXPECT_NEAR(cost.parts().of("state"), expected.parts.of("state"), kTolerance * scale);
      EXPECT_NEAR(cost.parts().of("input"), expected.parts.of("input"), kTolerance * scale);
      EXPECT_NEAR(cost.parts().of("terminal"), expected.parts.of("terminal"), kTolerance * scale);
      EXPECT_NEAR(cost.parts().of("box"), expected.parts.of("box"), kTolerance * scale);
      EXPECT_NEAR(cost.parts().of("obstacle"), expected.parts.of("obstacle"), kTolerance * scale);
      const Eigen::VectorXd of_inputs = expected.input_gradient.reshaped();
      EXPECT_LE((gradient.head(inputs.size()) - of_inputs).cwiseAbs().maxCoeff(),
                kTolerance * scale_of(of_inputs));
      if (!with_gain) continue;
      const Eigen::VectorXd of_gain = expected.gain_gradient.reshaped();
      EXPECT_LE((gradient.tail(change.size()) - of_gain).cwiseAbs().maxCoeff(),
                kTolerance * scale_of(of_gain));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(cases, Reference, ::testing::ValuesIn(reference_cases()),
                         [](const auto& information) { return name_of(information.param); });

TEST(ReferenceCases, meet_walls_obstacles_and_input_bounds) {
  // Otherwise the comparisons above would compare zeros.
  for (const ReferenceCase& options : reference_cases()) {
    if (options.points < 100) continue;
    const ReferenceProblem problem(options);
    const Prediction prediction = problem.predict();
    HorizonCost cost(problem.terms(), prediction, problem.policy());
    const Eigen::VectorXd z = problem.policy().inputs.reshaped();
    (void)cost.evaluate(z);
    EXPECT_GT(cost.parts().of("box"), 0.0) << name_of(options);
    EXPECT_GT(cost.parts().of("obstacle"), 0.0) << name_of(options);
    EXPECT_EQ(problem.saturated() > 0, options.closed_loop) << name_of(options);
  }
}

}  // namespace planner_reference_test
}  // namespace qsmpc::controller
