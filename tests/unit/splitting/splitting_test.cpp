#include "harness/splitting/splitting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/statistics/sample_statistics.hpp"
#include "harness/statistics/skewed_mean.hpp"
#include "models/random/random_numbers.hpp"

namespace qsmpc::harness {
namespace splitting_test {

using ::testing::ElementsAre;

constexpr double kKept = 0.9;  // share of a state kept by the next one
constexpr int kSteps = 10;
constexpr double kEvent = 10.4;  // above it is the event

/// x ← 0.9 x + w, w ~ N(0, 1), from 0, stopped at its event.
SplitPath walk(const PathSeeds& seeds) {
  SplitPath path;
  double x = 0.0;
  path.levels.push_back(x - kEvent);
  for (std::uint64_t step = 0; step < kSteps && path.levels.back() <= 0.0; ++step) {
    std::array<double, 1> noise{};
    models::standard_normals(
        {.seed = models::noise_seed_at(seeds.noise, seeds.seed, step), .step = step}, noise);
    x = kKept * x + noise[0];
    path.levels.push_back(x - kEvent);
  }
  return path;
}

/// The probability that a walk has its event, by recursion of the density of the walks without it
/// so far, on a fine grid (trapezoidal rule: the density is smooth and vanishes at one end, so its
/// error is far below the sampling errors here).
double true_probability() {
  constexpr int kPoints = 700;
  constexpr double kLow = -14.0;
  constexpr double kSpacing = (kEvent - kLow) / (kPoints - 1);
  const auto place = [](int n) { return kLow + kSpacing * n; };
  const auto density = [](double z) {
    return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
  };
  const auto tail = [](double z) { return 0.5 * std::erfc(z / std::numbers::sqrt2); };
  std::vector<double> alive(kPoints);
  for (int n = 0; n < kPoints; ++n) {
    alive[static_cast<std::size_t>(n)] =
        kSpacing * density(place(n)) * (n == 0 || n == kPoints - 1 ? 0.5 : 1.0);
  }
  double probability = tail(kEvent);
  for (int step = 2; step <= kSteps; ++step) {
    std::vector<double> next(kPoints, 0.0);
    for (int from = 0; from < kPoints; ++from) {
      const double mass = alive[static_cast<std::size_t>(from)];
      const double mean = kKept * place(from);
      probability += mass * tail(kEvent - mean);
      for (int to = 0; to < kPoints; ++to) {
        next[static_cast<std::size_t>(to)] += mass * density(place(to) - mean) * kSpacing *
                                              (to == 0 || to == kPoints - 1 ? 0.5 : 1.0);
      }
    }
    alive = std::move(next);
  }
  return probability;
}

SplitRun run_of(const SplitSettings& settings, std::uint64_t seed) {
  return split(settings, seed, [](const PathSeeds& seeds, bool) { return walk(seeds); }).value();
}

std::vector<double> estimates_of(const SplitSettings& settings, int runs) {
  std::vector<double> estimates;
  for (int n = 0; n < runs; ++n) {
    estimates.push_back(run_of(settings, static_cast<std::uint64_t>(n)).probability);
  }
  return estimates;
}

// Five standard errors: a false alarm once in a million if the seeds were not fixed.
void expect_unbiased(const std::vector<double>& estimates, double truth) {
  EXPECT_NEAR(mean_of(estimates), truth, 5.0 * standard_error_of(estimates));
  // And the estimates are accurate enough for this to be meaningful.
  EXPECT_LT(standard_error_of(estimates), 0.2 * truth);
}

TEST(Splitting, is_unbiased_for_a_probability_of_a_millionth) {
  const double truth = true_probability();
  EXPECT_NEAR(truth, 1e-6, 9e-7);
  expect_unbiased(estimates_of({.particles = 100}, 150), truth);
}

TEST(Splitting, is_unbiased_with_few_particles_of_which_many_are_given_up) {
  expect_unbiased(estimates_of({.particles = 20, .killed = 10}, 3000), true_probability());
}

TEST(Splitting, has_limits_that_cover_the_truth) {
  const double truth = true_probability();
  constexpr std::size_t kRuns = 15;
  constexpr std::size_t kIntervals = 40;
  const std::vector<double> estimates = estimates_of({.particles = 60}, kRuns * kIntervals);
  std::size_t missed = 0;
  for (std::size_t n = 0; n < kIntervals; ++n) {
    const auto begin = estimates.begin() + static_cast<std::ptrdiff_t>(n * kRuns);
    const RateInterval interval = skewed_mean_interval({begin, begin + kRuns}, 0.005);
    if (truth < interval.lower || truth > interval.upper) ++missed;
  }
  // More than three of 40 intervals at 99 % miss it once in a thousand runs.
  EXPECT_LE(missed, 3U);
}

TEST(Splitting, takes_a_small_part_of_what_plain_paths_take) {
  const SplitRun run = run_of({.particles = 100}, 1);
  // A few thousand paths for an event of one path in a million.
  EXPECT_LT(run.paths, 3000);
  EXPECT_GT(run.probability, 0.0);
  EXPECT_EQ(run.first_events, 0);
  EXPECT_EQ(run.first_instants, 100 * kSteps);
}

TEST(Splitting, finds_paths_that_have_the_event_when_they_are_driven_again) {
  const SplitRun run = run_of({.particles = 50}, 3);
  ASSERT_FALSE(run.events.empty());
  for (const SplitPath& path : run.events) {
    EXPECT_EQ(walk(path.seeds).levels, path.levels);
    EXPECT_GT(path.levels.back(), 0.0);
    // Ascending, each instant once.
    EXPECT_EQ(std::ranges::adjacent_find(path.seeds.noise, std::ranges::greater_equal(),
                                         &models::NoiseSeed::from),
              path.seeds.noise.end());
  }
}

TEST(Splitting, draws_other_first_paths_for_another_seed_and_begins_with_that_of_its_own) {
  std::set<std::uint64_t> seen;
  for (const std::uint64_t seed : {4U, 5U}) {
    std::vector<std::uint64_t> first;
    (void)split({.particles = 10}, seed, [&](const PathSeeds& seeds, bool is_first) {
      if (is_first) first.push_back(seeds.seed);
      return walk(seeds);
    });
    EXPECT_EQ(first.front(), seed);
    seen.insert(first.begin(), first.end());
  }
  EXPECT_EQ(seen.size(), 20U);
}

TEST(Splitting, gives_the_share_of_the_first_paths_where_the_event_is_common) {
  const auto run = split({.particles = 10, .killed = 5}, 1,
                         [](const PathSeeds& seeds, bool) -> std::optional<SplitPath> {
                           return SplitPath{.levels = {seeds.seed % 4 == 0 ? -1.0 : 1.0}};
                         });
  ASSERT_TRUE(run.has_value());
  EXPECT_EQ(run->levels, 0);
  EXPECT_EQ(run->paths, 10);
  EXPECT_DOUBLE_EQ(run->probability, 0.1 * static_cast<double>(run->first_events));
}

/// Integer levels: many are equal.
SplitPath stairs(const PathSeeds& seeds) {
  SplitPath path{.levels = {-4.0}};
  for (std::uint64_t step = 0; step < 6 && path.levels.back() <= 0.0; ++step) {
    std::array<std::uint64_t, 1> word{};
    models::random_words(
        {.seed = models::noise_seed_at(seeds.noise, seeds.seed, step), .step = step}, word);
    path.levels.push_back(path.levels.back() + (word[0] % 4 == 0 ? 1.0 : 0.0));
  }
  return path;
}

TEST(Splitting, is_unbiased_where_levels_are_the_same) {
  // At least five of six steps go up: C(6, 5) (1/4)⁵ (3/4) + (1/4)⁶.
  const double truth = 19.0 / 4096.0;
  std::vector<double> estimates;
  int extinct = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    const SplitRun run = split({.particles = 8}, seed, [](const PathSeeds& seeds, bool) {
                           return stairs(seeds);
                         }).value();
    estimates.push_back(run.probability);
    extinct += run.extinct ? 1 : 0;
  }
  expect_unbiased(estimates, truth);
  // Runs without an estimate count as 0, and there are some.
  EXPECT_GT(extinct, 0);
  EXPECT_EQ(std::ranges::count(estimates, 0.0), extinct);
}

TEST(Splitting, dies_out_where_no_path_comes_nearer) {
  const auto run = split({.particles = 5}, 1, [](const PathSeeds&, bool) {
    return SplitPath{.levels = {-3.0, -3.0}};
  });
  ASSERT_TRUE(run.has_value());
  EXPECT_TRUE(run->extinct);
  EXPECT_EQ(run->probability, 0.0);
  EXPECT_EQ(run->paths, 5);
}

TEST(Splitting, estimates_the_mean_of_a_value_of_all_paths_without_bias) {
  // How often a walk exceeds 3, by plain paths; most of these have no event.
  const auto above = [](const SplitPath& path) {
    return static_cast<double>(
        std::ranges::count_if(path.levels, [](double level) { return level > 3.0 - kEvent; }));
  };
  std::vector<double> plain;
  for (std::uint64_t seed = 0; seed < 20'000; ++seed) plain.push_back(above(walk({.seed = seed})));
  std::vector<double> estimates;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    estimates.push_back(split({.particles = 50}, 1000 + seed,
                              [&](const PathSeeds& seeds, bool) {
                                SplitPath path = walk(seeds);
                                path.value = above(path);
                                return path;
                              })
                            .value()
                            .value);
  }
  const double error = std::hypot(standard_error_of(plain), standard_error_of(estimates));
  EXPECT_NEAR(mean_of(estimates), mean_of(plain), 4.5 * error);
  EXPECT_LT(error, 0.05 * mean_of(plain));
}

TEST(Splitting, gives_up_at_the_floor) {
  const SplitRun run = run_of({.particles = 20, .floor = 1e-3}, 1);
  EXPECT_TRUE(run.below_floor);
  EXPECT_EQ(run.probability, 0.0);
  EXPECT_LT(run.paths, 200);
}

TEST(Splitting, ends_when_it_is_told_to_stop) {
  int left = 30;
  const auto run =
      split({.particles = 20}, 1, [&](const PathSeeds& seeds, bool) -> std::optional<SplitPath> {
        if (--left == 0) return std::nullopt;
        return walk(seeds);
      });
  EXPECT_FALSE(run.has_value());
  EXPECT_EQ(left, 0);
}

TEST(Splitting, refuses_paths_that_are_not_repeated) {
  int calls = 0;
  EXPECT_THROW((void)split({.particles = 20}, 1,
                           [&](const PathSeeds& seeds, bool) {
                             SplitPath path = walk(seeds);
                             path.levels.front() -= 1e-12 * ++calls;
                             return path;
                           }),
               PathNotRepeated);
}

TEST(Splitting, refuses_invalid_levels_and_settings) {
  const auto none = [](const PathSeeds&, bool) { return SplitPath{}; };
  const auto nan = [](const PathSeeds&, bool) {
    return SplitPath{.levels = {std::numeric_limits<double>::quiet_NaN()}};
  };
  EXPECT_THROW((void)split({.particles = 5}, 1, none), std::invalid_argument);
  EXPECT_THROW((void)split({.particles = 5}, 1, nan), std::invalid_argument);
  EXPECT_THROW((void)split({.particles = 1}, 1, none), std::invalid_argument);
  EXPECT_THROW((void)split({.particles = 5, .killed = 5}, 1, none), std::invalid_argument);
}

TEST(NoiseSeeds, hold_from_their_period_on) {
  const std::vector<models::NoiseSeed> seeds{{.from = 2, .seed = 20}, {.from = 5, .seed = 50}};
  std::vector<std::uint64_t> found;
  for (const std::uint64_t period : {0U, 1U, 2U, 4U, 5U, 9U}) {
    found.push_back(models::noise_seed_at(seeds, 7, period));
  }
  EXPECT_THAT(found, ElementsAre(7U, 7U, 20U, 20U, 50U, 50U));
}

}  // namespace splitting_test
}  // namespace qsmpc::harness
