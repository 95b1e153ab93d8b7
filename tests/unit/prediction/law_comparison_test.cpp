// Prediction methods compared with simulated paths.
#include <cmath>
#include <limits>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/prediction/law_table.hpp"
#include "harness/prediction/prediction_json.hpp"
#include "tests/unit/prediction/prediction_fixture.hpp"

namespace qsmpc::harness {
namespace law_comparison_test {

using ::testing::HasSubstr;
using ::testing::SizeIs;
using testing::small_scenario;

PredictionReport compared(const std::vector<std::string>& methods, std::int64_t samples,
                          const std::vector<std::string>& overrides = {}, int threads = 0) {
  return predict_scenario(small_scenario(overrides),
                          {.inputs = Eigen::MatrixXd::Constant(1, 4, 0.3),
                           .monte_carlo = {.samples = samples, .threads = threads},
                           .methods = methods});
}

/// Linear in the states: no spread of the heading and no noise on it.
const std::vector<std::string>& straight() {
  static const std::vector<std::string> overrides = {
      "controller.policy=open_loop", "initial_state.covariance=[0.01, 0.01, 0]",
      "disturbance.covariance=[0.01, 0.01, 0]", "safe_set={bounds: {x: [-100, 0.7]}}",
      "target.state=[0, 0, 0]"};
  return overrides;
}

TEST(CompareLaws, right_laws_have_errors_of_the_size_of_the_sampling) {
  constexpr std::int64_t kSamples = 50'000;
  const PredictionReport report =
      compared({"unscented", "linearised", "polynomial_chaos"}, kSamples, straight());
  ASSERT_TRUE(report.laws);
  ASSERT_THAT(report.laws->methods, SizeIs(3));
  ASSERT_THAT(report.laws->floors, SizeIs(4));
  for (const MethodErrors& method : report.laws->methods) {
    ASSERT_THAT(method.stages, SizeIs(4));
    EXPECT_GT(method.milliseconds, 0.0);
    for (std::size_t k = 0; k < 4; ++k) {
      const LawErrors& errors = method.stages[k];
      const LawFloor& floor = report.laws->floors[k];
      // Four root mean squares; W2 between samples of 1000 varies by less than half.
      EXPECT_LE(errors.mean, 4.0 * floor.mean) << method.name;
      EXPECT_LE(errors.covariance, 4.0 * floor.covariance) << method.name;
      EXPECT_LE(errors.w2, 1.5 * floor.w2) << method.name;
      EXPECT_GE(errors.w2, 0.5 * floor.w2) << method.name;
      const SimulatedRate truth = simulated_rate(report.monte_carlo->stages[k], kSamples);
      EXPECT_GE(errors.unsafe, truth.limits.lower) << method.name;
      EXPECT_LE(errors.unsafe, truth.limits.upper) << method.name;
    }
  }
}

TEST(CompareLaws, wrong_laws_have_errors_that_are_not_of_the_sampling) {
  const PredictionReport report = compared({"noise_free"}, 20'000, straight());
  const LawErrors& errors = report.laws->methods.front().stages.back();
  // Four fifths of the variance are noise, less what the grid of points lacks of the other fifth.
  EXPECT_GT(errors.covariance, 0.78);
  EXPECT_LT(errors.covariance, 0.86);
  EXPECT_GT(errors.w2, 3.0 * report.laws->floors.back().w2);
}

TEST(CompareLaws, numbers_do_not_depend_on_the_number_of_threads) {
  const PredictionReport one = compared({"gaussian_mixture", "monte_carlo"}, 5000, {}, 1);
  const PredictionReport four = compared({"gaussian_mixture", "monte_carlo"}, 5000, {}, 4);
  EXPECT_EQ(one.monte_carlo->stages, four.monte_carlo->stages);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(one.laws->truth.moments[k].mean, four.laws->truth.moments[k].mean);
    EXPECT_EQ(one.laws->truth.moments[k].covariance, four.laws->truth.moments[k].covariance);
    EXPECT_EQ(one.laws->floors[k].w2, four.laws->floors[k].w2);
    for (std::size_t n = 0; n < 2; ++n) {
      const LawErrors& first = one.laws->methods[n].stages[k];
      const LawErrors& second = four.laws->methods[n].stages[k];
      EXPECT_EQ(first.w2, second.w2);
      EXPECT_EQ(first.mean, second.mean);
      EXPECT_EQ(first.covariance, second.covariance);
      EXPECT_EQ(first.unsafe, second.unsafe);
    }
  }
}

TEST(CompareLaws, the_paths_equal_those_of_a_simulation_alone) {
  const PredictionReport report = compared({"linearised"}, 5000);
  const PredictionReport plain = predict_scenario(
      small_scenario(),
      {.inputs = Eigen::MatrixXd::Constant(1, 4, 0.3), .monte_carlo = {.samples = 5000}});
  EXPECT_EQ(report.monte_carlo->stages, plain.monte_carlo->stages);
  EXPECT_EQ(report.monte_carlo->any_stage, plain.monte_carlo->any_stage);
  EXPECT_FALSE(plain.laws);
}

TEST(CompareLaws, refuses_unknown_methods_and_too_few_paths) {
  EXPECT_THROW(compared({"telepathy"}, 5000), std::invalid_argument);
  EXPECT_THROW(compared({"linearised"}, kKeptPaths - 1), std::invalid_argument);
  EXPECT_THROW(compared({"linearised"}, 0), std::invalid_argument);
}

TEST(CompareLaws, interrupted_work_leaves_the_prediction_without_it) {
  const PredictionReport report = predict_scenario(
      small_scenario(), {.monte_carlo = {.samples = 5000, .should_stop = [] { return true; }},
                         .methods = {"linearised"}});
  EXPECT_TRUE(report.interrupted);
  EXPECT_FALSE(report.laws);
  EXPECT_EQ(report.certificates.size(), 4U);
}

TEST(PathCollector, has_the_moments_of_the_paths_whatever_the_order_of_their_batches) {
  const controller::Policy policy{.inputs = Eigen::MatrixXd::Zero(1, 2),
                                  .states = Eigen::MatrixXd::Constant(2, 3, 5.0),
                                  .gains = {},
                                  .bounds = {}};
  const Eigen::MatrixXd numbers = Eigen::MatrixXd::Random(2, 60).array() + 5.0;
  PathCollector collector(policy, 40);
  for (const std::int64_t batch : {2, 0, 1}) {
    std::vector<PathCollector::StageSums> sums;
    for (const Eigen::Index stage : {1, 2}) {
      const controller::Points states =
          static_cast<double>(stage) * numbers.middleCols(20 * batch, 20);
      sums.push_back(collector.collect(stage, 20 * batch, states));
    }
    collector.add(batch, std::move(sums));
  }
  const PathLaws laws = collector.laws(60);
  const Eigen::VectorXd mean = numbers.rowwise().mean();
  const Eigen::MatrixXd centred = numbers.colwise() - mean;
  // Sums of sixty numbers of order ten.
  EXPECT_LE((laws.moments[0].mean - mean).norm(), 1e-13);
  EXPECT_LE((laws.moments[1].mean - 2.0 * mean).norm(), 1e-13);
  EXPECT_LE((laws.moments[0].covariance - centred * centred.transpose() / 60.0).norm(), 1e-12);
  EXPECT_EQ(laws.paths[1], controller::Points(2.0 * numbers.leftCols(40)));
}

const PredictionReport& with_methods() {
  static const PredictionReport report = compared({"unscented", "mixture"}, 5000);
  return report;
}

std::vector<std::string> keys_of(const nlohmann::ordered_json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

TEST(LawOutput, json_has_the_documented_keys_and_the_numbers) {
  using ::testing::ElementsAre;
  const auto json = nlohmann::ordered_json::parse(prediction_json(with_methods()));
  EXPECT_THAT(keys_of(json), ElementsAre("inputs", "cost", "stages", "horizon", "truth", "methods",
                                         "certificate", "particles"));
  EXPECT_THAT(keys_of(json["truth"]), ElementsAre("samples", "w2_paths", "stages"));
  EXPECT_THAT(keys_of(json["truth"]["stages"][0]),
              ElementsAre("stage", "mean", "covariance", "floor"));
  EXPECT_THAT(keys_of(json["truth"]["stages"][0]["floor"]),
              ElementsAre("w2", "mean", "covariance"));
  EXPECT_THAT(keys_of(json["methods"]), ElementsAre("unscented", "mixture"));
  EXPECT_THAT(keys_of(json["methods"]["mixture"]), ElementsAre("ms", "stages"));
  const auto& stage = json["methods"]["mixture"]["stages"][3];
  EXPECT_THAT(keys_of(stage), ElementsAre("stage", "w2", "mean", "covariance", "unsafe"));
  EXPECT_EQ(stage["stage"], 4);
  EXPECT_EQ(stage["w2"], with_methods().laws->methods[1].stages[3].w2);
  EXPECT_EQ(stage["unsafe"], with_methods().laws->methods[1].stages[3].unsafe);
  EXPECT_EQ(json["truth"]["samples"], 5000);
}

TEST(LawOutput, table_has_a_row_a_method_and_fits_80_columns) {
  PredictionReport report = with_methods();
  const std::string last = law_table(report, {});
  EXPECT_THAT(last, HasSubstr("Stage 4"));
  EXPECT_THAT(last, HasSubstr("  unscented "));
  EXPECT_THAT(last, HasSubstr("  mixture "));
  const std::string both = law_table(report, {1, 3});
  EXPECT_THAT(both, HasSubstr("Stage 1"));
  EXPECT_THAT(both, HasSubstr("Stage 3"));
  EXPECT_THAT(both, ::testing::Not(HasSubstr("Stage 4")));
  report.laws->truth.samples = 1'000'000'000;
  report.laws->methods[0].stages[3] = {.w2 = std::numeric_limits<double>::quiet_NaN(),
                                       .mean = 1.23456e-120,
                                       .covariance = 12345678.9,
                                       .unsafe = 1.0};
  report.laws->methods[0].milliseconds = 123456.7;
  std::istringstream lines(law_table(report, {}));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;
  report.laws.reset();
  EXPECT_EQ(law_table(report, {}), "");
}

}  // namespace law_comparison_test
}  // namespace qsmpc::harness
