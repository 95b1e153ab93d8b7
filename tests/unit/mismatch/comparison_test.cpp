#include "harness/mismatch/comparison.hpp"

#include <cmath>
#include <filesystem>
#include <sstream>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "harness/mismatch/comparison_file.hpp"
#include "harness/mismatch/comparison_json.hpp"
#include "harness/mismatch/comparison_table.hpp"
#include "tests/unit/mismatch/mismatch_fixture.hpp"

namespace qsmpc::harness {
namespace comparison_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::short_scenario;

ComparisonOptions small_options(const std::vector<std::string>& plants) {
  ComparisonOptions options;
  options.plants = plants;
  options.episodes = 3;
  options.paths = 60;
  return options;
}

/// The numbers, except wall-clock values.
std::string numbers_of(Comparison comparison) {
  for (PlantComparison& plant : comparison.plants) plant.speed = 1.0;
  return comparison_json(comparison);
}

TEST(ComparePlants, gives_the_same_bits_for_any_number_of_threads) {
  const Scenario scenario = testing::short_scenario();
  ComparisonOptions options = small_options({"analytic", "mujoco"});
  options.error_plant = "mujoco";
  options.threads = 1;
  const auto one = compare_plants(scenario, options);
  options.threads = 3;
  const auto three = compare_plants(scenario, options);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(numbers_of(*one), numbers_of(*three));
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(one->plants[n].paths.states.back(), three->plants[n].paths.states.back());
    EXPECT_EQ(one->plants[n].paths.residuals.back(), three->plants[n].paths.residuals.back());
    EXPECT_EQ(one->plants[n].episodes[2].residuals, three->plants[n].episodes[2].residuals);
  }
}

// It would make results depend on the machine's load.
TEST(ComparePlants, a_deadline_of_the_planner_is_left_out) {
  const auto without = compare_plants(testing::short_scenario(), small_options({"analytic"}));
  const auto with = compare_plants(testing::short_scenario({"controller.deadline=1e-6"}),
                                   small_options({"analytic"}));
  ASSERT_TRUE(without && with);
  EXPECT_EQ(numbers_of(*without), numbers_of(*with));
}

TEST(ComparePlants, a_model_error_of_the_scenario_is_in_force) {
  const auto plain = compare_plants(testing::short_scenario(), small_options({"analytic"}));
  const auto comparison = compare_plants(
      testing::short_scenario({"model_error.rms=[0.02, 0.02, 0.01]"}), small_options({"analytic"}));
  ASSERT_TRUE(plain && comparison && comparison->with_error);
  EXPECT_FALSE(plain->with_error);
  EXPECT_EQ(&plain->in_force(), &plain->certificates);
  EXPECT_EQ(&comparison->in_force(), &*comparison->with_error);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(comparison->certificates[k].value, plain->certificates[k].value) << k;
    EXPECT_GT((*comparison->with_error)[k].value, plain->certificates[k].value) << k;
  }
  const auto json = nlohmann::json::parse(comparison_json(*comparison));
  const auto& stage = json["plants"]["analytic"]["certificate"]["stages"][1];
  EXPECT_EQ(stage["with"], (*comparison->with_error)[1].value);
}

TEST(ExceededStages, are_those_whose_certificate_is_below_the_lower_limit) {
  std::vector<HorizonStage> horizon(4);
  std::vector<controller::StageCertificate> certificates(4);
  for (std::size_t k = 0; k < 4; ++k) {
    horizon[k].stage = static_cast<int>(k) + 1;
    horizon[k].unsafe_limits = {.lower = 0.1, .upper = 0.2};
  }
  certificates[0].value = 0.15;
  certificates[1].value = 0.05;
  certificates[2].value = 0.1;
  certificates[3].value = std::nan("");
  EXPECT_THAT(exceeded_stages(horizon, certificates), ElementsAre(2, 4));
}

