#include "controller/certification/affine_surrogate.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "models/constants.hpp"
#include "models/dynamics/dubins.hpp"
#include "models/dynamics/templated_dynamics.hpp"
#include "tests/unit/controller/certification/surrogate_cases.hpp"

namespace qsmpc::controller {
namespace affine_surrogate_test {

using namespace testing;

TEST(AffineSurrogate, law_is_that_of_simulated_paths) {
  Generator generator(111);
  for (const Case& one : all_cases(generator)) {
    const PredictedMotion motion = one.motion();
    const std::vector<SurrogateStage> stages = affine_surrogates(motion);
    const Pairs pairs = simulate_pairs(motion, stages, generator);
    ASSERT_EQ(stages.size(), 9U);
    for (std::size_t k = 0; k < stages.size(); ++k) {
      const Gaussian& law = stages[k].law;
      const Eigen::MatrixXd covariance = sample_covariance(pairs.surrogate[k], pairs.surrogate[k]);
      const Eigen::VectorXd mean = pairs.surrogate[k].rowwise().mean();
      const Eigen::VectorXd deviation = law.covariance.diagonal().cwiseSqrt();
      // Five standard errors; that of a covariance is at most √2 times the product of the
      // deviations.
      const double five = 5.0 / std::sqrt(kSamples);
      for (Eigen::Index i = 0; i < mean.size(); ++i) {
        EXPECT_NEAR(mean[i], law.mean[i], five * deviation[i]) << one.name << k;
        for (Eigen::Index j = 0; j < mean.size(); ++j) {
          EXPECT_NEAR(covariance(i, j), law.covariance(i, j),
                      1.5 * five * deviation[i] * deviation[j])
              << one.name << k;
        }
      }
      EXPECT_EQ(law.covariance, law.covariance.transpose());
    }
  }
}

TEST(AffineSurrogate, error_and_region_bound_what_simulated_states_do) {
  Generator generator(112);
  for (const Case& one : all_cases(generator)) {
    const PredictedMotion motion = one.motion();
    const std::vector<SurrogateStage> stages = affine_surrogates(motion);
    const Pairs pairs = simulate_pairs(motion, stages, generator);
    EXPECT_EQ(stages[0].error, Eigen::VectorXd::Zero(stages[0].error.size()));
    EXPECT_EQ(stages[0].leaving, 0.0);
    for (std::size_t k = 0; k < stages.size(); ++k) {
      const Eigen::VectorXd distance = root_mean_squares(pairs.state[k] - pairs.surrogate[k]);
      for (Eigen::Index i = 0; i < distance.size(); ++i) {
        // Squares of second and third order in normal variables: their sample's root mean square is
        // within 10 %. Sums of numbers of order one are rounded even if the two are equal.
        EXPECT_LE(distance[i], 1.1 * stages[k].error[i] + 1e-14)
            << one.name << ", stage " << k << ", coordinate " << i;
      }
      for (std::size_t order = 0; order < kHigherOrders.size(); ++order) {
        const Points offset = pairs.state[k] - pairs.surrogate[k];
        const double p = kHigherOrders[order];
        const Eigen::VectorXd norms =
            offset.array().abs().pow(p).rowwise().mean().pow(1.0 / p).matrix();
        for (Eigen::Index i = 0; i < norms.size(); ++i) {
          // Sample means of these powers are more often below the truth than above it.
          EXPECT_LE(norms[i], 1.1 * stages[k].higher[order][i] + 1e-14)
              << one.name << ", stage " << k << ", coordinate " << i << ", order " << p;
        }
      }
      EXPECT_LE(stages[k].leaving, 1e-5);
      EXPECT_GE(stages[k].leaving, k == 0 ? 0.0 : stages[k - 1].leaving);
      // 1e-5 of 10,000 paths are a tenth of a path.
      const auto below = pairs.state[k].colwise() - stages[k].region.lower;
      const auto above = (-pairs.state[k]).colwise() + stages[k].region.upper;
      const auto inside =
          (below.array() >= 0.0).colwise().all() && (above.array() >= 0.0).colwise().all();
      EXPECT_EQ(inside.count(), kSamples) << one.name << ", stage " << k;
    }
  }
}

TEST(AffineSurrogate, error_is_tight_where_the_step_is_nearly_affine) {
  Generator generator(113);
  struct Expected {
    Case one;
    double ratio;
  };
  // In open loop the unicycle's error is exact. Otherwise the last stage's error is at most this
  // multiple of the error of simulated paths.
  const Feedback lqr{.closed_loop = true};
  for (const Expected& expected : std::vector<Expected>{{dubins({}), 1.1},
                                                        {skewed_dubins({}, generator), 1.15},
                                                        {dubins(lqr), 1.2},
                                                        {skewed_dubins(lqr, generator), 2.0},
                                                        {bicycle({}), 3.0},
                                                        {bicycle(lqr), 5.0}}) {
    const PredictedMotion motion = expected.one.motion();
    const std::vector<SurrogateStage> stages = affine_surrogates(motion);
    const Pairs pairs = simulate_pairs(motion, stages, generator);
    const Eigen::VectorXd distance = root_mean_squares(pairs.state.back() - pairs.surrogate.back());
    for (Eigen::Index i = 0; i < 2; ++i) {
      EXPECT_LE(stages.back().error[i], expected.ratio * distance[i]) << expected.one.name << i;
    }
  }
}

TEST(AffineSurrogate, known_example_has_the_known_error) {
  // Belief N(0, 0.01 I), u = 0.3, noise diag(0.01, 0.01, 0.001), 0.15 m per step: 0.0104 at stage
  // 8.
  const Case one = dubins({});
  const std::vector<SurrogateStage> stages = affine_surrogates(one.motion());
  ASSERT_EQ(stages.size(), 9U);
  EXPECT_NEAR(stages.back().error.norm(), 0.0104, 5e-5);  // as published
  EXPECT_EQ(stages.back().error[models::Dubins::kHeading], 0.0);
  EXPECT_EQ(stages.back().leaving, 0.0);
}

TEST(AffineSurrogate, is_the_state_of_an_affine_system_that_never_saturates) {
  const Case one = double_integrator({});
  for (const SurrogateStage& stage : affine_surrogates(one.motion())) {
    EXPECT_EQ(stage.error, Eigen::Vector2d::Zero());
    EXPECT_EQ(stage.leaving, 0.0);
    EXPECT_EQ(stage.region.lower, Eigen::Vector2d::Constant(-kInfinity));
    EXPECT_EQ(stage.region.upper, Eigen::Vector2d::Constant(kInfinity));
  }
}

TEST(AffineSurrogate, regions_are_charged_for) {
  // A region that does not contain everything with certainty is charged for, even if the error does
  // not use it.
  Generator generator(114);
  for (const Case& one : all_cases(generator)) {
    const std::vector<SurrogateStage> stages = affine_surrogates(one.motion());
    for (std::size_t k = 0; k + 1 < stages.size(); ++k) {
      const bool everything = (stages[k].region.lower.array() == -kInfinity).all() &&
                              (stages[k].region.upper.array() == kInfinity).all();
      if (!everything) {
        EXPECT_GT(stages[k + 1].leaving, stages[k].leaving) << one.name << k;
      }
    }
  }
}

TEST(AffineSurrogate, car_at_rest_is_its_surrogate) {
  const Case one = make_case("car at rest", models::make_dynamics("dubins", {{"speed", 0.0}}, 0.1),
                             dubins_belief(), 0.01 * Eigen::Matrix3d::Identity(),
                             Eigen::VectorXd::Constant(1, 0.3), {.closed_loop = true});
  const std::vector<SurrogateStage> stages = affine_surrogates(one.motion());
  EXPECT_LT(stages.back().leaving, 1e-5);
  EXPECT_LT(stages.back().error.maxCoeff(), 1e-3);
}

void expect_lost(const SurrogateStage& stage) {
  EXPECT_TRUE((stage.error.array() == kInfinity).all());
  EXPECT_EQ(stage.leaving, 1.0);
  EXPECT_TRUE((stage.region.lower.array() == -kInfinity).all());
  EXPECT_TRUE((stage.region.upper.array() == kInfinity).all());
  EXPECT_EQ(stage.transition.size(), 0);
}

TEST(AffineSurrogate, pole_in_reach_loses_everything) {
  // The bicycle's first pole is at −15.2 m/s: five and a half deviations of 5 m/s reach it.
  const Case one = bicycle({}, 10.0, 25.0);
  const std::vector<SurrogateStage> stages = affine_surrogates(one.motion());
  for (std::size_t k = 1; k < stages.size(); ++k) expect_lost(stages[k]);
}

TEST(AffineSurrogate, error_that_explodes_ends_as_lost_and_is_never_nan) {
  Generator generator(1);
  const Case one = bicycle({true, random_matrix(generator, 2, 6, 3.0)});
  bool lost = false;
  for (const SurrogateStage& stage : affine_surrogates(one.motion())) {
    EXPECT_FALSE(stage.error.array().isNaN().any());
    EXPECT_FALSE(std::isnan(stage.leaving));
    lost = lost || stage.leaving == 1.0;
    if (lost) expect_lost(stage);
  }
  EXPECT_TRUE(lost);
}

TEST(AffineSurrogate, system_without_derivative_bounds_loses_everything) {
  const Case one = make_case("fragile car", std::make_shared<FragileCar>(), dubins_belief(),
                             0.01 * Eigen::Matrix3d::Identity(), Eigen::VectorXd::Zero(1), {});
  const std::vector<SurrogateStage> stages = affine_surrogates(one.motion());
  for (std::size_t k = 1; k < stages.size(); ++k) expect_lost(stages[k]);
}

TEST(AffineSurrogate, plan_that_is_not_finite_loses_everything) {
  for (Case one : {dubins({}), double_integrator({}), bicycle({}), cart_pole({})}) {
    one.plan.policy.states.rightCols(6).setConstant(std::nan(""));
    const std::vector<SurrogateStage> stages = affine_surrogates(one.motion());
    for (std::size_t k = 0; k < 4; ++k) EXPECT_LT(stages[k].leaving, 1e-5) << one.name;
    for (std::size_t k = 4; k < stages.size(); ++k) expect_lost(stages[k]);
  }
}

/// x⁺ = x + T u³: affine in the state, and not in the input.
struct CubicInput {
  static constexpr int kStateDim = 1;
  static constexpr int kInputDim = 1;
  template <class Scalar>
  void step(const Scalar* x, const Scalar* u, Scalar* next) const {
    next[0] = x[0] + 0.1 * (u[0] * u[0] * u[0]);
  }
  [[nodiscard]] models::SystemDescription description() const {
    models::SystemDescription description;
    description.name = "cubic input";
    description.states = {{"x", "m"}};
    description.inputs = {{"u", "m^(1/3)"}};
    description.input_lower = Eigen::VectorXd::Constant(1, -10.0);
    description.input_upper = Eigen::VectorXd::Constant(1, 10.0);
    return description;
  }
  [[nodiscard]] double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>&) const {
    return kInfinity;
  }
};

TEST(AffineSurrogate, curvature_in_an_input_needs_the_core) {
  // The second derivative is bounded only on the core's inputs.
  const Case one = make_case("cubic input",
                             std::make_shared<models::TemplatedDynamics<CubicInput>>(CubicInput{}),
                             around(Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1)),
                             0.01 * Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Constant(1, 0.2),
                             {.closed_loop = true, .gain = -Eigen::MatrixXd::Ones(1, 1)});
  const std::vector<SurrogateStage> stages = affine_surrogates(one.motion());
  EXPECT_GT(stages[1].error[0], 0.0);
  EXPECT_GT(stages[1].leaving, 0.0);
}

}  // namespace affine_surrogate_test
}  // namespace qsmpc::controller
