// The outputs of a prediction: predict.json, predict.h5, the table, and docs/predict.md.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "controller/control/controller.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/errors.hpp"
#include "harness/prediction/prediction_file.hpp"
#include "harness/prediction/prediction_json.hpp"
#include "harness/prediction/prediction_table.hpp"
#include "tests/unit/prediction/prediction_fixture.hpp"

namespace qsmpc::harness {
namespace prediction_output_test {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::small_scenario;
using testing::TemporaryFolder;

const PredictionReport& simulated() {
  static const PredictionReport report =
      predict_scenario(testing::small_scenario(), {.monte_carlo = {.samples = 2000}});
  return report;
}

std::string content_of(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> keys_of(const nlohmann::ordered_json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

TEST(PredictionOutput, says_beside_the_numbers_that_none_is_a_bound) {
  PredictionReport report = simulated();
  EXPECT_THAT(prediction_table(report), HasSubstr("P(unsafe)<="));
  report.scenario.disturbance.sensor = Eigen::MatrixXd::Identity(3, 3);
  const std::string table = prediction_table(report);
  EXPECT_THAT(table, HasSubstr("NO BOUND: with measurement noise"));
  EXPECT_THAT(table, ::testing::Not(HasSubstr("P(unsafe)<=")));
  const auto json = nlohmann::json::parse(prediction_json(report));
  EXPECT_EQ(json["certificate"]["holds"], false);
  EXPECT_THAT(json["certificate"]["reason"], HasSubstr("disturbance.sensor"));
}

TEST(PredictionJson, keys_are_the_documented_ones) {
  const auto json = nlohmann::ordered_json::parse(prediction_json(simulated()));
  EXPECT_THAT(keys_of(json),
              ElementsAre("inputs", "cost", "stages", "horizon", "certificate", "particles"));
  EXPECT_EQ(json["certificate"]["holds"], true);
  EXPECT_TRUE(json["certificate"]["reason"].is_null());
  const auto& stage = json["stages"][0];
  EXPECT_THAT(keys_of(stage), ElementsAre("stage", "mean", "covariance", "w2_bound", "budget",
                                          "certificate", "monte_carlo"));
  EXPECT_THAT(keys_of(stage["budget"]),
              ElementsAre("belief", "noise", "compression", "model", "dynamics"));
  EXPECT_THAT(keys_of(stage["certificate"]),
              ElementsAre("value", "kind", "all", "entry", "thesis"));
  EXPECT_THAT(keys_of(stage["certificate"]["all"]), ElementsAre("c1", "c2", "c3", "c4", "c5"));
  EXPECT_THAT(keys_of(stage["monte_carlo"]), ElementsAre("rate", "lower", "upper", "samples"));
  EXPECT_THAT(keys_of(json["horizon"]), ElementsAre("value", "monte_carlo"));
}

TEST(PredictionJson, takes_what_any_controller_decides) {
  for (const controller::ControllerEntry& entry : controller::controllers()) {
    for (const char* about : {"path", "target"}) {
      std::vector<std::string> overrides = {"controller.kind=" + entry.name};
      if (entry.name == "lqr") {
        overrides.push_back(std::string("controller.lqr={about: ") + about + "}");
      }
      SCOPED_TRACE(entry.name + ", " + about);
      const Scenario scenario = small_scenario(overrides);
      const controller::DecisionParts parts = decision_parts(scenario);
      const PredictionReport report =
          predict_scenario(scenario, {.monte_carlo = {.samples = 20000}});
      const auto json = nlohmann::ordered_json::parse(prediction_json(report));
      EXPECT_EQ(json["stages"].size(), static_cast<std::size_t>(certified_stages(parts)));
      EXPECT_EQ(json["cost"].is_null(), !parts.cost);
      EXPECT_EQ(report.solver_status.empty(), !parts.status);
      EXPECT_EQ(prediction_table(report).find("expected cost") == std::string::npos, !parts.cost);
      // The certificates are for this controller's policy.
      EXPECT_TRUE(contradicted_stages(report).empty());
    }
  }
}

TEST(PredictionJson, holds_the_reports_numbers_bit_for_bit) {
  const PredictionReport& report = simulated();
  const auto json = nlohmann::json::parse(prediction_json(report));
  EXPECT_EQ(json["cost"], report.cost.total());
  ASSERT_EQ(json["inputs"].size(), 4U);
  ASSERT_EQ(json["stages"].size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& stage = json["stages"][k];
    const controller::StageCertificate& certificate = report.certificates[k];
    const Eigen::MatrixXd covariance = controller::covariance_of(report.prediction.stages[k + 1]);
    EXPECT_EQ(json["inputs"][k][0], report.policy.inputs(0, static_cast<Eigen::Index>(k)));
    EXPECT_EQ(stage["stage"], k + 1);
    EXPECT_EQ(stage["mean"][1], controller::mean_of(report.prediction.stages[k + 1])[1]);
    EXPECT_EQ(stage["covariance"][2][0], covariance(2, 0));
    EXPECT_EQ(stage["w2_bound"], report.budgets[k + 1].total);
    EXPECT_EQ(stage["budget"]["model"], report.budgets[k + 1].model);
    EXPECT_EQ(stage["budget"]["dynamics"], report.budgets[k + 1].dynamics);
    EXPECT_EQ(stage["certificate"]["value"], certificate.value);
    EXPECT_EQ(stage["certificate"]["kind"], certificate.kind);
    EXPECT_EQ(stage["certificate"]["all"]["c1"], certificate.of("c1"));
    EXPECT_EQ(stage["certificate"]["all"]["c2"], certificate.of("c2"));
    EXPECT_EQ(stage["certificate"]["all"]["c3"], certificate.of("c3"));
    EXPECT_EQ(stage["certificate"]["all"]["c4"], certificate.of("c4"));
    EXPECT_EQ(stage["certificate"]["thesis"], certificate.of("thesis"));
    EXPECT_EQ(stage["monte_carlo"]["samples"], 2000);
  }
  EXPECT_EQ(json["horizon"]["value"], report.horizon_bound);
  EXPECT_EQ(json["particles"], "predict.h5");
}

TEST(PredictionJson, without_simulation_has_no_block_for_it_and_infinity_is_null) {
  PredictionReport report = simulated();
  report.monte_carlo.reset();
  report.budgets[1].total = std::numeric_limits<double>::infinity();
  const auto json = nlohmann::json::parse(prediction_json(report));
  EXPECT_FALSE(json["stages"][0].contains("monte_carlo"));
  EXPECT_FALSE(json["horizon"].contains("monte_carlo"));
  EXPECT_TRUE(json["stages"][0]["w2_bound"].is_null());
}

TEST(PredictionFile, holds_particles_policy_and_certificates) {
  const TemporaryFolder folder;
  const PredictionReport& report = simulated();
  write_prediction(report, folder.path());
  const Hdf5File file = Hdf5File::open(folder.path() + "/predict.h5");
  EXPECT_EQ(file.text("/", "kind"), "prediction");
  EXPECT_EQ(file.integer("/", "schema"), kPredictionSchema);
  EXPECT_EQ(file.text("/", "scenario"), report.scenario_text);
  EXPECT_EQ(file.unsigned_integer("/", "seed"), 7U);
  EXPECT_EQ(file.text("/", "inputs"), "planned");
  EXPECT_EQ(file.integer("/monte_carlo", "samples"), 2000);

  const auto offsets = file.integers("/particles/offsets");
  const auto locations = file.doubles("/particles/locations");
  const auto stepped = file.doubles("/particles/stepped");
  const auto weights = file.doubles("/particles/weights");
  ASSERT_EQ(offsets.size(), 6U);
  for (std::size_t s = 0; s < 5; ++s) {
    const controller::DiscreteMeasure& stage = report.prediction.stages[s];
    ASSERT_EQ(offsets[s + 1] - offsets[s], stage.size());
    const auto last = static_cast<std::size_t>(offsets[s + 1]) - 1;
    EXPECT_EQ(locations[3 * last + 1], stage.locations(1, stage.size() - 1));
    EXPECT_EQ(weights[last], stage.weights[stage.size() - 1]);
    if (s < 4) {
      EXPECT_EQ(stepped[3 * last + 2], report.prediction.stepped[s](2, stage.size() - 1));
    }
  }
  EXPECT_EQ(stepped.size(), 3 * static_cast<std::size_t>(offsets[4]));
  EXPECT_EQ(file.shape("/plan/gains"), (std::vector<std::size_t>{4, 1, 3}));
  EXPECT_EQ(file.doubles("/plan/gains")[5], report.policy.gains[1](0, 2));
  EXPECT_EQ(file.doubles("/plan/states")[4], report.policy.states(1, 1));
  EXPECT_EQ(file.doubles("/certificate/budget")[4 * 4 + 3], report.budgets[4].total);
  EXPECT_EQ(file.doubles("/certificate/smoothed")[0], report.certificates[0].of("c4"));
  EXPECT_EQ(file.texts("/certificate/kind")[0], report.certificates[0].kind);
  EXPECT_EQ(file.doubles("/certificate/horizon")[0], report.horizon_bound);
  EXPECT_EQ(file.integers("/monte_carlo/unsafe"), report.monte_carlo->stages);
}

TEST(PredictionFile, every_dataset_names_its_units_and_axes_and_is_documented) {
  const TemporaryFolder folder;
  write_prediction(simulated(), folder.path());
  const Hdf5File file = Hdf5File::open(folder.path() + "/predict.h5");
  const std::string document = content_of(std::string(QSMPC_SOURCE_DIR) + "/docs/predict.md");
  for (const DatasetSpec& spec : prediction_layout(simulated())) {
    EXPECT_TRUE(file.has_attribute(spec.path, "units")) << spec.path;
    EXPECT_TRUE(file.has_attribute(spec.path, "axes")) << spec.path;
    const std::vector<std::size_t> shape = file.shape(spec.path);
    EXPECT_EQ(spec.axes.size(), shape.size()) << spec.path;
    EXPECT_TRUE(spec.units.size() == 1 || spec.units.size() == shape.back()) << spec.path;
    EXPECT_TRUE(spec.columns.empty() || spec.columns.size() == shape.back()) << spec.path;
    EXPECT_GT(shape.front(), 0U) << spec.path;
    const std::string name = spec.path.substr(spec.path.rfind('/') + 1);
    EXPECT_TRUE(document.find("`" + spec.path + "`") != std::string::npos ||
                document.find(", `" + name + "`") != std::string::npos)
        << spec.path;
  }
}

TEST(PredictionFile, equal_reports_give_equal_numbers_and_the_scenario_predicts_them_again) {
  const TemporaryFolder first;
  const TemporaryFolder second;
  write_prediction(simulated(), first.path());
  const Scenario again = load_scenario(first.path() + "/scenario.yaml");
  write_prediction(predict_scenario(again, {.monte_carlo = {.samples = 2000, .threads = 1}}),
                   second.path());
  for (const char* name : {"/predict.json", "/scenario.yaml"}) {
    EXPECT_EQ(content_of(first.path() + name), content_of(second.path() + name));
  }
}

TEST(PredictionFile, what_cannot_be_written_leaves_nothing_unfinished) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() + "/predict.h5/occupied");
  EXPECT_THROW(write_prediction(simulated(), folder.path()), IoError);
  EXPECT_FALSE(fs::exists(folder.path() + "/predict.json"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
}

TEST(PredictionTable, fits_80_columns_whatever_the_numbers) {
  PredictionReport report = simulated();
  report.prediction.stages[1].locations.row(0).setConstant(-123456.789);
  report.prediction.stages[2].locations.row(1).setConstant(-1.23456e-7);
  report.prediction.stages[3].locations.row(1).setConstant(
      std::numeric_limits<double>::quiet_NaN());
  report.budgets[1].total = 1.2345e100;
  report.budgets[2].total = std::numeric_limits<double>::infinity();
  report.monte_carlo->samples = 1'000'000'000;
  std::istringstream lines(prediction_table(report));
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 80U) << line;
    EXPECT_FALSE(line.ends_with(' ')) << line;
  }
}

TEST(PredictionTable, marks_the_published_value_as_not_a_bound) {
  EXPECT_THAT(prediction_table(simulated()), HasSubstr("thesis*"));
  EXPECT_THAT(prediction_table(simulated()), HasSubstr("NOT a bound"));
  PredictionReport plain = simulated();
  plain.monte_carlo.reset();
  EXPECT_THAT(prediction_table(plain), ::testing::Not(HasSubstr("rate")));
}

}  // namespace prediction_output_test
}  // namespace qsmpc::harness
