#include "harness/report/figure_files.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "tests/support/example_trace.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/report/page_checks.hpp"

namespace qsmpc::harness {
namespace figure_files_test {

using testing::TemporaryFolder;

FigureFile figure(const std::string& name) {
  return {.name = name,
          .panels = {Chart{.title = name,
                           .x_label = "x",
                           .y_label = "y",
                           .series = {{.name = "line", .x = {1, 2}, .y = {1, 2}}}}}};
}

std::set<std::string> names_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

TEST(FigureName, is_made_of_the_first_words_of_the_title) {
  EXPECT_EQ(figure_name("Certificates: bounds of the probability"), "certificates");
  EXPECT_EQ(figure_name("Error budget at the last stage (8)"), "error-budget");
  EXPECT_EQ(figure_name("Expected cost of the plan, by part"), "expected-cost");
  EXPECT_EQ(figure_name("Input: yaw rate"), "input-yaw-rate");
  EXPECT_EQ(figure_name("Input: ../v (%)"), "input-v");
  EXPECT_EQ(figure_name("W₂"), "w");
  EXPECT_EQ(figure_name(""), "figure");
}

TEST(EpisodeFigures, have_the_promised_names) {
  std::vector<std::string> names;
  for (const FigureFile& figure : episode_figures(EpisodeView(testing::example_trace()))) {
    names.push_back(figure.name);
    EXPECT_EQ(figure.panels.size(), 1U);
  }
  EXPECT_EQ(names.front(), "map");
  const std::set<std::string> found(names.begin(), names.end());
  EXPECT_EQ(found.size(), names.size()) << "each name once";
  for (const char* name : {"certificates", "clearance", "input-yaw-rate", "solve-time",
                           "expected-cost", "error-budget"}) {
    EXPECT_TRUE(found.contains(name)) << name;
  }
}

TEST(WriteFigures, leaves_an_svg_and_a_pdf_of_each) {
  const TemporaryFolder folder;
  const auto paths = write_figures({figure("one"), figure("two")}, folder.path());
  EXPECT_EQ(names_in(folder.path() + "/figures"),
            (std::set<std::string>{"captions.txt", "one.pdf", "one.svg", "two.pdf", "two.svg"}));
  ASSERT_EQ(paths.size(), 5U);
  EXPECT_EQ(paths[1], folder.path() + "/figures/one.pdf");
}

TEST(WriteFigures, puts_titles_and_notes_into_the_captions_where_they_are_not_drawn) {
  const Chart chart{.title = "Least <clearance>",
                    .note = "Of 3 drives.",
                    .x_label = "",
                    .y_label = "",
                    .series = {{.name = "one", .x = {1, 2}, .y = {1, 2}}}};
  const TemporaryFolder folder;
  (void)write_figures({{.name = "both", .panels = {chart, chart}}}, folder.path(),
                      {.titles = false});
  const auto text = [&](const char* name) {
    std::ifstream file(folder.path() + "/figures/" + name);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_EQ(text("captions.txt"),
            "both\n  (a) Least <clearance>. Of 3 drives.\n  (b) Least <clearance>. Of 3 drives.\n");
  EXPECT_FALSE(testing::contains(text("both.svg"), ">Least"));
}

TEST(WriteFigures, if_one_cannot_be_written_none_gets_its_final_name) {
  const TemporaryFolder folder;
  EXPECT_THROW((void)write_figures({figure("one"), figure("no/two")}, folder.path()), IoError);
  EXPECT_TRUE(names_in(folder.path() + "/figures").empty());
}

}  // namespace figure_files_test
}  // namespace qsmpc::harness
