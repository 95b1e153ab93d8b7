// "scenario" compared with the optima found by CasADi's IPOPT for the same sampled paths
// (tests/data/scenario_optima/make_problems.py).
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "controller/chance/chance_planner.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {
namespace scenario_optima_test {

using Json = nlohmann::json;

Eigen::VectorXd vector_of(const Json& json) {
  const auto values = json.get<std::vector<double>>();
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Points points_of(const Json& rows) {
  Points points(static_cast<Eigen::Index>(rows.size()),
                static_cast<Eigen::Index>(rows.front().size()));
  for (Eigen::Index i = 0; i < points.rows(); ++i) points.row(i) = vector_of(rows[i]).transpose();
  return points;
}

ChancePlannerSettings settings_of(const Json& problem) {
  ChancePlannerSettings settings;
  PlannerSettings& planned = settings.problem;
  planned.horizon = static_cast<int>(problem["noise"].size());
  planned.closed_loop = false;
  planned.max_evaluations = 1000;
  planned.noise_covariance = 1e-4 * Eigen::Matrix3d::Identity();
  const double most_turn = problem["most_turn"];
  planned.bounds = {.lower = Eigen::VectorXd::Constant(1, -most_turn),
                    .upper = Eigen::VectorXd::Constant(1, most_turn)};
  planned.cost = {.state = vector_of(problem["cost_state"]).asDiagonal(),
                  .input = Eigen::MatrixXd::Constant(1, 1, problem["cost_input"].get<double>()),
                  .terminal = vector_of(problem["cost_terminal"]).asDiagonal(),
                  .target = vector_of(problem["target"])};
  planned.penalty = {.box = 500.0, .obstacle = 500.0, .length = 0.1};  // for the first guess
  SafeSet& safe = planned.safe_set;
  safe = unbounded_safe_set(3);
  safe.bounds.upper[1] = problem["wall"];
  Box block = unbounded_safe_set(3).bounds;
  const Eigen::VectorXd ends = vector_of(problem["block"]);
  block.lower.head<2>() = ends.head<2>();
  block.upper.head<2>() = ends.tail<2>();
  safe.obstacles.push_back(block);
  safe.body = {.discs = {{.radius = problem["radius"]}}, .x = 0, .y = 1, .heading = 2};
  settings.constraint = "scenario";
  settings.chance.paths = static_cast<int>(problem["start"].front().size());
  return settings;
}

TEST(Scenario, finds_the_optima_of_ipopt) {
  std::ifstream file(std::string(QSMPC_SOURCE_DIR) + "/tests/data/scenario_optima/problems.json");
  const Json problems = Json::parse(file);
  ASSERT_EQ(problems.size(), 20U);
  for (std::size_t n = 0; n < problems.size(); ++n) {
    SCOPED_TRACE("problem " + std::to_string(n));
    const Json& problem = problems[n];
    const auto car = models::make_dynamics("dubins", {{"speed", problem["speed"].get<double>()}},
                                           problem["time_step"].get<double>());
    PathDraw draw{.start = points_of(problem["start"]), .noise = {}};
    for (const Json& noise : problem["noise"]) draw.noise.push_back(points_of(noise));
    ChancePlanner planner(*car, settings_of(problem));
    const Gaussian belief{.mean = vector_of(problem["mean"]),
                          .covariance = 1e-4 * Eigen::Matrix3d::Identity()};
    const ChancePlan& plan = planner.plan(belief, draw);
    EXPECT_LT(plan.violation, 1e-6);
    const double optimum = problem["cost"];
    EXPECT_NEAR(plan.cost.total(), optimum, 1e-4 * optimum);
  }
}

}  // namespace scenario_optima_test
}  // namespace qsmpc::controller
