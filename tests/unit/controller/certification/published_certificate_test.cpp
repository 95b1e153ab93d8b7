#include "controller/certification/published_certificate.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/controller/certification/surrogate_cases.hpp"

namespace qsmpc::controller {
namespace published_certificate_test {

using namespace testing;

/// The first radius and every compression, each with the product of the Lipschitz constants of all
/// later stages.
std::vector<double> unrolled(const PredictedMotion& motion, const std::vector<double>& lipschitz) {
  const auto& maps = motion.prediction.maps;
  std::vector<double> radii;
  for (std::size_t k = 0; k <= maps.size(); ++k) {
    double radius = motion.belief_w2;
    for (std::size_t j = 0; j < k; ++j) radius *= lipschitz[j];
    for (std::size_t from = 0; from < k; ++from) {
      double part = maps[from].compression_w2;
      for (std::size_t j = from + 1; j < k; ++j) part *= lipschitz[j];
      radius += part;
    }
    radii.push_back(radius);
  }
  return radii;
}

void expect_radii(const Case& one, const std::vector<StageBudget>& budgets,
                  const std::vector<double>& lipschitz) {
  const PredictedMotion motion = one.motion();
  ASSERT_GT(motion.belief_w2, 0.0);
  ASSERT_GT(motion.prediction.maps.back().compression_w2, 0.0);
  const std::vector<double> radii = thesis_radii(motion, budgets);
  const std::vector<double> expected = unrolled(motion, lipschitz);
  ASSERT_EQ(radii.size(), expected.size());
  for (std::size_t k = 0; k < radii.size(); ++k) {
    EXPECT_NEAR(radii[k], expected[k], 1e-12 * expected[k]) << one.name << ", stage " << k;
  }
}

TEST(ThesisRadii, grow_by_the_global_constant_where_there_is_one) {
  const Case car = dubins({});
  const std::size_t stages = car.motion().prediction.maps.size();
  const double global = car.dynamics->lipschitz(Eigen::MatrixXd::Zero(1, 3));
  ASSERT_GT(global, 1.0);
  ASSERT_TRUE(std::isfinite(global));
  expect_radii(car, std::vector<StageBudget>(stages), std::vector<double>(stages, global));
}

TEST(ThesisRadii, grow_by_the_constant_of_each_stages_region_elsewhere) {
  const Case car = bicycle({});
  ASSERT_FALSE(std::isfinite(car.dynamics->lipschitz(Eigen::MatrixXd::Zero(2, 6))));
  const std::size_t stages = car.motion().prediction.maps.size();
  std::vector<StageBudget> budgets(stages);
  std::vector<double> lipschitz;
  for (std::size_t k = 0; k < stages; ++k) {
    lipschitz.push_back(1.1 + 0.1 * static_cast<double>(k));
    budgets[k].lipschitz = lipschitz.back();
  }
  expect_radii(car, budgets, lipschitz);
}

}  // namespace published_certificate_test
}  // namespace qsmpc::controller
