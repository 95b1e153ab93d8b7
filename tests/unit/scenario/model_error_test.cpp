// The key `model_error`, and files with its keys.
#include <cmath>
#include <filesystem>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scenario/error_origin.hpp"
#include "harness/scenario/model_error_reader.hpp"
#include "harness/scenario/scenario_warnings.hpp"
#include "harness/scenario/shipped_files.hpp"
#include "tests/unit/scenario/scenario_fixture.hpp"

namespace qsmpc::harness {
namespace scenario_model_error_test {

using ::testing::HasSubstr;

const std::string whole_text =
    "mean: [0.001, -0.002, 0.0003]\n"
    "covariance: [[1e-4, 1e-5, 0], [1e-5, 2e-4, 0], [0, 0, 1e-6]]\n"
    "rms: [0.01, 0.02, 0.001]\n"
    "norm4: [0.012, 0.025, 0.001]\n"
    "norm8: [0.02, 0.03, 0.002]\n"
    "radius: 0.025\n";

const std::string drive_text = whole_text +
                               "first:\n"
                               "  - offset: [0.1, -0.2, 0.3]\n"
                               "    rms: [0.1, 0.2, 0.01]\n"
                               "    norm4: [0.12, 0.25, 0.01]\n"
                               "  - rms: [0.03, 0.04, 0]\n"
                               "    norm8: [0.05, 0.05, 0.01]\n"
                               "    radius: 0.06\n";

/// `text` with each line indented, as the value of a key.
std::string indented(const std::string& text) {
  std::string out = "  ";
  for (std::size_t i = 0; i < text.size(); ++i) {
    out += text[i];
    if (text[i] == '\n' && i + 1 < text.size()) out += "  ";
  }
  return out;
}

controller::ModelError loaded(const std::string& text) {
  const Scenario scenario = parse_scenario(minimal_text + "model_error:\n" + indented(text));
  EXPECT_TRUE(scenario.model_error.has_value());
  return scenario.model_error.value_or(controller::ModelError{});
}

void expect_same(const controller::ModelError& one, const controller::ModelError& other) {
  EXPECT_EQ(one.mean, other.mean);
  EXPECT_EQ(one.covariance, other.covariance);
  EXPECT_EQ(one.root_mean_square, other.root_mean_square);
  EXPECT_EQ(one.higher, other.higher);
  EXPECT_EQ(one.stated_radius, other.stated_radius);
  EXPECT_EQ(one.offset, other.offset);
  ASSERT_EQ(one.first.size(), other.first.size());
  for (std::size_t k = 0; k < one.first.size(); ++k) expect_same(one.first[k], other.first[k]);
}

TEST(ModelErrorKey, every_key_reaches_its_value) {
  const controller::ModelError error = loaded(whole_text);
  EXPECT_EQ(error.mean, Eigen::Vector3d(0.001, -0.002, 0.0003));
  EXPECT_EQ(error.covariance(1, 0), 1e-5);
  EXPECT_EQ(error.root_mean_square, Eigen::Vector3d(0.01, 0.02, 0.001));
  EXPECT_EQ(error.higher[0], Eigen::Vector3d(0.012, 0.025, 0.001));
  EXPECT_EQ(error.higher[1], Eigen::Vector3d(0.02, 0.03, 0.002));
  EXPECT_EQ(error.radius(), 0.025);
}

TEST(ModelErrorKey, first_periods_of_a_drive_have_keys_of_their_own) {
  const controller::ModelError error = loaded(drive_text);
  EXPECT_EQ(error.root_mean_square, Eigen::Vector3d(0.01, 0.02, 0.001));
  EXPECT_EQ(error.offset.size(), 0);
  ASSERT_EQ(error.first.size(), 2U);
  EXPECT_EQ(error.first[0].offset, Eigen::Vector3d(0.1, -0.2, 0.3));
  EXPECT_EQ(error.first[0].root_mean_square, Eigen::Vector3d(0.1, 0.2, 0.01));
  EXPECT_EQ(error.first[0].higher[0], Eigen::Vector3d(0.12, 0.25, 0.01));
  EXPECT_EQ(error.first[0].higher[1][0], std::numeric_limits<double>::infinity());
  EXPECT_NEAR(error.first[0].radius(), Eigen::Vector3d(0.2, 0.4, 0.31).norm(), 1e-15);
  EXPECT_EQ(error.first[1].offset.size(), 0);
  EXPECT_EQ(error.first[1].higher[1], Eigen::Vector3d(0.05, 0.05, 0.01));
  EXPECT_EQ(error.first[1].radius(), 0.06);
}

TEST(ModelErrorKey, what_is_left_out_is_unknown) {
  const controller::ModelError error = loaded("rms: [0.03, 0.04, 0]\n");
  EXPECT_EQ(error.mean.size(), 0);
  EXPECT_EQ(error.covariance.size(), 0);
  EXPECT_EQ(error.higher[0][1], std::numeric_limits<double>::infinity());
  EXPECT_EQ(error.higher[1][2], std::numeric_limits<double>::infinity());
  EXPECT_NEAR(error.radius(), 0.05, 1e-16);  // one rounding
  EXPECT_FALSE(parse_scenario(minimal_text).model_error.has_value());
}

TEST(ModelErrorKey, resolved_scenarios_hold_it_and_read_it_back_bit_for_bit) {
  for (const std::string& text :
       {whole_text, drive_text, std::string("rms: [0.1, 0.3, 1e-300]\noffset: [0, -0.0, 1]\n")}) {
    const Scenario scenario = parse_scenario(minimal_text + "model_error:\n" + indented(text));
    const std::string written = to_yaml(scenario);
    const Scenario read = parse_scenario(written);
    ASSERT_TRUE(read.model_error.has_value());
    expect_same(*read.model_error, *scenario.model_error);
    EXPECT_EQ(to_yaml(read), written);
  }
  EXPECT_EQ(to_yaml(parse_scenario(minimal_text)).find("model_error"), std::string::npos);
}

TEST(ModelErrorKey, names_a_file_beside_the_scenario) {
  const TemporaryFolder folder;
  const controller::ModelError error = loaded(whole_text);
  (void)folder.file("error.yaml", model_error_yaml({error}, "dubins", "from 3 episodes"));
  const std::string path = folder.file("s.yaml", minimal_text + "model_error: error.yaml\n");
  expect_same(load_scenario(path).model_error.value(), error);
  // The resolved scenario no longer needs the file.
  expect_same(parse_scenario(to_yaml(load_scenario(path))).model_error.value(), error);
  const std::string absolute = "model_error=" + (folder / "error.yaml");
  expect_same(load_scenario(path, {absolute}).model_error.value(), error);
}

TEST(ModelErrorKey, of_a_drive_is_read_back_from_a_file) {
  const TemporaryFolder folder;
  const controller::ModelError error = loaded(drive_text);
  (void)folder.file("error.yaml", model_error_yaml({error}, "dubins", "of a drive"));
  const std::string path = folder.file("s.yaml", minimal_text + "model_error: error.yaml\n");
  expect_same(load_scenario(path).model_error.value(), error);
}

TEST(ModelErrorKey, of_the_command_line_is_found_in_the_working_folder_too) {
  const TemporaryFolder folder;
  const controller::ModelError error = loaded(whole_text);
  (void)folder.file("error.yaml", model_error_yaml({error}, "dubins", ""));
  const TemporaryFolder elsewhere;
  const std::string path = elsewhere.file("s.yaml", minimal_text);
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder / "");
  const auto found = load_scenario(path, {"model_error=error.yaml"}).model_error;
  std::filesystem::current_path(before);
  ASSERT_TRUE(found.has_value());
  expect_same(*found, error);
}

TEST(ModelErrorKey, problems_of_its_file_are_reported_with_name_and_line) {
  const TemporaryFolder folder;
  (void)folder.file("error.yaml", "system: bicycle\nrms: [0.1, 0.1, 0.1]\nnorm4: [1, 1, 0.01]\n");
  const std::string path = folder.file("s.yaml", minimal_text + "model_error: error.yaml\n");
  const std::vector<InputError::Where> problems = validate_scenario_file(path);
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(problems[0].file, folder / "error.yaml");
  EXPECT_EQ(problems[0].line, 1);
  EXPECT_EQ(problems[0].key, "system");
  EXPECT_EQ(problems[0].found, "bicycle");
  EXPECT_THAT(problems[0].expected, HasSubstr("dubins"));
  EXPECT_EQ(problems[1].line, 3);
  EXPECT_EQ(problems[1].key, "norm4");
  EXPECT_THAT(problems[1].found, HasSubstr("0.01 at position 3"));
  // A file that is not YAML is an error like any other.
  (void)folder.file("error.yaml", "rms: [1, 2\n");
  EXPECT_EQ(validate_scenario_file(path).at(0).file, folder / "error.yaml");
}

/// An error file measured with the scenario of `overrides`, beside a scenario that names it.
std::string scenario_with_error_of(const TemporaryFolder& folder,
                                   const std::vector<std::string>& overrides) {
  (void)folder.file("error.yaml", model_error_yaml({loaded("rms: [0.1, 0.1, 0.1]\n"),
                                                    error_origin_of(minimal_with(overrides))},
                                                   "dubins"));
  return folder.file("s.yaml", minimal_text + "model_error: error.yaml\n");
}

TEST(ErrorOrigin, of_another_model_or_control_period_is_refused) {
  const TemporaryFolder folder;
  const std::string path = scenario_with_error_of(folder, {"model.speed=1.5", "time_step=0.1"});
  const auto problems = [&](const std::vector<std::string>& overrides) {
    return validate_scenario_file(path, overrides);
  };
  EXPECT_TRUE(problems({"model.speed=1.5", "time_step=0.1"}).empty());
  const auto speed = problems({"model.speed=3", "time_step=0.1"});
  ASSERT_EQ(speed.size(), 1U);
  EXPECT_EQ(speed[0].file, folder / "error.yaml");
  EXPECT_EQ(speed[0].key, "measured.parameters.speed");
  EXPECT_EQ(speed[0].found, "1.5");
  EXPECT_THAT(speed[0].expected, HasSubstr("3, the model's"));
  const auto period = problems({"model.speed=1.5", "time_step=0.05"});
  ASSERT_EQ(period.size(), 1U);
  EXPECT_EQ(period[0].key, "measured.time_step");
}

TEST(ErrorOrigin, of_another_plant_is_warned_of) {
  const std::vector<std::string> car = {"plant={kind: mujoco, mjcf: dubins_car.xml}",
                                        "disturbance.friction=0.1"};
  const TemporaryFolder folder;
  const std::string path = scenario_with_error_of(folder, car);
  const auto warnings = [&](std::vector<std::string> overrides) {
    return scenario_warnings(load_scenario(path, overrides));
  };
  EXPECT_THAT(warnings(car), ::testing::IsEmpty());
  EXPECT_THAT(warnings({"plant={kind: mujoco, mjcf: dubins_car.xml}", "disturbance.friction=0.4"}),
              ::testing::ElementsAre(HasSubstr("disturbance.friction: 0.1 there, 0.4 here")));
  EXPECT_THAT(
      warnings({"plant={kind: mujoco, mjcf: dubins_planar.xml}", "disturbance.friction=0.1"}),
      ::testing::ElementsAre(
          HasSubstr("plant.mjcf: dubins_car.xml there, dubins_planar.xml here")));
  EXPECT_THAT(warnings({"disturbance.friction=0.1"}),
              ::testing::Contains(HasSubstr("plant.kind: mujoco there, analytic here")));
}

TEST(ErrorOrigin, of_a_file_that_has_changed_is_warned_of) {
  const TemporaryFolder folder;
  const std::string car = content_of(find_mjcf("dubins_planar.xml", ""));
  const std::vector<std::string> own = {
      "plant={kind: mujoco, mjcf: " + folder.file("car.xml", car) + "}"};
  const std::string path = scenario_with_error_of(folder, own);
  EXPECT_THAT(scenario_warnings(load_scenario(path, own)), ::testing::IsEmpty());
  std::string heavier = car;
  const std::size_t mass = heavier.find("mass=\"3.5\"");
  ASSERT_NE(mass, std::string::npos);
  heavier.insert(mass + 6, "1");
  (void)folder.file("car.xml", heavier);
  EXPECT_THAT(scenario_warnings(load_scenario(path, own)),
              ::testing::ElementsAre(HasSubstr("car.xml has changed since")));
}

TEST(ErrorOrigin, stays_in_the_resolved_scenario_and_is_not_needed) {
  const TemporaryFolder folder;
  const std::string path =
      scenario_with_error_of(folder, {"plant={kind: mujoco, mjcf: dubins_car.xml}"});
  const std::string written = to_yaml(load_scenario(path));
  const Scenario read = parse_scenario(written);
  ASSERT_TRUE(read.error_origin.has_value());
  EXPECT_EQ(read.error_origin->plant.mjcf, "dubins_car.xml");
  EXPECT_EQ(to_yaml(read), written);
  (void)folder.file("error.yaml", "system: dubins\nrms: [0.1, 0.1, 0.1]\n");
  EXPECT_FALSE(load_scenario(path).error_origin.has_value());
  EXPECT_THAT(scenario_warnings(load_scenario(path)), ::testing::IsEmpty());
}

TEST(ModelErrorKey, rounding_of_printed_norms_is_not_a_contradiction) {
  EXPECT_EQ(loaded("rms: [0.1, 0, 0]\nradius: 0.09999999999\n").radius(), 0.09999999999);
}

struct Refused {
  std::string name;
  std::string text;
  std::string key;
  std::string expected;  ///< a piece of it
};

std::string name_of(const ::testing::TestParamInfo<Refused>& info) { return info.param.name; }

class RefusedModelError : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedModelError, is_reported_with_where_and_why) {
  const Refused& refused = GetParam();
  const InputError::Where where = refusal_of(minimal_text + refused.text);
  EXPECT_GE(where.line, 6);
  EXPECT_EQ(where.key, refused.key);
  EXPECT_THAT(where.expected, HasSubstr(refused.expected));
}

