// Requirements on every method of the table, so that new ones are tested once listed.
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/measure/wasserstein.hpp"
#include "controller/prediction/prediction.hpp"
#include "models/linear_algebra.hpp"
#include "tests/unit/controller/laws/law_cases.hpp"
#include "tests/unit/models/dynamics_fixture.hpp"

namespace qsmpc::controller {
namespace law_methods_test {

using namespace testing;

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const LawMethod& method : law_methods()) names.push_back(method.name);
  return names;
}

bool is_quantised(const std::string& name) {
  for (const PropagatorEntry& entry : propagators()) {
    if (entry.name == name) return true;
  }
  return false;
}

/// Few points.
LawSettings quick_settings() {
  return {.samples = 200, .state_points = 40, .noise_points = 16, .compressed_points = 30};
}

class EveryMethod : public ::testing::TestWithParam<std::string> {};

/// Any system, with LQR gains about inputs in the middle of its bounds.
LawCase system_case(const std::string& name, Eigen::Index horizon) {
  LawCase made{
      .dynamics = make_any_dynamics(name, kTimeStep), .belief = {}, .noise = {}, .policy = {}};
  const models::SystemDescription& system = made.dynamics->description();
  const Eigen::Index dim = made.dynamics->state_dim();
  const Eigen::Index inputs = made.dynamics->input_dim();
  made.belief = {.mean = Eigen::VectorXd::Zero(dim),
                 .covariance = 0.02 * Eigen::MatrixXd::Identity(dim, dim)};
  const int speed = system.state_index("longitudinal_speed");
  if (speed >= 0) made.belief.mean[speed] = 8.0;
  made.noise = 0.002 * Eigen::MatrixXd::Identity(dim, dim);
  made.noise(dim - 1, dim - 1) = 0.0;  // not every state has noise
  made.policy.inputs = (0.5 * (system.input_lower + system.input_upper)).replicate(1, horizon);
  made.policy.bounds = {.lower = system.input_lower, .upper = system.input_upper};
  made.policy.states = nominal_states(*made.dynamics, made.belief.mean, made.policy.inputs);
  made.policy.gains = lqr_gains(*made.dynamics, made.policy.states, made.policy.inputs,
                                {.state = Eigen::MatrixXd::Identity(dim, dim),
                                 .input = Eigen::MatrixXd::Identity(inputs, inputs),
                                 .terminal = Eigen::MatrixXd::Identity(dim, dim)});
  return made;
}

TEST_P(EveryMethod, gives_finite_laws_of_semidefinite_covariance_on_every_system) {
  for (const std::string& name : system_names()) {
    SCOPED_TRACE(name);
    const LawCase made = system_case(name, 5);
    const std::vector<StageLaw> laws = made.laws(GetParam(), quick_settings());
    ASSERT_EQ(laws.size(), 6U);
    for (const StageLaw& law : laws) {
      ASSERT_TRUE(is_finite(law));
      EXPECT_EQ(law_dim(law), made.dynamics->state_dim());
      const Eigen::MatrixXd covariance = covariance_of(law);
      EXPECT_LE((covariance - covariance.transpose()).norm(), 1e-14 * covariance.norm());
      // Rounding of sums of a few hundred terms.
      EXPECT_GE(models::symmetric_eigenvalues(covariance)[0], -1e-13 * covariance.trace());
    }
  }
}

TEST_P(EveryMethod, agrees_with_the_exact_law_of_a_linear_system) {
  constexpr int kSamples = 20'000;
  const LawCase made = linear_case();
  const std::vector<Gaussian> exact = linear_moments(made);
  LawSettings settings = GetParam() == "soft" ? quick_settings() : LawSettings{};
  settings.samples = kSamples;
  const std::vector<StageLaw> laws = made.laws(GetParam(), settings);
  for (std::size_t k = 0; k < laws.size(); ++k) {
    const double trace = exact[k].covariance.trace();
    const double mean = (mean_of(laws[k]) - exact[k].mean).norm();
    const double covariance =
        (covariance_of(laws[k]) - exact[k].covariance).norm() / exact[k].covariance.norm();
    if (GetParam() == "monte_carlo") {
      // Four standard errors.
      EXPECT_LE(mean, 4.0 * std::sqrt(trace / kSamples));
      EXPECT_LE(covariance, 4.0 * std::sqrt(2.0 / kSamples));
    } else if (is_quantised(GetParam())) {
      // Points are conditional means: their covariance lacks the part within their cells; soft
      // shares also contract them, and "noise_free" lacks all of the noise.
      const bool loses = GetParam() == "noise_free" || GetParam() == "soft";
      EXPECT_LE(mean, 1e-12);
      EXPECT_LE(covariance, loses ? 1.0 : 0.15) << k;
    } else {
      EXPECT_LE(mean, 1e-12) << k;
      EXPECT_LE(covariance, 1e-12) << k;
    }
  }
}

