// No certificate and no W2 bound is below the truth: random problems, every stage, every kind of
// bound, against simulated paths of the model under the same policy.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <boost/math/distributions/binomial.hpp>
#include <gtest/gtest.h>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "tests/property/marginal_w2.hpp"
#include "tests/property/random_problem.hpp"
#include "tests/support/effort.hpp"

namespace qsmpc::controller {
namespace certificate_soundness_test {

using namespace testing;

const int kPaths = by_effort(20000, 50000, 100000);
constexpr int kShards = 8;  // so that the test runner can use several cores
// Number of paths compared with the particles: each coordinate is sorted.
constexpr int kSorted = 10000;

int problem_count() { return by_effort(504, 504, 10000); }

/// Clopper–Pearson: the probability that the truth is below this in any of all comparisons together
/// is at most 1e-3; there are at most 7 kinds of bounds and 8 stages per problem.
double lower_limit(int successes) {
  const double significance = 1e-3 / (7.0 * 8.0 * problem_count());
  if (successes == 0) return 0.0;
  return boost::math::binomial_distribution<>::find_lower_bound_on_p(kPaths, successes,
                                                                     significance);
}

/// Results of the comparisons of a shard.
struct Tally {
  int stages = 0;
  int informative = 0;   // truth in 1e-3 … 0.5
  int nontrivial = 0;    // certificate below one there
  int late_closed = 0;   // of these, at stages from 2 on in closed loop
  int conditioned = 0;   // of these, with C5 the least and below 0.9 times C1 … C4
  int thesis_below = 0;  // the thesis's value is significantly below the truth
  int finite_w2 = 0;
  int bodies = 0;  // nontrivial certificates of bodies with discs off their position
  std::map<std::string, int> systems;  // nontrivial certificates by system
};

void compare(const StageCertificate& certificate, int unsafe_paths, const std::string& where,
             Tally& tally) {
  const double least = lower_limit(unsafe_paths);
  EXPECT_GE(certificate.of("c1"), least) << "C1 " << where;
  EXPECT_GE(certificate.of("c2"), least) << "C2 " << where;
  EXPECT_GE(certificate.of("c3"), least) << "C3 " << where;
  EXPECT_GE(certificate.of("c4"), least) << "C4 " << where;
  EXPECT_GE(certificate.of("c5"), least) << "C5 " << where;
  EXPECT_GE(certificate.value, least) << "value " << where;
  EXPECT_LE(certificate.value, 1.0) << where;
  ++tally.stages;
  if (certificate.of("thesis") < least) ++tally.thesis_below;
}

/// The least of C1 … C4.
double without_conditioning(const StageCertificate& certificate) {
  return std::min(
      {certificate.of("c1"), certificate.of("c2"), certificate.of("c3"), certificate.of("c4")});
}

void compare_w2(const StageBudget& budget, const DiscreteMeasure& particles, const Points& states,
                const std::string& where, Tally& tally) {
  if (!std::isfinite(budget.total)) return;
  ++tally.finite_w2;
  const Points draws = states.leftCols(kSorted);
  for (Eigen::Index axis = 0; axis < particles.dim(); ++axis) {
    EXPECT_GE(budget.total + sampling_w2(draws, axis), marginal_w2(particles, draws, axis))
        << "W2 " << where << ", coordinate " << axis;
  }
}

void check_problem(const Problem& problem, const std::string& name, Generator& generator,
                   Tally& tally) {
  Planner planner(*problem.dynamics, problem.settings);
  const Plan& plan = planner.plan(problem.belief);
  const PredictedMotion motion = motion_of(planner, problem.belief, plan);
  const std::vector<StageBudget> budgets = error_budget(motion);
  const std::vector<StageCertificate> certificates =
      certify(motion, problem.settings.safe_set, budgets, CertificateEffort::kEvery);
  std::vector<Points> states;
  const UnsafeCounts truth =
      simulate(motion, problem.settings.safe_set, kPaths, generator, &states);
  ASSERT_EQ(certificates.size(), truth.stages.size());
  for (std::size_t k = 0; k < certificates.size(); ++k) {
    const std::string where = name + ", stage " + std::to_string(k + 1);
    compare(certificates[k], truth.stages[k], where, tally);
    compare_w2(budgets[k + 1], plan.prediction.stages[k + 1], states[k], where, tally);
    const double rate = static_cast<double>(truth.stages[k]) / kPaths;
    if (rate < 1e-3 || rate > 0.5) continue;
    ++tally.informative;
    if (certificates[k].value >= 1.0) continue;
    ++tally.nontrivial;
    if (certificates[k].value < 0.9 * without_conditioning(certificates[k])) ++tally.conditioned;
    ++tally.systems[problem.system];
    if (k > 0 && problem.settings.closed_loop) ++tally.late_closed;
    if (UnsafeSet(problem.settings.safe_set).reach() > 0.0) ++tally.bodies;
  }
  EXPECT_GE(horizon_bound(certificates), lower_limit(truth.any)) << name;
  // With the effort used for control they are also bounds, and little larger.
  const std::vector<StageCertificate> quick = certify(motion, problem.settings.safe_set, budgets);
  const SafeSet& safe_set = problem.settings.safe_set;
  const auto discs = std::max<std::size_t>(1, safe_set.body.discs.size());
  const double parts =
      2.0 * static_cast<double>(discs * (safe_set.dim() + safe_set.obstacles.size()));
  for (std::size_t k = 0; k < quick.size(); ++k) {
    EXPECT_LE(quick[k].value, 1.02 * without_conditioning(certificates[k]) + 1e-4 * parts) << name;
    EXPECT_GE(quick[k].value, lower_limit(truth.stages[k])) << name;
    EXPECT_GE(quick[k].of("c2"), lower_limit(truth.stages[k])) << name;
  }
}

class Bounds : public ::testing::TestWithParam<int> {};

TEST_P(Bounds, are_never_below_the_simulated_truth) {
  const int shard = GetParam();
  Generator generator(7919 + static_cast<std::uint64_t>(shard));
  Tally tally;
  for (int index = shard; index < problem_count(); index += kShards) {
    const Problem problem = random_problem(generator);
    check_problem(problem, problem.system + " " + std::to_string(index), generator, tally);
  }
  // The problems can distinguish a bound from a mere number: many truths are neither rare nor
  // certain, many certificates are non-trivial there, and the thesis's value is detected as too
  // low.
  EXPECT_GT(tally.informative, tally.stages / 5);
  EXPECT_GT(tally.nontrivial, tally.informative / 2);
  EXPECT_GT(tally.late_closed, 0);
  EXPECT_GT(tally.conditioned, tally.nontrivial / 10);
  EXPECT_GT(tally.thesis_below, 0);
  EXPECT_GT(tally.finite_w2, tally.stages / 2);
  EXPECT_GT(tally.bodies, tally.stages / 40);
  EXPECT_GE(tally.systems.size(), 3U);
  RecordProperty("stages", tally.stages);
  RecordProperty("informative", tally.informative);
  RecordProperty("nontrivial", tally.nontrivial);
  RecordProperty("late_closed", tally.late_closed);
  RecordProperty("conditioned", tally.conditioned);
  RecordProperty("thesis_below", tally.thesis_below);
  RecordProperty("finite_w2", tally.finite_w2);
  RecordProperty("bodies", tally.bodies);
  for (const auto& [system, count] : tally.systems) RecordProperty(system, count);
}

int own_problem_count() { return by_effort(96, 96, 2000); }

class BoundsOfOwnSystems : public ::testing::TestWithParam<int> {};

TEST_P(BoundsOfOwnSystems, are_never_below_the_simulated_truth) {
  const int shard = GetParam();
  Generator generator(104729 + static_cast<std::uint64_t>(shard));
  Tally tally;
  for (int index = shard; index < own_problem_count(); index += kShards) {
    const Problem problem = random_own_problem(generator);
    check_problem(problem, problem.system + " " + std::to_string(index), generator, tally);
  }
  EXPECT_GT(tally.informative, tally.stages / 8);
  EXPECT_GT(tally.nontrivial, tally.informative / 3);
  EXPECT_GT(tally.finite_w2, tally.stages / 2);
  EXPECT_GE(tally.systems.size(), 2U);
  RecordProperty("informative", tally.informative);
  RecordProperty("nontrivial", tally.nontrivial);
  for (const auto& [system, count] : tally.systems) RecordProperty(system, count);
}

INSTANTIATE_TEST_SUITE_P(shards, BoundsOfOwnSystems, ::testing::Range(0, kShards));
INSTANTIATE_TEST_SUITE_P(shards, Bounds, ::testing::Range(0, kShards));

}  // namespace certificate_soundness_test
}  // namespace qsmpc::controller
