// A reproduction as text: nothing is lost, and no content breaks a format.

#include <limits>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/reproduction/result.hpp"
#include "harness/reproduction/results_page.hpp"
#include "harness/reproduction/results_table.hpp"

namespace qsmpc::harness {
namespace results_test {

using ::testing::HasSubstr;
using ::testing::Not;

Reproduction example() {
  ExperimentResult experiment{.name = "table-9-9", .title = "Of |u| & <b>"};
  experiment.rows = {{.quantity = "time | of a plan",
                      .unit = "s",
                      .published = 20.0,
                      .here = 0.005,
                      .note = "a_note with *marks* | and <script>"},
                     {.quantity = "nothing published", .here = 3.0},
                     {.quantity = "nothing here", .published = 1.0}};
  experiment.claims = {{.statement = "this holds", .holds = true, .evidence = "1 < 2"},
                       {.statement = "this does not", .holds = false, .evidence = "2 < 1"}};
  experiment.remarks = {"A remark about <it>."};
  experiment.figures = {
      {.file = "figure-9-9.svg",
       .title = "A figure",
       .caption = "Of something",
       .panels = {Chart{.title = "A panel",
                        .x_label = "x",
                        .y_label = "y",
                        .series = {{.name = "a line", .x = {0.0, 1.0}, .y = {2.0, 3.0}}}}}}};
  Reproduction all{.version = "1.2.3",
                   .machine = {.processor = "a processor", .cores = 2, .compiler = "gcc 12"},
                   .seeds = 7,
                   .threads = 2};
  all.experiments.push_back(experiment);
  all.complete = true;
  return all;
}

TEST(ResultRow, ratio_is_what_is_here_over_what_is_published) {
  EXPECT_DOUBLE_EQ(*ratio_of({.quantity = "", .published = 4.0, .here = 1.0}), 0.25);
}

TEST(ResultRow, has_no_ratio_where_a_side_is_missing_or_zero) {
  EXPECT_FALSE(ratio_of({.quantity = "", .here = 1.0}));
  EXPECT_FALSE(ratio_of({.quantity = "", .published = 0.0, .here = 1.0}));
  EXPECT_FALSE(ratio_of({.quantity = "", .published = 1.0}));
}

TEST(ResultsJson, has_the_promised_keys_of_every_row) {
  const auto json = nlohmann::json::parse(results_json(example()));
  ASSERT_EQ(json["rows"].size(), 3U);
  const auto& row = json["rows"][0];
  EXPECT_EQ(row["experiment"], "table-9-9");
  EXPECT_EQ(row["quantity"], "time | of a plan");
  EXPECT_EQ(row["published"], 20.0);
  EXPECT_EQ(row["here"], 0.005);
  EXPECT_EQ(row["unit"], "s");
  EXPECT_DOUBLE_EQ(row["ratio"], 0.005 / 20.0);
  EXPECT_EQ(row["note"], "a_note with *marks* | and <script>");
}

TEST(ResultsJson, has_null_for_what_is_not_there) {
  const auto json = nlohmann::json::parse(results_json(example()));
  EXPECT_TRUE(json["rows"][1]["published"].is_null());
  EXPECT_TRUE(json["rows"][1]["ratio"].is_null());
  EXPECT_TRUE(json["rows"][2]["here"].is_null());
}

TEST(ResultsJson, says_which_claims_hold_and_on_what_machine) {
  const auto json = nlohmann::json::parse(results_json(example()));
  EXPECT_EQ(json["claims"][0]["holds"], true);
  EXPECT_EQ(json["claims"][1]["holds"], false);
  EXPECT_EQ(json["claims"][1]["evidence"], "2 < 1");
  EXPECT_EQ(json["machine"]["processor"], "a processor");
  EXPECT_EQ(json["seeds"], 7);
  EXPECT_EQ(json["experiments"][0]["figures"][0], "figure-9-9.svg");
}

TEST(ResultsTable, marks_the_claims_that_do_not_hold) {
  const std::string text = results_table(example());
  EXPECT_THAT(text, HasSubstr("[holds] this holds"));
  EXPECT_THAT(text, HasSubstr("[FAILS] this does not"));
}

TEST(ResultsTable, lines_up_whatever_characters_a_name_has) {
  Reproduction all = example();
  all.experiments[0].rows = {{.quantity = "W2²", .published = 1.0, .here = 2.0},
                             {.quantity = "W22", .published = 1.0, .here = 2.0}};
  const std::string text = results_table(all);
  const std::string first = text.substr(text.find("  W2²"));
  const std::string second = text.substr(text.find("  W22"));
  // "²" takes two bytes but one column.
  EXPECT_EQ(first.find('\n'), second.find('\n') + 1);
}

TEST(ResultsMarkdown, has_as_many_cells_in_every_row) {
  const std::string text = results_markdown(example(), "figures");
  EXPECT_THAT(text, HasSubstr("time \\| of a plan (s)"));
  EXPECT_THAT(text, HasSubstr("| nothing published | – | 3 | – |  |"));
  EXPECT_THAT(text, HasSubstr("a\\_note with \\*marks\\* \\| and \\<script>"));
  EXPECT_THAT(text, HasSubstr("![A figure](figures/figure-9-9.svg)"));
  EXPECT_THAT(text, HasSubstr("| this does not | **no** |"));
}

/// With a table of two steps, and a row outside of it.
Reproduction tabular() {
  ExperimentResult experiment{.name = "table-5-1", .title = "quality"};
  for (const int step : {0, 1}) {
    const std::string column = "step " + std::to_string(step);
    experiment.rows.push_back({.quantity = "samples",
                               .published = 1.0 + step,
                               .here = 1.5 + step,
                               .note = "the same",
                               .place = TablePlace{"W2", "samples", column}});
    experiment.rows.push_back({.quantity = "mixture",
                               .unit = "m",
                               .here = 0.25 + step,
                               .note = step == 0 ? "exact" : "",
                               .place = TablePlace{"W2", "mixture", column}});
  }
  experiment.rows.push_back({.quantity = "alone", .published = 4.0, .here = 2.0});
  experiment.rows.push_back(
      {.quantity = "late", .here = 7.0, .place = TablePlace{"W2", "late", "step 1"}});
  Reproduction all = example();
  all.experiments = {experiment};
  return all;
}

TEST(ResultsMarkdown, has_tables_in_the_thesiss_shape_and_lists_what_has_no_place) {
  EXPECT_THAT(results_markdown(tabular(), "figures"),
              HasSubstr("| W2 | step 0 | step 1 |\n"
                        "| --- | ---: | ---: |\n"
                        "| samples: published | 1 | 2 |\n"
                        "| samples: here | 1.5 | 2.5 |\n"
                        "| mixture (m) | 0.25 | 1.25 |\n"
                        "| late |  | 7 |\n"
                        "\n"
                        "- samples: the same\n"
                        "- mixture (m): exact (step 0)\n"
                        "\n"
                        "| quantity | published | here | ratio | note |\n"
                        "| --- | ---: | ---: | ---: | --- |\n"
                        "| alone | 4 | 2 | 0.5 |  |\n"));
}

TEST(ResultsTable, has_tables_in_the_thesiss_shape_and_lists_what_has_no_place) {
  EXPECT_THAT(results_table(tabular()), HasSubstr("  W2                  step 0  step 1\n"
                                                  "  samples: published       1       2\n"
                                                  "  samples: here          1.5     2.5\n"
                                                  "  mixture (m)           0.25    1.25\n"
                                                  "  late                             7\n"));
  EXPECT_THAT(results_table(tabular()), ::testing::ContainsRegex("\n  alone +4 +2 +0.5\n"));
}

TEST(ResultsTable, continues_below_if_a_table_is_too_wide) {
  Reproduction all = tabular();
  for (int step = 2; step < 20; ++step) {
    all.experiments[0].rows.push_back(
        {.quantity = "samples",
         .here = 100.0 * step,
         .place = TablePlace{"W2", "samples", "step " + std::to_string(step)}});
  }
  const std::string text = results_table(all);
  std::istringstream lines(text);
  int heads = 0;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 112U) << line;
    if (line.starts_with("  W2 ")) ++heads;
  }
  EXPECT_EQ(heads, 2);
  EXPECT_THAT(text, HasSubstr("step 19"));
}

