// The certificates of the shipped scenarios' first plans, compared with simulated paths.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/prediction/prediction_report.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/shipped_files.hpp"
#include "tests/support/effort.hpp"

namespace qsmpc::harness {
namespace shipped_predictions_test {

using ::testing::IsEmpty;

const int kPaths = testing::by_effort(4000, 20000, 100000);
// Where the truth is certainly below this, the certificate must be below 1.
constexpr double kSmall = 0.01;

// Where the truth of all stages together is certainly above this, its bound must be near.
constexpr double kNotRare = 0.001;

/// How many times the truth the bound of all stages together may be.
double most_ratio(const std::string& name) {
  // Feedback that is clamped at every one of 20 stages leaves more than C5 can sum over.
  if (name == "bicycle_square") return 25.0;
  if (name == "dubins_trap") return 30.0;
  return 5.0;
}

/// The scenarios without moving obstacles; those with them are not predicted.
std::vector<std::string> predictable() {
  std::vector<std::string> names;
  for (const std::string& name : shipped_scenario_names()) {
    const Scenario scenario = load_scenario(name);
    bool moves = false;
    for (const controller::Obstacle& obstacle : scenario.safe_set.obstacles) {
      moves = moves || obstacle.motion.has_value();
    }
    if (!moves) names.push_back(name);
  }
  return names;
}

class ShippedPredictions : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedPredictions, are_certified_above_the_truth_and_near_it) {
  PredictionOptions options;
  options.monte_carlo.samples = kPaths;
  const PredictionReport report = predict_scenario(load_scenario(GetParam()), options);
  EXPECT_THAT(contradicted_stages(report), IsEmpty());
  ASSERT_TRUE(report.monte_carlo.has_value());
  for (std::size_t k = 0; k < report.certificates.size(); ++k) {
    const SimulatedRate rate = simulated_rate(report.monte_carlo->stages[k], kPaths);
    if (rate.limits.upper >= kSmall) continue;
    EXPECT_LT(report.certificates[k].value, 1.0) << "stage " << k + 1 << ", rate " << rate.rate;
  }
  const SimulatedRate together = simulated_rate(report.monte_carlo->any_stage, kPaths);
  if (together.limits.lower > kNotRare) {
    EXPECT_LE(report.horizon_bound, most_ratio(GetParam()) * together.limits.upper)
        << "rate " << together.rate;
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedPredictions, ::testing::ValuesIn(predictable()),
                         [](const auto& tested) { return tested.param; });

}  // namespace shipped_predictions_test
}  // namespace qsmpc::harness