INSTANTIATE_TEST_SUITE_P(
    Keys, RefusedModelError,
    ::testing::Values(
        Refused{"without_rms", "model_error: {mean: [0, 0, 0]}\n", "model_error.rms", "3 numbers"},
        Refused{"negative", "model_error: {rms: [1, -1, 0]}\n", "model_error.rms", "numbers >= 0"},
        Refused{"too_few", "model_error: {rms: [1, 1]}\n", "model_error.rms", "3 numbers"},
        Refused{"less_than_a_lower_norm", "model_error: {rms: [1, 1, 1], norm8: [1, 0.9, 1]}\n",
                "model_error.norm8", "at least the norms of lower order"},
        Refused{"norms_out_of_order",
                "model_error: {rms: [1, 1, 1], norm4: [2, 2, 2], norm8: [2, 1.9, 2]}\n",
                "model_error.norm8", "at least the norms of lower order"},
        Refused{"small_radius", "model_error: {rms: [3, 4, 0], radius: 4.9}\n",
                "model_error.radius", "at least 5"},
        Refused{"negative_radius", "model_error: {rms: [0, 0, 0], radius: -1}\n",
                "model_error.radius", "a number >= 0"},
        Refused{"covariance", "model_error: {rms: [1, 1, 1], covariance: [1, -1, 1]}\n",
                "model_error.covariance", "positive semidefinite"},
        Refused{"other_system", "model_error: {system: cart_pole, rms: [1, 1, 1]}\n",
                "model_error.system", "dubins"},
        Refused{"unknown_key", "model_error: {rms: [1, 1, 1], norm6: [1, 1, 1]}\n",
                "model_error.norm6", "norm4"},
        Refused{"period_without_rms",
                "model_error: {rms: [1, 1, 1], first: [{norm4: [1, 1, 1]}]}\n",
                "model_error.first.0.rms", "3 numbers"},
        Refused{"unknown_key_of_a_period",
                "model_error: {rms: [1, 1, 1], first: [{rms: [1, 1, 1], norm6: [1, 1, 1]}]}\n",
                "model_error.first.0.norm6", "norm4"},
        Refused{"first_is_no_list", "model_error: {rms: [1, 1, 1], first: {rms: [1, 1, 1]}}\n",
                "model_error.first", "a list"},
        Refused{"radius_below_the_offset",
                "model_error: {rms: [0, 0, 0], offset: [3, -4, 0], radius: 4.9}\n",
                "model_error.radius", "at least 5"},
        Refused{"no_file", "model_error: nowhere.yaml\n", "model_error", "the path of a YAML file"},
        Refused{"a_list", "model_error: [1, 2, 3]\n", "model_error", "a mapping"}),
    name_of);

}  // namespace scenario_model_error_test
}  // namespace qsmpc::harness
