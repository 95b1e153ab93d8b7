// A prediction with 100 points is closer to the law that it stands for than 100 Monte Carlo
// samples, at every step.
#include "tests/support/prediction_quality.hpp"

#include <gtest/gtest.h>

namespace qsmpc::controller {
namespace prediction_quality_test {

using namespace testing;

// The worst of seven disjoint triples of seeds has 0.623.
constexpr double kSquaredRatio = 0.68;

class PredictionQuality : public ::testing::TestWithParam<Eigen::Vector3d> {};

TEST_P(PredictionQuality, exceeds_that_of_as_many_samples_at_every_step) {
  const QualityProblem problem{.noise_covariance = GetParam().asDiagonal()};
  const std::vector<SquaredDistances> distances = squared_distances(
      problem,
      {quality_prediction(problem, "moment_matched"), quality_prediction(problem, "compressed")},
      {.seeds = 3});
  ASSERT_EQ(distances.size(), 10U);
  for (std::size_t step = 0; step < distances.size(); ++step) {
    const double samples = distances[step].monte_carlo.mean();
    const double matched = distances[step].predictions[0].mean();
    const double compressed = distances[step].predictions[1].mean();
    EXPECT_LT(matched, kSquaredRatio * samples) << "step " << step;
    EXPECT_LT(compressed, samples) << "step " << step;
    if (step > 0) {
      EXPECT_LT(matched, compressed) << "step " << step;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(noises, PredictionQuality,
                         ::testing::Values(Eigen::Vector3d(0.01, 0.01, 0.001),
                                           Eigen::Vector3d(0.02, 0.02, 0.02)));

}  // namespace prediction_quality_test
}  // namespace qsmpc::controller
