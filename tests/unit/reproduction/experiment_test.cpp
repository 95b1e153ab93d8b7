// The experiments by name, each done once with few drives; what they measure is in docs/results.md.

#include "harness/reproduction/experiment.hpp"

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/errors.hpp"
#include "harness/reproduction/published_way.hpp"
#include "tests/support/effort.hpp"

namespace qsmpc::harness {
namespace experiment_test {

using namespace testing;

using ::testing::ElementsAre;
using ::testing::HasSubstr;
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
    EXPECT_TRUE(std::isfinite(row.here)) << row.quantity;
  }
  std::set<std::string> files;
  for (const ResultFigure& figure : result.figures) {
    EXPECT_TRUE(files.insert(figure.file).second) << figure.file;
    EXPECT_FALSE(figure.panels.empty()) << figure.file;
  }
  for (const Claim& claim : result.claims) EXPECT_FALSE(claim.evidence.empty()) << claim.statement;
}

INSTANTIATE_TEST_SUITE_P(Thesis, EveryExperiment, ::testing::ValuesIn(all_names()),
                         [](const ::testing::TestParamInfo<std::string>& entry) {
                           std::string name = entry.param;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

/// With --slow as `qsmpc reproduce` does them, else few and short.
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

TEST(Laboratory, drives_once_what_is_asked_for_twice) {
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
