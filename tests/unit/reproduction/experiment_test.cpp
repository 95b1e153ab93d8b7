// The experiments by name, each run once with few drives; docs/results.md says what they measure.

#include "harness/reproduction/experiment.hpp"

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "harness/figures/svg_figure.hpp"
#include "harness/reproduction/published_way.hpp"
#include "tests/support/effort.hpp"

namespace qsmpc::harness {
namespace experiment_test {

using namespace testing;

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const ExperimentEntry& entry : experiments()) names.push_back(entry.name);
  return names;
}

TEST(Experiments, are_all_meant_by_all_and_by_nothing) {
  EXPECT_EQ(experiments_named({}), all_names());
  EXPECT_EQ(experiments_named({"all"}), all_names());
}

TEST(Experiments, are_named_by_their_figures_too_each_once_and_in_order) {
  EXPECT_THAT(experiments_named({"figure-5-2", "table-5-1", "table-5-2"}),
              ElementsAre("table-5-1", "table-5-2"));
}

TEST(Experiments, of_another_name_are_refused_with_those_that_exist) {
  try {
    static_cast<void>(experiments_named({"table-5-9"}));
    FAIL() << "table-5-9 was taken";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where().found, "table-5-9");
    EXPECT_THAT(error.where().expected, HasSubstr("table-5-1"));
  }
}

TEST(Experiments, have_names_of_their_own) {
  std::set<std::string> names;
  for (const ExperimentEntry& entry : experiments()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    for (const std::string& alias : entry.aliases) {
      EXPECT_TRUE(names.insert(alias).second) << alias;
    }
  }
}

constexpr const char* kArrival = "target reached in";  // not within a few periods

bool is_about(const ResultRow& row, const std::string& what) {
  return row.quantity.find(what) != std::string::npos ||
         (row.place && (row.place->table.find(what) != std::string::npos ||
                        row.place->row.find(what) != std::string::npos));
}

/// Checks that the number is possible for its kind of row.
void expect_possible(const ResultRow& row) {
  EXPECT_TRUE(std::isfinite(row.here)) << row.quantity;
  EXPECT_GE(row.here, 0.0) << row.quantity;
  if (is_about(row, "P(unsafe)") || is_about(row, "drives that")) {
    EXPECT_LE(row.here, 1.0) << row.quantity;
  }
  if (row.unit != "s" && row.unit != "ms") return;
  const double seconds = row.unit == "s" ? row.here : 1e-3 * row.here;
  EXPECT_GT(seconds, 1e-7) << row.quantity;
  EXPECT_LT(seconds, 600.0) << row.quantity;
}

