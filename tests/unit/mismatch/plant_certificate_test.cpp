// The purpose of a comparison: it detects a plant that the model's certificates do not cover, and
// certificates with its measured error cover it.
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/certification/certificate.hpp"
#include "harness/mismatch/comparison.hpp"
#include "harness/mismatch/measured_error.hpp"
#include "tests/unit/mismatch/mismatch_fixture.hpp"

namespace qsmpc::harness {
namespace mismatch_plant_certificate_test {

using testing::altered_plants;
using ::testing::IsEmpty;
using testing::Planned;

constexpr std::int64_t kPaths = 400;

std::vector<controller::StageCertificate> certificates(const Planned& planned,
                                                       const controller::Plan& plan,
                                                       const controller::Planner& planner,
                                                       const controller::ModelError* error) {
  controller::PredictedMotion motion = controller::motion_of(planner, planned.belief, plan);
  motion.model_error = error;
  return controller::certify(motion, planned.scenario.safe_set, controller::error_budget(motion));
}

// A side wind of 0.15 m per period towards a wall that the model keeps clear of.
TEST(PlantCertificates, those_of_the_model_are_exceeded_and_those_with_the_measured_error_hold) {
  const Planned planned(testing::short_scenario());
  PlantPool pool = testing::altered_plants(planned.scenario, Eigen::Vector3d(0.0, -0.15, 0.0));
  SharedWork work(path_batches(kPaths), {}, {});
  const PlantPaths plant =
      plant_paths(pool, *planned.model, planned.source(), kPaths, controller::run_in_turn, work);
  const std::vector<controller::Points> model =
      model_paths(*planned.model, planned.source(), kPaths, controller::run_in_turn);
  const auto horizon =
      compare_along_horizon(plant, model, planned.particles, planned.scenario.safe_set,
                            {.w2_paths = kPaths}, controller::run_in_turn);

  ResidualSample sample{.by_period = true};
  for (Eigen::Index i = 0; i < kPaths; ++i) {
    Eigen::MatrixXd path(3, 3);
    for (Eigen::Index k = 0; k < 3; ++k) {
      path.col(k) = plant.residuals[static_cast<std::size_t>(k)].col(i);
    }
    sample.units.push_back(path);
  }
  const controller::ModelError error = measured_model_error({sample}, 1);
  EXPECT_NEAR(error.root_mean_square[1], 0.15, 1e-9);

  controller::Planner planner(*planned.model, planner_settings(planned.scenario));
  const controller::Plan& plan = planner.plan(planned.belief);
  EXPECT_THAT(exceeded_stages(horizon, certificates(planned, plan, planner, nullptr)),
              ::testing::Not(IsEmpty()));
  EXPECT_THAT(exceeded_stages(horizon, certificates(planned, plan, planner, &error)), IsEmpty());
}

// The same with the shipped wheeled car, measured and judged on different random numbers.
TEST(PlantCertificates, with_the_measured_error_hold_for_the_car_on_wheels_on_other_seeds) {
  Scenario scenario = load_scenario("car_past_a_wall", {});
  ComparisonOptions options{
      .plants = {"mujoco_car"}, .episodes = 8, .paths = kPaths, .error_plant = "mujoco_car"};
  scenario.seed = 0;
  const auto measured = compare_plants(scenario, options);
  ASSERT_TRUE(measured.has_value());
  EXPECT_THAT(measured->plants.front().exceeded_stages, ::testing::Not(IsEmpty()));
  options.episodes = 1;  // it is judged by the paths
  scenario.seed = 1000;
  scenario.model_error = measured->measured_error;
  const auto judged = compare_plants(scenario, options);
  ASSERT_TRUE(judged.has_value());
  EXPECT_THAT(judged->plants.front().exceeded_stages, IsEmpty());
  EXPECT_THAT(exceeded_stages(judged->plants.front().horizon, judged->certificates),
              ::testing::Not(IsEmpty()));
  // They are not trivial: at the worst stage about 0.3 of the paths are unsafe.
  ASSERT_TRUE(judged->with_error.has_value());
  for (const controller::StageCertificate& certificate : *judged->with_error) {
    EXPECT_LT(certificate.value, 0.7);
  }
}

}  // namespace mismatch_plant_certificate_test
}  // namespace qsmpc::harness