TEST(ComparePlants, the_analytic_plant_is_the_model_but_for_rounding) {
  const auto comparison = compare_plants(testing::short_scenario(), small_options({"analytic"}));
  ASSERT_TRUE(comparison);
  const PlantComparison& plant = comparison->plants[0];
  EXPECT_TRUE((plant.one_step.rmse.array() <= plant.one_step.rounding.array()).all());
  EXPECT_GT(plant.one_step.periods, 10);
  for (const HorizonStage& stage : plant.horizon) {
    EXPECT_LT(stage.divergence_rmse.maxCoeff(), 1e-14);
    const W2Floor& floor = comparison->floors[static_cast<std::size_t>(stage.stage)];
    // As in W2Floors: 1 in 1000.
    EXPECT_LT(std::abs(stage.w2 - floor.mean), 5.41 * 1.07 * floor.deviation) << stage.stage;
  }
}

// The corridor's car turns along arcs, as the planar car's joints do: the planar car differs from
// the model only by MuJoCo's integrator, the wheeled car by tyres, suspension and servos.
TEST(ComparePlants, in_the_corridor_the_planar_car_is_nearer_to_the_model_than_the_wheeled_one) {
  const Scenario corridor = load_scenario("dubins_corridor", {"vehicle.footprint=point"});
  ComparisonOptions options = small_options({"analytic", "mujoco_planar", "mujoco_car"});
  options.paths = 200;
  const auto comparison = compare_plants(corridor, options);
  ASSERT_TRUE(comparison);
  const auto& [model, planar, wheeled] =
      std::tie(comparison->plants[0], comparison->plants[1], comparison->plants[2]);
  EXPECT_LT(model.one_step.rmse.norm(), 1e-14);
  EXPECT_LT(model.one_step.rmse.norm(), planar.one_step.rmse.norm());
  EXPECT_LT(planar.one_step.rmse.norm(), wheeled.one_step.rmse.norm());
  ASSERT_EQ(planar.horizon.size(), 8U);
  for (std::size_t k = 0; k < planar.horizon.size(); ++k) {
    EXPECT_LT(model.horizon[k].w2_to_model(), 1e-14) << k;
    EXPECT_LT(model.horizon[k].w2_to_model(), planar.horizon[k].w2_to_model()) << k;
    EXPECT_LT(planar.horizon[k].w2_to_model(), wheeled.horizon[k].w2_to_model()) << k;
    // As in W2Floors: 1 in 1000.
    const W2Floor& floor = comparison->floors[k + 1];
    EXPECT_LT(std::abs(model.horizon[k].w2 - floor.mean), 5.41 * 1.07 * floor.deviation) << k;
  }
}

TEST(ComparePlants, a_mujoco_vehicle_is_not_the_model) {
  ComparisonOptions options = small_options({"mujoco_car"});
  options.error_plant = "mujoco_car";
  const auto comparison = compare_plants(testing::short_scenario(), options);
  ASSERT_TRUE(comparison && comparison->measured_error);
  const PlantComparison& plant = comparison->plants[0];
  EXPECT_GT(plant.one_step.rmse[0], 1e-6);
  EXPECT_GT(plant.horizon.back().divergence_rmse[0], plant.one_step.rounding[0]);
  EXPECT_GT(plant.speed, 0.0);
  // Some period has at least the error of all of them together.
  const controller::ModelError& error = *comparison->measured_error;
  EXPECT_EQ(error.first.size(), 2U) << "all periods of the plan but the last";
  Eigen::VectorXd most = error.root_mean_square;
  for (const controller::ModelError& own : error.first) {
    most = most.cwiseMax(own.offset.cwiseAbs() + own.root_mean_square);
  }
  EXPECT_TRUE((most.array() >= plant.one_step.rmse.array()).all());
  const auto json = nlohmann::json::parse(comparison_json(*comparison))["model_error"];
  EXPECT_EQ(json["first"].size(), 2U);
  EXPECT_EQ(json["first"][1]["offset"][0], error.first[1].offset[0]);
  EXPECT_EQ(json["first"][1]["norm8"][2], error.first[1].higher[1][2]);
}