TEST(ResultsPage, has_tables_in_the_thesiss_shape_and_lists_what_has_no_place) {
  const std::string page = results_page(tabular());
  EXPECT_THAT(page, HasSubstr("<th class=\"text\">W2</th><th>step 0</th><th>step 1</th>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"text\">samples: published</td><td>1</td><td>2</td>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"text\">late</td><td></td><td>7</td>"));
  EXPECT_THAT(page, HasSubstr("mixture (m): exact (step 0)"));
  EXPECT_THAT(page, HasSubstr("<td class=\"text\">alone</td><td>4</td><td>2</td><td>0.5</td>"));
}

TEST(ResultsPage, shows_rows_claims_and_figures_as_text) {
  const std::string page = results_page(example());
  EXPECT_THAT(page, HasSubstr("table-9-9"));
  EXPECT_THAT(page, HasSubstr("does not hold"));
  EXPECT_THAT(page, HasSubstr("A panel"));
  EXPECT_THAT(page, Not(HasSubstr("<script>")));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;"));
}

TEST(ResultsPage, says_that_more_is_to_come_while_it_does) {
  Reproduction all = example();
  EXPECT_THAT(results_page(all), Not(HasSubstr("Not all of the requested experiments")));
  all.complete = false;
  EXPECT_THAT(results_page(all), HasSubstr("Not all of the requested experiments"));
}

TEST(Machine, has_a_processor_cores_and_a_compiler) {
  const Machine machine = this_machine();
  EXPECT_FALSE(machine.processor.empty());
  EXPECT_GE(machine.cores, 1);
  EXPECT_THAT(machine.compiler, ::testing::AnyOf(HasSubstr("gcc "), HasSubstr("clang ")));
}

}  // namespace results_test
}  // namespace qsmpc::harness
