#include "harness/report/comparison_page.hpp"

#include <filesystem>
#include <limits>

#include <gtest/gtest.h>
#include <unistd.h>

#include "harness/mismatch/comparison_file.hpp"
#include "harness/mismatch/comparison_table.hpp"
#include "harness/report/comparison_charts.hpp"
#include "harness/report/comparison_verdict.hpp"
#include "tests/unit/mismatch/mismatch_fixture.hpp"
#include "tests/unit/report/page_checks.hpp"

namespace qsmpc::harness {
namespace comparison_page_test {

using testing::contains;
using testing::occurrences;
using testing::short_scenario;
using testing::tag_problem;

Comparison example() {
  ComparisonOptions options;
  options.plants = {"analytic", "mujoco_car"};
  options.episodes = 2;
  options.paths = 40;
  return *compare_plants(testing::short_scenario(), options);
}

TEST(ComparisonPage, is_the_same_byte_for_byte_when_made_again_from_the_file) {
  const Comparison comparison = example();
  std::string name = ::testing::TempDir() + "comparison_page_XXXXXX";
  const std::string folder = ::mkdtemp(name.data());
  write_comparison(comparison, {}, folder);
  EXPECT_TRUE(comparison_page(comparison) == comparison_page(read_comparison(folder)));
  std::filesystem::remove_all(folder);
}

TEST(ComparisonPage, has_all_parts_and_is_well_formed) {
  const std::string page = comparison_page(example());
  EXPECT_EQ(testing::tag_problem(page.substr(page.find("<html"))), "");
  for (const char* part :
       {"No certificate is exceeded on any plant", "Farthest from the model: mujoco_car",
        "<h2>Closed loop</h2>", "Certificates without model error",
        "Covariance of the residual: mujoco_car",
        "It matches the model except for rounding, which is at most",
        "W₂ between the predicted measure and the plant", "Divergence from the model: y",
        "Numbers by stage: mujoco_car", "× real time", "every default filled in", "horizon: 3"}) {
    EXPECT_TRUE(testing::contains(page, part)) << part;
  }
  EXPECT_FALSE(testing::contains(page, "<script"));
  EXPECT_FALSE(testing::contains(page, "http://"));
  EXPECT_FALSE(testing::contains(page, ">nan<"));
  EXPECT_FALSE(testing::contains(page, ">inf<"));
  EXPECT_EQ(testing::occurrences(page, "tabindex=\"0\""), testing::occurrences(page, "<table"));
  EXPECT_EQ(
      testing::occurrences(page, "role=\"region\""),
      testing::occurrences(page, "aria-label=\"") - testing::occurrences(page, "role=\"img\""));
}

TEST(ComparisonPage, has_no_tables_or_charts_of_rounding_errors) {
  Comparison comparison = example();
  const std::string page = comparison_page(comparison);
  EXPECT_FALSE(testing::contains(page, "aria-label=\"One period, by state: analytic\""));
  EXPECT_TRUE(testing::contains(page, "aria-label=\"One period, by state: mujoco_car\""));
  EXPECT_FALSE(
      testing::contains(page, "aria-label=\"Divergence from the model, by stage: analytic"));
  EXPECT_TRUE(
      testing::contains(page, "aria-label=\"Divergence from the model, by stage: mujoco_car"));
  comparison.plants.pop_back();
  EXPECT_FALSE(testing::contains(comparison_page(comparison), "Divergence from the model"));
  EXPECT_FALSE(testing::contains(comparison_page(comparison), "One-step residual"));
}

TEST(ComparisonPage, the_chart_of_residuals_stands_beside_their_tables) {
  const std::string page = comparison_page(example());
  const std::size_t stack = page.find("<div class=\"stack residuals\">");
  ASSERT_NE(stack, std::string::npos);
  const std::size_t table = page.find("One period, by state: mujoco_car", stack);
  const std::size_t chart = page.find("One-step residual", stack);
  EXPECT_LT(table, chart);
  EXPECT_EQ(page.substr(table, chart - table).find("<h2>"), std::string::npos);
}

TEST(ComparisonPage, says_first_which_certificates_are_exceeded_and_where) {
  Comparison comparison = example();
  PlantComparison& car = comparison.plants[1];
  car.exceeded_stages = {1, 2, 3};
  car.closed_loop.p_value = 1e-4;
  const PageVerdict verdict = comparison_verdict(comparison);
  EXPECT_EQ(verdict.mood, PageMood::kBad);
  EXPECT_EQ(verdict.title, "Certificates are exceeded on 1 of 2 plants");
  EXPECT_EQ(verdict.sentences[0],
            "On mujoco_car at stages 1 to 3 of the plan and in closed loop (p = 1 × 10⁻⁴).");
  const std::string page = comparison_page(comparison);
  EXPECT_LT(page.find("class=\"outcome bad\""), page.find("<h2>"));
  EXPECT_TRUE(testing::contains(page, "<strong>1 to 3</strong>"));
}

TEST(ComparisonPage, says_that_certificates_along_the_plan_are_bounds_and_those_of_drives_are_not) {
  Comparison comparison = example();
  EXPECT_FALSE(testing::contains(comparison_page(comparison), "no bound"));
  comparison.scenario.disturbance.sensor = Eigen::MatrixXd::Identity(3, 3);
  const std::string page = comparison_page(comparison);
  EXPECT_TRUE(testing::contains(page, "Certificates of the drives are not bounds"));
  // The sum over the periods of drives, and no table of stages.
  EXPECT_EQ(testing::occurrences(page, ">certified: no bound<"), 1U);
  EXPECT_TRUE(testing::contains(page, ">certified<"));
}

TEST(ComparisonPage, says_before_all_else_that_drives_were_unsafe) {
  Comparison comparison = example();
  EXPECT_FALSE(unsafe_verdict(comparison).has_value());
  ClosedLoop& loop = comparison.plants[1].closed_loop;
  loop.outcomes = {{"collision", 1}, {"reached", 1}};
  loop.unsafe = 1;
  const std::string page = comparison_page(comparison);
  const std::size_t unsafe = page.find("✕ 1 of 4 drives were unsafe");
  ASSERT_NE(unsafe, std::string::npos);
  EXPECT_LT(unsafe, page.find("✓ No certificate is exceeded on any plant"));
  EXPECT_TRUE(testing::contains(page, "On mujoco_car: 1 of 2 (1 collided, 0 left the bounds)."));
  EXPECT_TRUE(
      testing::contains(page, "<td>1</td><td><strong class=\"alarm\">1</strong></td><td>0</td>"));
  EXPECT_TRUE(testing::contains(
      comparison_table(comparison),
      "        2           1           1             0           0           0\n"));
}

TEST(ComparisonVerdict, names_the_farthest_plant) {
  Comparison comparison = example();
  PlantComparison& car = comparison.plants[1];
  for (HorizonStage& stage : car.horizon) stage.divergence_rmse = Eigen::Vector3d(3, 4, 0);
  EXPECT_TRUE(testing::contains(comparison_verdict(comparison).sentences[0], "mujoco_car"));
  EXPECT_TRUE(testing::contains(comparison_verdict(comparison).sentences[0], "up to 5 "));
  for (HorizonStage& stage : car.horizon) {
    stage.divergence_rmse.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  EXPECT_TRUE(
      testing::contains(comparison_verdict(comparison).sentences[0], "broke on every path"));
  car = comparison.plants[0];
  EXPECT_EQ(comparison_verdict(comparison).sentences[0],
            "Every plant matches the model except for rounding.");
}

TEST(ComparisonVerdict, speaks_of_a_single_plant_as_one) {
  Comparison comparison = example();
  comparison.plants.erase(comparison.plants.begin());
  const std::string page = comparison_page(comparison);
  for (const char* words :
       {": a plant compared with the model</h1>", "1 plant compared with the model",
        "✓ No certificate is exceeded<", "Under the plan the paths of mujoco_car diverge"}) {
    EXPECT_TRUE(testing::contains(page, words)) << words;
  }
  for (const char* words : {"1 plants", "any plant", "of each ·", "Farthest"}) {
    EXPECT_FALSE(testing::contains(page, words)) << words;
  }
  comparison.plants.front().exceeded_stages = {2};
  EXPECT_EQ(comparison_verdict(comparison).title, "Certificates are exceeded");
  comparison.plants = {example().plants.front()};
  EXPECT_EQ(comparison_verdict(comparison).sentences[0],
            "analytic matches the model except for rounding.");
}

TEST(ComparisonVerdict, stages_in_a_row_are_a_range) {
  EXPECT_EQ(stages_text({2}), "2");
  EXPECT_EQ(stages_text({1, 2}), "1, 2");
  EXPECT_EQ(stages_text({1, 3, 4, 5, 7, 8}), "1, 3 to 5, 7, 8");
  EXPECT_EQ(stages_text({}), "");
}

TEST(ComparisonPage, texts_are_escaped) {
  Comparison comparison = example();
  comparison.plants[1].name = "<script>alert(1)</script>";
  comparison.scenario.name = "\"><b>";
  const std::string page = comparison_page(comparison);
  EXPECT_FALSE(testing::contains(page, "<script"));
  EXPECT_FALSE(testing::contains(page, "<b>"));
  EXPECT_EQ(testing::tag_problem(page.substr(page.find("<html"))), "");
}

TEST(ComparisonFigures, stages_without_an_unsafe_path_stand_at_zero) {
  Comparison comparison = example();
  PlantComparison& car = comparison.plants[1];
  for (HorizonStage& stage : car.horizon) stage.unsafe = 0;
  car.horizon[1].unsafe = 10;
  car.horizon[1].unsafe_limits = {.lower = 0.1, .upper = 0.4};
  const Chart chart = comparison_figures(comparison)[kCertificateFigure].charts[1];
  ASSERT_EQ(chart.series.size(), 3U);
  EXPECT_TRUE(chart.y_has_zero);
  EXPECT_EQ(chart.series[1].y, std::vector<double>(car.horizon.size() - 1, 0.0));
  EXPECT_EQ(chart.series[1].x.size(), car.horizon.size() - 1);
  EXPECT_EQ(chart.series[2].y, (std::vector<double>{0.25}));
  EXPECT_EQ(chart.series[2].lower, (std::vector<double>{0.1}));
}

}  // namespace comparison_page_test
}  // namespace qsmpc::harness