TEST(ComparePlants, without_names_takes_the_model_and_the_scenarios_own_plant) {
  EXPECT_THAT(default_plants(testing::short_scenario()), ElementsAre("analytic"));
  EXPECT_THAT(default_plants(testing::short_scenario({"plant.kind=mujoco"})),
              ElementsAre("analytic", "mujoco"));
  const auto comparison =
      compare_plants(testing::short_scenario(), small_options({"analytic", "analytic"}));
  EXPECT_EQ(comparison->plants.size(), 1U) << "a name given twice";
}

TEST(ComparePlants, refuses_names_that_are_not_known_before_anything_is_made) {
  ComparisonOptions options = small_options({"analytic", "mujoco_cra"});
  options.on_plants_ready = [] { ADD_FAILURE() << "too late"; };
  options.on_progress = [](auto...) { ADD_FAILURE() << "too late"; };
  try {
    (void)compare_plants(testing::short_scenario(), options);
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("mujoco_cra"));
    EXPECT_THAT(error.what(), HasSubstr("mujoco_car"));
  }
  options = small_options({"analytic"});
  options.error_plant = "mujoco_car";
  EXPECT_THROW((void)compare_plants(testing::short_scenario(), options), InputError);
}

TEST(ComparePlants, stops_when_asked_and_reports_its_progress) {
  ComparisonOptions options = small_options({"analytic"});
  options.should_stop = [] { return true; };
  EXPECT_FALSE(compare_plants(testing::short_scenario(), options));
  std::int64_t last = 0;
  options = small_options({"analytic"});
  options.on_progress = [&](std::int64_t done, std::int64_t total, const std::string&) {
    EXPECT_EQ(done, last + 1);
    EXPECT_EQ(total, 3 + 3);  // episodes, and batches of paths
    last = done;
  };
  EXPECT_TRUE(compare_plants(testing::short_scenario(), options));
  EXPECT_EQ(last, 6);
}

class WrittenComparison : public ::testing::Test {
 protected:
  WrittenComparison() {
    std::string name = ::testing::TempDir() + "comparison_XXXXXX";
    folder_ = ::mkdtemp(name.data());
    comparison_ =
        *compare_plants(testing::short_scenario(), small_options({"analytic", "mujoco_car"}));
  }
  ~WrittenComparison() override { std::filesystem::remove_all(folder_); }

  std::string folder_;
  Comparison comparison_;
};

TEST_F(WrittenComparison, json_has_the_promised_keys) {
  const auto json = nlohmann::json::parse(comparison_json(comparison_));
  ASSERT_TRUE(json["plants"].contains("mujoco_car"));
  const auto& plant = json["plants"]["mujoco_car"];
  for (const char* pointer : {"/episodes",
                              "/one_step/rmse",
                              "/one_step/mean",
                              "/one_step/covariance",
                              "/one_step/whiteness/lag1",
                              "/one_step/whiteness/ljung_box",
                              "/one_step/whiteness/p_value",
                              "/horizon/0/stage",
                              "/horizon/0/divergence_rmse",
                              "/horizon/0/w2",
                              "/horizon/0/w2_floor",
                              "/closed_loop/cost",
                              "/closed_loop/min_clearance",
                              "/closed_loop/unsafe_rate",
                              "/closed_loop/unsafe_interval/1",
                              "/closed_loop/certificate_exceeded",
                              "/closed_loop/next_step/p_value",
                              "/ensemble/paths",
                              "/certificate/stages/2/stage",
                              "/certificate/stages/0/without",
                              "/certificate/stages/0/with",
                              "/certificate/stages/0/observed",
                              "/certificate/stages/0/lower",
                              "/certificate/stages/0/upper",
                              "/speed/times_real_time"}) {
    EXPECT_TRUE(plant.contains(nlohmann::json::json_pointer(pointer))) << pointer;
  }
  EXPECT_EQ(plant["horizon"].size(), 3U);
  EXPECT_EQ(plant["one_step"]["covariance"].size(), 3U);
  EXPECT_EQ(json["states"][2]["unit"], "rad");
}

TEST_F(WrittenComparison, table_fits_a_terminal_and_names_every_plant) {
  const std::string table = comparison_table(comparison_);
  EXPECT_THAT(table, HasSubstr("analytic: matches the model except for rounding"));
  EXPECT_THAT(table, HasSubstr("mujoco_car"));
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 96U) << line;
}

