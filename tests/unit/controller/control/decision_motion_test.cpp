// Certificates of any decision: with particles, with a policy only, or with a single input.
#include "controller/control/decision_motion.hpp"

#include <memory>

#include <boost/math/distributions/binomial.hpp>
#include <gtest/gtest.h>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "controller/planning/planner.hpp"
#include "tests/support/simulated_truth.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace decision_motion_test {

using namespace testing;

constexpr int kPaths = 20000;

/// The car on a path close to a wall.
PlannerSettings beside_a_wall() {
  PlannerSettings problem = dubins_settings();
  problem.cost.target << 5.0, 0.0, 0.0;
  problem.safe_set.bounds.upper[1] = 0.35;
  return problem;
}

/// Clopper–Pearson: the truth is below this with a probability of at most 1e-6.
double lower_limit(int successes) {
  if (successes == 0) return 0.0;
  return boost::math::binomial_distribution<>::find_lower_bound_on_p(kPaths, successes, 1e-6);
}

std::vector<StageCertificate> certificates_of(const PredictedMotion& motion,
                                              const SafeSet& safe_set) {
  return certify(motion, safe_set, error_budget(motion));
}

TEST(DecisionMotion, of_a_planners_decision_is_the_planners_own) {
  const auto car = dubins_car();
  const PlannerSettings problem = beside_a_wall();
  const Gaussian belief = dubins_belief();
  const Eigen::VectorXd seen = belief.mean;
  const Situation situation{.belief = belief, .observation = seen};
  const auto controller = make_controller("quantised", *car, {.problem = problem});
  DecisionMotion motions(*car, problem);
  const PredictedMotion motion = motions.of(situation, controller->decide(situation), belief);

  Planner planner(*car, problem);
  const PredictedMotion own = motion_of(planner, belief, planner.plan(belief));
  EXPECT_EQ(motion.belief_w2, own.belief_w2);
  EXPECT_EQ(motion.noise_w2, own.noise_w2);
  const auto certificates = certificates_of(motion, problem.safe_set);
  const auto expected = certificates_of(own, problem.safe_set);
  ASSERT_EQ(certificates.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_EQ(certificates[k].value, expected[k].value);
  }
}

/// Every controller's certificates hold for the model under its decision.
TEST(DecisionMotion, certificates_of_every_controller_hold_for_simulated_paths) {
  const auto car = dubins_car();
  const PlannerSettings problem = beside_a_wall();
  Gaussian belief = dubins_belief();
  belief.covariance(0, 1) = belief.covariance(1, 0) = 0.004;
  Generator generator(11);
  int informative = 0;
  for (const ControllerEntry& entry : controllers()) {
    for (const LqrAbout about : {LqrAbout::kPath, LqrAbout::kTarget}) {
      SCOPED_TRACE(entry.name);
      const ControllerSettings settings{.problem = problem, .lqr_about = about};
      const auto controller = make_controller(entry.name, *car, settings);
      DecisionMotion motions(*car, problem);
      // The second place is close enough to the wall for the next step to matter.
      for (const double y : {0.0, 0.12}) {
        belief.mean[1] = y;
        const Eigen::VectorXd seen = belief.mean + Eigen::Vector3d(0.02, 0.03, 0.1);
        const Gaussian posterior{.mean = seen, .covariance = 0.1 * belief.covariance};
        const Situation situation{.belief = belief, .observation = seen};
        const Decision& decision = controller->decide(situation);
        const PredictedMotion motion = motions.of(situation, decision, posterior);
        EXPECT_EQ(&motion.belief, decision.policy != nullptr ? &belief : &posterior);
        const auto certificates = certificates_of(motion, problem.safe_set);
        const int stages = entry.parts(settings).stages;
        ASSERT_EQ(std::ssize(certificates), stages > 0 ? stages : 1);
        const UnsafeCounts truth = simulate(motion, problem.safe_set, kPaths, generator);
        for (std::size_t k = 0; k < certificates.size(); ++k) {
          EXPECT_GE(certificates[k].value, lower_limit(truth.stages[k])) << "stage " << k + 1;
          if (truth.stages[k] > 20 && certificates[k].value < 0.5) ++informative;
        }
      }
    }
  }
  EXPECT_GT(informative, 5);
}

TEST(DecisionMotion, without_a_policy_is_the_next_step_alone_under_the_input) {
  const auto car = dubins_car();
  const PlannerSettings problem = beside_a_wall();
  const Gaussian belief = dubins_belief();
  const Eigen::VectorXd seen = Eigen::Vector3d(0.1, 0.05, 0.2);
  const Gaussian known{.mean = seen, .covariance = Eigen::Matrix3d::Zero()};
  const Situation situation{.belief = belief, .observation = seen};
  Decision decision;
  decision.input = Eigen::VectorXd::Constant(1, 0.7);
  DecisionMotion motions(*car, problem);
  const PredictedMotion motion = motions.of(situation, decision, known);
  EXPECT_EQ(motion.policy.inputs, Eigen::MatrixXd::Constant(1, 1, 0.7));
  EXPECT_TRUE(motion.policy.gains.front().isZero(0.0));
  // The model's step from the known state; its law is the noise about it.
  const Eigen::MatrixXd path = nominal_states(*car, seen, decision.input);
  EXPECT_EQ(motion.belief_w2, 0.0);
  EXPECT_EQ(motion.prediction.stepped.front().col(0), path.col(1));
}

}  // namespace decision_motion_test
}  // namespace qsmpc::controller
