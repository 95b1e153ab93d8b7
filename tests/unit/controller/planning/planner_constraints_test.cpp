// "slsqp" keeps every particle of every stage within the bounds.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace planner_constraints_test {

using namespace testing;

constexpr double kKept = 1e-6;  // m; tolerance within which the planner counts a bound as kept

/// The largest violation of the bounds by a particle of the stages after the first.
double worst_of(const Plan& plan, const SafeSet& room) {
  double worst = 0.0;
  for (std::size_t k = 1; k < plan.prediction.stages.size(); ++k) {
    const Points& particles = plan.prediction.stages[k].locations;
    worst = std::max({worst, (particles.colwise() - room.bounds.upper).maxCoeff(),
                      (-(particles.colwise() - room.bounds.lower)).maxCoeff()});
  }
  return worst;
}

/// The target is behind a wall parallel to the car's path, `distance` (m) to its left.
PlannerSettings wall_settings(double distance, const std::string& propagator) {
  PlannerSettings settings = dubins_settings();
  settings.solver = "slsqp";
  settings.propagator = propagator;
  settings.max_evaluations = 200;
  settings.cost.target << 5.0, 5.0, 0.0;
  settings.noise_covariance = Eigen::Vector3d(1e-3, 1e-3, 1e-4).asDiagonal();
  settings.safe_set.bounds.upper[1] = distance;
  return settings;
}

Gaussian narrow_belief() {
  return {.mean = Eigen::Vector3d::Zero(), .covariance = 1e-3 * Eigen::Matrix3d::Identity()};
}

TEST(PlannerConstraints, every_particle_is_kept_off_a_wall_near_the_path) {
  const auto car = dubins_car();
  for (const char* propagator : {"noise_free", "mixture"}) {
    // Without noise the particles do not spread as far.
    const bool noisy = propagator == std::string("mixture");
    const std::vector<double> distances = noisy ? std::vector{0.25, 0.35} : std::vector{0.2, 0.25};
    for (const bool closed_loop : {false, true}) {
      for (const double distance : distances) {
        SCOPED_TRACE(std::string(propagator) + (closed_loop ? ", closed, " : ", open, ") +
                     std::to_string(distance));
        PlannerSettings settings = wall_settings(distance, propagator);
        settings.closed_loop = closed_loop;
        // Without the constraint the particles cross the wall.
        settings.solver = "lbfgs";
        settings.penalty.box = 0.0;
        Planner free(*car, settings);
        EXPECT_GT(worst_of(free.plan(narrow_belief()), settings.safe_set), 0.01);
        settings.solver = "slsqp";
        Planner planner(*car, settings);
        Gaussian belief = narrow_belief();
        for (int step = 0; step < 3; ++step) {
          const Plan& plan = planner.plan(belief);
          EXPECT_NE(plan.status, SolverStatus::kInfeasible) << step;
          EXPECT_LE(plan.violation, kKept) << step;
          EXPECT_LE(worst_of(plan, settings.safe_set), kKept) << step;
          belief.mean = plan.policy.states.col(1);
        }
      }
    }
  }
}

TEST(PlannerConstraints, a_room_that_is_too_narrow_is_reported) {
  const auto car = dubins_car();
  for (const char* propagator : {"noise_free", "mixture"}) {
    PlannerSettings settings = wall_settings(0.01, propagator);
    settings.safe_set.bounds.lower[1] = -0.01;
    Planner planner(*car, settings);
    for (int step = 0; step < 2; ++step) {
      const Plan& plan = planner.plan(narrow_belief());
      EXPECT_EQ(plan.status, SolverStatus::kInfeasible) << propagator;
      EXPECT_GT(plan.violation, kKept) << propagator;
      EXPECT_NEAR(plan.violation, worst_of(plan, settings.safe_set), 1e-12) << propagator;
      EXPECT_TRUE(plan.policy.inputs.allFinite()) << propagator;
      EXPECT_TRUE(std::isfinite(plan.cost.total())) << propagator;
    }
  }
}

TEST(PlannerConstraints, other_solvers_report_no_violation) {
  const auto car = dubins_car();
  PlannerSettings settings = wall_settings(0.05, "mixture");
  settings.solver = "lbfgs";
  Planner planner(*car, settings);
  const Plan& plan = planner.plan(narrow_belief());
  EXPECT_EQ(plan.violation, 0.0);
  EXPECT_GT(worst_of(plan, settings.safe_set), 0.0);
}

}  // namespace planner_constraints_test
}  // namespace qsmpc::controller
