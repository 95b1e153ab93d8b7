// The bound penalties predicted with a hundred particles, compared with simulated paths.
#include <vector>

#include <gtest/gtest.h>

#include "controller/planning/cost/penalty.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/planning_quality.hpp"
#include "tests/support/point_penalty.hpp"
#include "tests/support/simulated_truth.hpp"

namespace qsmpc::controller {
namespace bounds_penalty_test {

using namespace testing;

/// The bounds' penalties summed over all stages, for equally weighted particles.
double price_of_paths(const std::vector<Points>& states, const PlannerSettings& settings) {
  SafeSet room = settings.safe_set;
  room.obstacles.clear();
  double price = 0.0;
  for (const Points& stage : states) {
    const auto count = static_cast<double>(stage.cols());
    Points unused = Points::Zero(stage.rows(), stage.cols());
    price += testing::add_penalty(stage, Eigen::VectorXd::Constant(stage.cols(), 1.0 / count), room,
                                  settings.penalty, unused)
                 .box;
  }
  return price;
}

/// The same for the particles of a plan, each as a point.
double price_of_particles(const Plan& plan, const PlannerSettings& settings) {
  SafeSet room = settings.safe_set;
  room.obstacles.clear();
  double price = 0.0;
  for (std::size_t k = 1; k < plan.prediction.stages.size(); ++k) {
    const DiscreteMeasure& stage = plan.prediction.stages[k];
    Points unused = Points::Zero(stage.dim(), stage.size());
    price +=
        testing::add_penalty(stage.locations, stage.weights, room, settings.penalty, unused).box;
  }
  return price;
}

class BoundsPenalty : public ::testing::TestWithParam<bool> {};

// Near the target of dubins_obstacles few paths reach two of the walls, at the end of the horizon.
TEST_P(BoundsPenalty, of_a_hundred_particles_is_near_that_of_paths) {
  const std::unique_ptr<const models::Dynamics> car = default_car();
  const Place place = places_among_blocks().back();
  PlannerSettings settings = blocks_settings(18);
  settings.closed_loop = GetParam();
  Planner planner(*car, settings);
  Generator generator(471);
  for (const double turn : {0.0, -0.1, -0.2}) {
    const Eigen::MatrixXd inputs =
        (planner.plan(place.belief).policy.inputs.array() + turn).cwiseMax(-2.0).cwiseMin(2.0);
    const Plan& plan = planner.prescribe(place.belief, inputs);
    std::vector<Points> states;
    (void)simulate(motion_of(planner, place.belief, plan), settings.safe_set,
                   by_effort(40000, 200000, 1000000), generator, &states);
    const double truth = price_of_paths(states, settings);
    ASSERT_GT(truth, 5.0);
    EXPECT_GT(plan.cost.of("box"), 0.6 * truth) << turn;
    EXPECT_LT(plan.cost.of("box"), 1.2 * truth) << turn;
    // As points, without the normal laws that they stand for, the particles are less accurate.
    EXPECT_LT(std::abs(plan.cost.of("box") - truth),
              std::abs(price_of_particles(plan, settings) - truth))
        << turn;
    RecordProperty("share_" + std::to_string(turn), std::to_string(plan.cost.of("box") / truth));
    RecordProperty("particles_" + std::to_string(turn),
                   std::to_string(price_of_particles(plan, settings) / truth));
    planner.reset();
  }
}

INSTANTIATE_TEST_SUITE_P(loops, BoundsPenalty, ::testing::Bool(),
                         [](const auto& chosen) { return chosen.param ? "closed" : "open"; });

}  // namespace bounds_penalty_test
}  // namespace qsmpc::controller