class EveryExperiment : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryExperiment, fills_each_row_that_has_a_published_value) {
  Laboratory laboratory({.seeds = 2, .arrival_seeds = 3, .step_limit = 3, .truth_samples = 20'000});
  const ExperimentResult result = do_experiment(GetParam(), laboratory);
  EXPECT_EQ(result.name, GetParam());
  EXPECT_FALSE(result.rows.empty());
  std::set<std::string> quantities;
  for (const ResultRow& row : result.rows) {
    EXPECT_TRUE(quantities.insert(row.quantity).second) << row.quantity << " stands there twice";
    if (row.quantity.find(kArrival) != std::string::npos) continue;
    expect_possible(row);
  }
  std::set<std::string> files;
  for (const ResultFigure& figure : result.figures) {
    EXPECT_TRUE(files.insert(figure.file).second) << figure.file;
    EXPECT_FALSE(figure.panels.empty()) << figure.file;
    const std::string svg = svg_figure(figure.panels);
    EXPECT_THAT(svg, Not(HasSubstr("No finite values to draw."))) << figure.file;
    EXPECT_THAT(svg, Not(HasSubstr("nan"))) << figure.file;
  }
  for (const Claim& claim : result.claims) EXPECT_FALSE(claim.evidence.empty()) << claim.statement;
}

INSTANTIATE_TEST_SUITE_P(Thesis, EveryExperiment, ::testing::ValuesIn(all_names()),
                         [](const ::testing::TestParamInfo<std::string>& entry) {
                           std::string name = entry.param;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

/// The number in this row and column of a table in the thesis's own format.
double number_of(const ExperimentResult& result, const std::string& row,
                 const std::string& column) {
  for (const ResultRow& each : result.rows) {
    if (each.place && each.place->row == row && each.place->column == column) return each.here;
  }
  ADD_FAILURE() << "no " << row << " of " << column;
  return std::numeric_limits<double>::quiet_NaN();
}

TEST(Experiments, of_five_steps_count_points_and_lose_the_spread_as_compressions_do) {
  Laboratory laboratory({.seeds = 2, .truth_samples = 20'000});
  const ExperimentResult steps = do_experiment("figure-4-2", laboratory);
  const std::string all = "nothing compressed";
  const std::string soft = "the thesis’s soft compression";
  const std::string mixture = "this program’s mixture";
  // A hundred points, times eight noise points in each of five steps.
  EXPECT_EQ(number_of(steps, "points", all), 100.0 * std::pow(8.0, 5.0));
  const double everything = number_of(steps, "variance over the true one", all);
  for (const std::string& compressed : {soft, std::string("hard compression"), mixture}) {
    EXPECT_EQ(number_of(steps, "points", compressed), 100.0) << compressed;
    EXPECT_LT(number_of(steps, "distance of the mean from the true one", compressed), 0.01);
    // Group means vary less than the grouped points; a mixture keeps the variance its points stand
    // for.
    const double kept = number_of(steps, "variance over the true one", compressed);
    if (compressed == mixture) {
      EXPECT_NEAR(kept, 1.0, 0.05);
    } else {
      EXPECT_LT(kept, everything) << compressed;
    }
  }
  EXPECT_LT(number_of(steps, "variance over the true one", soft), 0.5 * everything);
}

/// With --slow as `qsmpc reproduce` runs them, otherwise few and short.
bool slow() { return by_effort(false, false, true); }

LaboratoryOptions options_of_claims() {
  if (slow()) return {.seeds = 50};
  return {.seeds = 3, .step_limit = 25, .truth_samples = 400'000};
}

void expect_claims(const std::string& experiment, const std::string& part) {
  Laboratory laboratory(options_of_claims());
  int found = 0;
  for (const Claim& claim : do_experiment(experiment, laboratory).claims) {
    if (claim.statement.find(part) == std::string::npos) continue;
    EXPECT_TRUE(claim.holds) << claim.statement << ": " << claim.evidence;
    ++found;
  }
  EXPECT_GT(found, 0) << part;
}

TEST(Claims, points_are_nearer_to_many_samples_than_few_samples_at_every_step) {
  expect_claims("table-5-1", "are nearer to 2,000 samples");
}

TEST(Claims, closed_loop_beats_open_loop_on_the_certified_probability) {
  expect_claims("table-5-2", slow() ? "Closed loop beats open loop on the certified probability"
                                    : "are unsafe less often than plans in open loop");
}

TEST(Claims, more_points_tighten_what_is_made_from_points) {
  if (slow()) expect_claims("table-5-4", "More points lower");
  expect_claims("table-5-5", "More points lower the published");
}

TEST(Claims, the_certificate_in_force_is_never_below_the_truth) {
  expect_claims("algorithm-4", "certificate in force is never below");
}

TEST(Laboratory, drives_the_same_on_any_number_of_threads) {
  const Variant variant{.scenario = "dubins_turn", .overrides = {"limit.steps=5"}};
  Laboratory one({.seeds = 4, .threads = 1});
  Laboratory two({.seeds = 4, .threads = 2});
  const Sample& first = one.sample(variant);
  const Sample& second = two.sample(variant);
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_EQ(first.episodes[n].states, second.episodes[n].states) << n;
    EXPECT_EQ(first.episodes[n].next_step, second.episodes[n].next_step) << n;
    EXPECT_EQ(first.episodes[n].seed, n);
  }
  EXPECT_NE(first.episodes[0].states, first.episodes[1].states);
}

TEST(Laboratory, runs_a_drive_once_that_is_requested_twice) {
  const Variant variant{.scenario = "dubins_turn", .overrides = {"limit.steps=2"}};
  Laboratory laboratory({.seeds = 2});
  const Sample& first = laboratory.sample(variant);
  EXPECT_EQ(&laboratory.sample(variant), &first);
  EXPECT_NE(&laboratory.sample({.scenario = "dubins_turn", .overrides = {"limit.steps=3"}}),
            &first);
}

TEST(Reproduce, keeps_what_is_finished_when_it_is_stopped) {
  bool stop = false;
  Laboratory laboratory({.seeds = 2, .should_stop = [&] { return stop; }});
  const Reproduction all = reproduce({"figure-4-1", "figure-4-2"}, laboratory,
                                     [&](const Reproduction&) { stop = true; });
  EXPECT_THAT(all.experiments, SizeIs(1));
  EXPECT_EQ(all.experiments.front().name, "figure-4-1");
  EXPECT_FALSE(all.complete);
}

TEST(Reproduce, is_complete_when_all_that_was_asked_for_is_done) {
  Laboratory laboratory({.seeds = 2});
  const Reproduction all = reproduce({"figure-4-1"}, laboratory, {});
  EXPECT_TRUE(all.complete);
  EXPECT_EQ(all.seeds, 2);
}

TEST(PublishedWay, is_below_the_truth_beside_a_wall_and_in_an_obstacle) {
  controller::SafeSet room = controller::unbounded_safe_set(2);
  room.bounds.lower << 0.0, 0.0;
  room.bounds.upper << 10.0, 10.0;
  room.obstacles.push_back(
      controller::Box{.lower = Eigen::Vector2d(4.0, 4.0), .upper = Eigen::Vector2d(6.0, 6.0)});
  controller::DiscreteMeasure inside{.locations = controller::Points(2, 1),
                                     .weights = Eigen::VectorXd::Ones(1)};
  inside.locations << 5.0, 5.0;
  const WorstCase in_obstacle = worst_cases(inside, room, {.sound = 0.1, .published = 0.1});
  EXPECT_LT(in_obstacle.published, 0.1);
  EXPECT_EQ(in_obstacle.distance, 1.0);
  EXPECT_EQ(in_obstacle.sound, 1.0);

  controller::DiscreteMeasure near_wall = inside;
  near_wall.locations << 0.1, 5.0;  // 0.1 from the nearest wall
  const WorstCase at_wall = worst_cases(near_wall, room, {.sound = 0.05, .published = 0.05});
  EXPECT_NEAR(at_wall.sound, 0.25, 1e-12);
  EXPECT_NEAR(at_wall.distance, 0.5, 1e-12);
  EXPECT_LT(at_wall.published, 0.02);
}

TEST(PublishedWay, of_a_drive_has_the_sound_value_of_its_certificates) {
  Laboratory laboratory({.seeds = 1});
  const Variant variant{.scenario = "dubins_turn",
                        .overrides = {"limit.steps=4", "controller.propagator=compressed"}};
  const Sample& sample = laboratory.sample(variant);
  const std::vector<NextStepView> views = next_step_views(sample.first);
  ASSERT_THAT(views, SizeIs(4));
  for (std::size_t k = 0; k < views.size(); ++k) {
    EXPECT_NEAR(views[k].compressed.sound, sample.episodes[0].particles[k], 1e-12) << k;
    EXPECT_NEAR(views[k].compressed.published, sample.episodes[0].published[k], 1e-12) << k;
    EXPECT_GE(views[k].compressed.distance, views[k].compressed.sound) << k;
  }
}

}  // namespace experiment_test
}  // namespace qsmpc::harness
