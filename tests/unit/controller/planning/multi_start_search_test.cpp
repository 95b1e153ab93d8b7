#include "controller/planning/start/multi_start_search.hpp"

#include <chrono>

#include <gtest/gtest.h>

#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace multi_start_search_test {

using namespace testing;

using Clock = std::chrono::steady_clock;

class Valleys : public ::testing::Test {
 protected:
  Valleys()
      : car_(dubins_car()),
        settings_(block_settings()),
        policies_(*car_, settings_),
        cost_(settings_.horizon, {.dynamics = *car_,
                                  .safe_set = settings_.safe_set,
                                  .cost = settings_.cost,
                                  .penalty = settings_.penalty,
                                  .noise_covariance = zero_,
                                  .within_covariance = zero_}),
        search_(settings_, cost_) {}

  const std::vector<const Eigen::MatrixXd*>& searched(const Gaussian& belief,
                                                      Clock::time_point deadline) {
    cost_.place(belief);
    return search_.search(policies_, deadline);
  }

  [[nodiscard]] double height_at_block(const Eigen::MatrixXd& inputs) const {
    const Eigen::MatrixXd path = nominal_states(*car_, Eigen::Vector3d::Zero(), inputs);
    return path(1, 6);  // 0.9 m along the path
  }

  std::unique_ptr<const models::Dynamics> car_;
  PlannerSettings settings_;
  Eigen::MatrixXd zero_ = Eigen::MatrixXd::Zero(3, 3);
  PolicyMaker policies_;
  NoiseFreeCost cost_;
  MultiStartSearch search_;
};

TEST_F(Valleys, both_ways_round_a_block_are_found) {
  const Gaussian belief{.mean = Eigen::Vector3d::Zero(),
                        .covariance = 1e-3 * Eigen::Matrix3d::Identity()};
  const auto& valleys = searched(belief, Clock::time_point::max());
  ASSERT_GE(valleys.size(), 2U);
  EXPECT_LT(height_at_block(*valleys[0]), -0.2);  // the shorter path first
  double highest = -1.0;
  for (const Eigen::MatrixXd* const inputs : valleys) {
    EXPECT_TRUE((inputs->array() >= settings_.bounds.lower[0]).all());
    EXPECT_TRUE((inputs->array() <= settings_.bounds.upper[0]).all());
    highest = std::max(highest, height_at_block(*inputs));
  }
  EXPECT_GT(highest, 0.2);
}

TEST_F(Valleys, the_same_search_gives_the_same) {
  const Gaussian belief = dubins_belief();
  const Eigen::MatrixXd first = *searched(belief, Clock::time_point::max())[0];
  Gaussian other = belief;
  other.mean[1] = 0.2;
  (void)searched(other, Clock::time_point::max());
  EXPECT_EQ(*searched(belief, Clock::time_point::max())[0], first);
}

TEST_F(Valleys, without_time_or_numbers_there_is_a_start_all_the_same) {
  Gaussian belief = dubins_belief();
  const auto& hurried = searched(belief, Clock::now());
  ASSERT_EQ(hurried.size(), 1U);
  EXPECT_EQ(hurried[0]->cols(), settings_.horizon);
  belief.mean[0] = 1e300;
  const auto& lost = searched(belief, Clock::time_point::max());
  ASSERT_EQ(lost.size(), 1U);
  EXPECT_TRUE(lost[0]->allFinite());
}

TEST(PlannerValleys, a_cold_start_takes_the_deeper_of_two) {
  const auto car = dubins_car();
  PlannerSettings settings = block_settings();
  settings.noise_covariance *= 0.01;
  const Gaussian belief{.mean = Eigen::Vector3d::Zero(),
                        .covariance = 1e-3 * Eigen::Matrix3d::Identity()};
  Planner planner(*car, settings);
  const double below = planner.plan(belief).cost.total();
  EXPECT_LT(planner.plan(belief).policy.states(1, 6), -0.2);
  // The mirror image is an equally good minimum on the other side.
  Box& block = std::get<Box>(settings.safe_set.obstacles[0].form);
  std::swap(block.lower[1], block.upper[1]);
  block.lower[1] *= -1.0;
  block.upper[1] *= -1.0;
  Planner mirrored(*car, settings);
  const Plan& plan = mirrored.plan(belief);
  EXPECT_GT(plan.policy.states(1, 6), 0.2);
  EXPECT_NEAR(plan.cost.total(), below, 0.01 * below);
}

}  // namespace multi_start_search_test
}  // namespace qsmpc::controller