TEST_P(EveryMethod, gives_the_same_laws_again) {
  const LawCase made = system_case("dubins", 4);
  const auto propagator = make_law_propagator(GetParam(), quick_settings());
  const std::vector<StageLaw> first = propagator->propagate(made.problem());
  const LawCase other = linear_case();
  (void)propagator->propagate(other.problem());  // of another dimension
  const std::vector<StageLaw> again = propagator->propagate(made.problem());
  for (std::size_t k = 0; k < first.size(); ++k) {
    EXPECT_EQ(mean_of(first[k]), mean_of(again[k]));
    EXPECT_EQ(covariance_of(first[k]), covariance_of(again[k]));
  }
}

TEST_P(EveryMethod, takes_a_known_state_and_no_noise) {
  LawCase made = system_case("dubins", 3);
  made.belief.covariance.setZero();
  made.noise.setZero();
  const std::vector<StageLaw> laws = made.laws(GetParam(), {.samples = 5});
  for (std::size_t k = 0; k < laws.size(); ++k) {
    EXPECT_LE((mean_of(laws[k]) - made.policy.states.col(static_cast<Eigen::Index>(k))).norm(),
              1e-12);
    EXPECT_LE(covariance_of(laws[k]).norm(), 1e-12);
  }
}

// a⁺ = √a is NaN where a point of the law is negative.
TEST_P(EveryMethod, has_lost_a_law_that_is_not_finite) {
  const LawCase made = map_case({"sqrt(a)"},
                                {.mean = Eigen::VectorXd::Constant(1, -0.5),
                                 .covariance = Eigen::MatrixXd::Constant(1, 1, 0.1)},
                                Eigen::MatrixXd::Constant(1, 1, 0.01), 3);
  const std::vector<StageLaw> laws = made.laws(GetParam());
  EXPECT_TRUE(is_finite(laws[0]));
  for (std::size_t k = 1; k < laws.size(); ++k) EXPECT_FALSE(is_finite(laws[k])) << k;
}

TEST_P(EveryMethod, refuses_problems_of_other_dimensions) {
  const auto propagator = make_law_propagator(GetParam(), {});
  LawCase made = linear_case();
  made.belief = {.mean = Eigen::Vector3d::Zero(), .covariance = Eigen::Matrix3d::Identity()};
  EXPECT_THROW((void)propagator->propagate(made.problem()), std::invalid_argument);
  made = linear_case();
  made.noise(0, 0) = -1.0;
  EXPECT_THROW((void)propagator->propagate(made.problem()), std::invalid_argument);
  made = linear_case();
  made.policy.gains.pop_back();
  EXPECT_THROW((void)propagator->propagate(made.problem()), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(all, EveryMethod, ::testing::ValuesIn(method_names()),
                         [](const auto& tested) { return tested.param; });

TEST(QuantisedLaws, are_the_predictions_of_the_planner) {
  const LawCase made = system_case("dubins", 4);
  for (const PropagatorEntry& entry : propagators()) {
    const std::vector<StageLaw> laws =
        made.laws(entry.name, {.state_points = 40, .noise_points = 20, .compressed_points = 30});
    const auto propagator = make_propagator(
        entry.name, {.noise = {.mean = Eigen::Vector3d::Zero(), .covariance = made.noise},
                     .noise_points = 20,
                     .compressed_points = 30});
    const Prediction prediction =
        predict(*made.dynamics, *propagator, quantise(made.belief, 40).measure, made.policy);
    for (std::size_t k = 0; k < laws.size(); ++k) {
      const auto& points = std::get<DiscreteMeasure>(laws[k]);
      ASSERT_EQ(points.size(), prediction.stages[k].size()) << entry.name;
      // The same operations, except that many points are processed in blocks.
      EXPECT_LE((points.locations - prediction.stages[k].locations).norm(), 1e-12) << entry.name;
      EXPECT_LE((points.weights - prediction.stages[k].weights).norm(), 1e-12) << entry.name;
    }
  }
}

TEST(MakeLawPropagator, refuses_unknown_names_and_invalid_settings) {
  EXPECT_THAT([] { (void)make_law_propagator("telepathy", {}); },
              ::testing::ThrowsMessage<std::invalid_argument>(::testing::AllOf(
                  ::testing::HasSubstr("telepathy"), ::testing::HasSubstr("polynomial_chaos"))));
  const std::vector<LawSettings> senseless = {
      {.samples = 0},
      {.unscented = {.alpha = 0.0}},
      {.unscented = {.kappa = std::numeric_limits<double>::infinity()}},
      {.order = 0},
      {.order = 9},
      {.most_nodes = 0},
      {.components = 0},
      {.split = 4},
      {.least_bend = -1.0},
      {.state_points = 0},
      {.noise_points = 0},
      {.compressed_points = 0},
  };
  for (const LawSettings& settings : senseless) {
    EXPECT_THROW((void)make_law_propagator("linearised", settings), std::invalid_argument);
  }
}

}  // namespace law_methods_test
}  // namespace qsmpc::controller