TEST_F(WrittenComparison, says_beside_the_numbers_of_drives_that_they_are_not_bounds) {
  EXPECT_THAT(comparison_table(comparison_), ::testing::Not(HasSubstr("NO BOUND")));
  EXPECT_EQ(nlohmann::json::parse(comparison_json(comparison_))["certificate"]["holds"], true);
  comparison_.scenario.disturbance.sensor = Eigen::MatrixXd::Identity(3, 3);
  const std::string table = comparison_table(comparison_);
  EXPECT_THAT(table, HasSubstr("NO BOUND: with measurement noise"));
  const std::size_t drives = table.find("\nCertificates ");
  EXPECT_THAT(table.substr(0, drives), ::testing::Not(HasSubstr("NO BOUND")))
      << "along the plan the policy sees the state";
  EXPECT_THAT(table.substr(0, drives), HasSubstr("certified "));
  EXPECT_THAT(table.substr(drives), HasSubstr("  NO BOUND  "));
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 96U) << line;
  const auto scope = nlohmann::json::parse(comparison_json(comparison_))["certificate"];
  EXPECT_EQ(scope["holds"], false);
  EXPECT_EQ(scope["along_plan"]["holds"], true);
}

TEST_F(WrittenComparison, datasets_have_the_promised_shapes_and_units) {
  write_comparison(comparison_, {{.path = folder_ + "/more.svg", .text = "more"}}, folder_);
  const Hdf5File file = Hdf5File::open(folder_ + "/comparison.h5");
  EXPECT_EQ(file.text("/", "kind"), "comparison");
  EXPECT_EQ(file.text("/plants/mujoco_car", "name"), "mujoco_car");
  EXPECT_THAT(file.shape("/plants/mujoco_car/paths/states"), ElementsAre(4U, 60U, 3U));
  EXPECT_THAT(file.shape("/plants/analytic/horizon/divergence_rmse"), ElementsAre(3U, 3U));
  EXPECT_THAT(file.shape("/plants/analytic/closed_loop/cost"), ElementsAre(3U));
  EXPECT_EQ(file.shape("/plants/analytic/one_step/residuals")[0],
            static_cast<std::size_t>(comparison_.plants[0].one_step.periods));
  EXPECT_EQ(file.shape("/model/w2_floor")[0], 4U);
  const std::vector<double> states = file.doubles("/plants/mujoco_car/paths/states");
  // Stage 2, path 7, heading.
  EXPECT_EQ(states[(2 * 60 + 7) * 3 + 2], comparison_.plants[1].paths.states[2](2, 7));
  for (const DatasetSpec& spec : comparison_layout(comparison_)) {
    EXPECT_TRUE(file.has_attribute(spec.path, "units")) << spec.path;
    EXPECT_TRUE(file.has_attribute(spec.path, "axes")) << spec.path;
    EXPECT_GT(file.shape(spec.path)[0], 0U) << spec.path;
  }
  for (const char* name : {"comparison.json", "scenario.yaml", "more.svg"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ + "/" + name)) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ + "/comparison.json.partial"));
}

TEST_F(WrittenComparison, plants_that_are_paths_have_groups_of_their_own) {
  comparison_.plants[0].name = "../cars/a.xml";
  comparison_.plants[1].name = "../cars/a_xml";
  EXPECT_THAT(plant_groups(comparison_),
              ElementsAre("/plants/_._cars_a.xml", "/plants/_._cars_a_xml"));
  comparison_.plants[0].name = comparison_.plants[1].name = "a b";
  EXPECT_THAT(plant_groups(comparison_), ElementsAre("/plants/a_b", "/plants/a_b_2"));
}

TEST_F(WrittenComparison, where_one_file_cannot_be_written_none_is_left) {
  EXPECT_THROW(
      write_comparison(comparison_, {{.path = folder_ + "/no/more.svg", .text = "more"}}, folder_),
      IoError);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace comparison_test
}  // namespace qsmpc::harness
