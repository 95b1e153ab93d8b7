#include "harness/prediction/prediction_report.hpp"

#include <cmath>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/measure/normal/normal_distribution.hpp"
#include "tests/unit/prediction/prediction_fixture.hpp"

namespace qsmpc::harness {
namespace prediction_report_test {

using testing::small_scenario;

UnsafeCounts counts_of(const Scenario& scenario, const MonteCarloOptions& options) {
  return predict_scenario(scenario,
                          {.inputs = Eigen::MatrixXd::Constant(1, 4, 0.3), .monte_carlo = options})
      .monte_carlo.value();
}

TEST(PredictScenario, planned_inputs_fill_the_horizon_and_every_stage_has_a_certificate) {
  const PredictionReport report = predict_scenario(testing::small_scenario(), {});
  EXPECT_EQ(report.policy.inputs.cols(), 4);
  EXPECT_FALSE(report.inputs_given);
  EXPECT_FALSE(report.solver_status.empty());
  EXPECT_EQ(report.prediction.stages.size(), 5U);
  EXPECT_EQ(report.budgets.size(), 5U);
  ASSERT_EQ(report.certificates.size(), 4U);
  EXPECT_DOUBLE_EQ(report.horizon_bound, controller::horizon_bound(report.certificates));
  EXPECT_FALSE(report.monte_carlo);
  EXPECT_FALSE(report.interrupted);
}

TEST(PredictScenario, a_model_error_is_in_the_certificates_and_not_in_the_plan) {
  const PredictionReport of_model = predict_scenario(testing::small_scenario(), {});
  const PredictionReport of_plant = predict_scenario(
      testing::small_scenario({"model_error={rms: [0.03, 0.04, 0.01], norm8: [0.05, 0.05, 0.02]}"}),
      {});
  EXPECT_EQ(of_plant.policy.inputs, of_model.policy.inputs);
  EXPECT_EQ(of_plant.budgets[0].model, 0.0);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(of_model.budgets[k + 1].model, 0.0);
    EXPECT_GT(of_plant.budgets[k + 1].model, of_plant.budgets[k].model);
    EXPECT_GT(of_plant.certificates[k].value, of_model.certificates[k].value);
  }
}

TEST(PredictScenario, given_inputs_are_taken_as_they_are) {
  Eigen::MatrixXd inputs(1, 4);
  inputs << 0.1, -0.2, 2.0, -2.0;
  const PredictionReport report = predict_scenario(testing::small_scenario(), {.inputs = inputs});
  EXPECT_EQ(report.policy.inputs, inputs);
  EXPECT_TRUE(report.inputs_given);
  EXPECT_EQ(report.solver_status, "");
  EXPECT_THROW(
      static_cast<void>(predict_scenario(testing::small_scenario(), {.inputs = 1.01 * inputs})),
      std::invalid_argument);
}

// Without heading noise the position is Gaussian: x_k ~ N(0.15 k, 0.01 (k + 1)).
TEST(MonteCarlo, rates_are_those_of_the_law_where_that_is_known) {
  const Scenario scenario = testing::small_scenario(
      {"controller.policy=open_loop", "initial_state.covariance=[0.01, 0.01, 0]",
       "disturbance.covariance=[0.01, 0.01, 0]", "safe_set={bounds: {x: [-100, 0.5]}}",
       "target.state=[0, 0, 0]"});
  constexpr std::int64_t kSamples = 40'000;
  const UnsafeCounts counts = predict_scenario(scenario, {.inputs = Eigen::MatrixXd::Zero(1, 4),
                                                          .monte_carlo = {.samples = kSamples}})
                                  .monte_carlo.value();
  EXPECT_EQ(counts.samples, kSamples);
  for (int k = 1; k <= 4; ++k) {
    const double p = controller::normal_cumulative(-(0.5 - 0.15 * k) / std::sqrt(0.01 * (k + 1)));
    const double rate = static_cast<double>(counts.stages[static_cast<std::size_t>(k) - 1]) /
                        static_cast<double>(kSamples);
    // Five standard errors.
    EXPECT_NEAR(rate, p, 5.0 * std::sqrt(p * (1.0 - p) / static_cast<double>(kSamples))) << k;
  }
  EXPECT_GE(counts.any_stage, counts.stages.back());
  EXPECT_LT(counts.any_stage, kSamples);
}

TEST(MonteCarlo, counts_do_not_depend_on_the_number_of_threads) {
  const Scenario scenario = testing::small_scenario({"safe_set.bounds={x: [-0.1, 12]}"});
  const UnsafeCounts one = counts_of(scenario, {.samples = 5000, .threads = 1});
  const UnsafeCounts four = counts_of(scenario, {.samples = 5000, .threads = 4});
  EXPECT_GT(one.any_stage, 0);
  EXPECT_EQ(one.stages, four.stages);
  EXPECT_EQ(one.any_stage, four.any_stage);
  EXPECT_EQ(one.samples, four.samples);
}

TEST(MonteCarlo, another_seed_gives_other_paths) {
  const UnsafeCounts one =
      counts_of(testing::small_scenario({"safe_set.bounds={x: [-0.1, 12]}"}), {.samples = 5000});
  const UnsafeCounts other = counts_of(
      testing::small_scenario({"safe_set.bounds={x: [-0.1, 12]}", "seed=8"}), {.samples = 5000});
  EXPECT_NE(one.stages, other.stages);
}

TEST(MonteCarlo, interrupted_work_leaves_the_prediction_without_it) {
  const PredictionReport report = predict_scenario(
      testing::small_scenario(),
      {.monte_carlo = {.samples = 1'000'000'000, .should_stop = [] { return true; }}});
  EXPECT_TRUE(report.interrupted);
  EXPECT_FALSE(report.monte_carlo);
  EXPECT_EQ(report.certificates.size(), 4U);
}

TEST(MonteCarlo, progress_ends_with_all_paths) {
  std::int64_t last = 0;
  counts_of(testing::small_scenario(),
            {.samples = 3000, .threads = 3, .on_progress = [&](auto done, auto) {
               EXPECT_GE(done, last);
               last = done;
             }});
  EXPECT_EQ(last, 3000);
}

TEST(ContradictedStages, certificates_hold_and_one_that_does_not_is_reported) {
  PredictionReport report =
      predict_scenario(testing::small_scenario({"safe_set.bounds={x: [-0.1, 12]}"}),
                       {.monte_carlo = {.samples = 5000}});
  EXPECT_THAT(contradicted_stages(report), ::testing::IsEmpty());
  report.certificates[1].value = 0.0;
  report.certificates[2].value = std::nan("");
  EXPECT_THAT(contradicted_stages(report), ::testing::ElementsAre(2, 3));
}

}  // namespace prediction_report_test
}  // namespace qsmpc::harness
