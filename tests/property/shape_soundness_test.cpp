// Certificates among planar shapes, static and moving, are bounds, and tight: random problems,
// every stage, every kind of bound, against simulated paths of the model under the same policy.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <boost/math/distributions/binomial.hpp>
#include <gtest/gtest.h>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "tests/property/random_problem.hpp"
#include "tests/support/effort.hpp"

namespace qsmpc::controller {
namespace shape_soundness_test {

using namespace testing;

const int kPaths = by_effort(10000, 10000, 100000);

/// For each kind of shape.
int problem_count() { return by_effort(36, 36, 1680); }

/// Clopper–Pearson: the probability that the truth is below this in any of all comparisons together
/// is at most 1e-3; there are at most 7 kinds of bounds and 8 stages per problem, with static and
/// with moving shapes.
double lower_limit(int successes) {
  const double comparisons =
      2.0 * 7.0 * 8.0 * problem_count() * static_cast<double>(shape_kinds().size());
  if (successes == 0) return 0.0;
  return boost::math::binomial_distribution<>::find_lower_bound_on_p(kPaths, successes,
                                                                     1e-3 / comparisons);
}

struct Tally {
  int stages = 0;
  int informative = 0;         // truth in 1e-3 … 0.5
  int nontrivial = 0;          // certificate below one there
  std::vector<double> ratios;  // ratios of certificate to truth there, open loop
};

void compare(const StageCertificate& certificate, int unsafe_paths, const std::string& where) {
  const double least = lower_limit(unsafe_paths);
  for (const char* kind : {"c1", "c2", "c3", "c4", "c5"}) {
    EXPECT_GE(certificate.of(kind), least) << kind << " " << where;
  }
  EXPECT_GE(certificate.value, least) << "value " << where;
  EXPECT_LE(certificate.value, 1.0) << where;
}

void check_problem(const Problem& problem, const std::string& name, Generator& generator,
                   Tally& tally) {
  Planner planner(*problem.dynamics, problem.settings);
  const Plan& plan = planner.plan(problem.belief);
  const PredictedMotion motion = motion_of(planner, problem.belief, plan);
  const std::vector<StageBudget> budgets = error_budget(motion);
  const SafeSet& safe_set = problem.settings.safe_set;
  const auto certificates = certify(motion, safe_set, budgets, CertificateEffort::kEvery);
  const auto quick = certify(motion, safe_set, budgets);
  const UnsafeCounts truth = simulate(motion, safe_set, kPaths, generator);
  ASSERT_EQ(certificates.size(), truth.stages.size());
  for (std::size_t k = 0; k < certificates.size(); ++k) {
    const std::string where = name + ", stage " + std::to_string(k + 1);
    compare(certificates[k], truth.stages[k], where);
    compare(quick[k], truth.stages[k], where + ", for control");
    ++tally.stages;
    const double rate = static_cast<double>(truth.stages[k]) / kPaths;
    if (rate < 1e-3 || rate > 0.5) continue;
    ++tally.informative;
    if (certificates[k].value < 1.0) ++tally.nontrivial;
    if (!problem.settings.closed_loop) tally.ratios.push_back(certificates[k].value / rate);
  }
  EXPECT_GE(horizon_bound(certificates), lower_limit(truth.any)) << name;
}

using MakeProblem = Problem (*)(Generator&, const std::string& kind);

void check_problems(MakeProblem make, const std::string& kind, Generator& generator) {
  Tally tally;
  for (int index = 0; index < problem_count(); ++index) {
    const Problem problem = make(generator, kind);
    check_problem(problem, problem.system + " " + std::to_string(index), generator, tally);
  }
  ::testing::Test::RecordProperty("stages", tally.stages);
  ::testing::Test::RecordProperty("informative", tally.informative);
  ::testing::Test::RecordProperty("nontrivial", tally.nontrivial);
  EXPECT_GT(tally.informative, tally.stages / 6);
  EXPECT_GT(tally.nontrivial, tally.informative / 2);
  ASSERT_GT(tally.ratios.size(), problem_count() / 3.0);  // enough for a median
  std::sort(tally.ratios.begin(), tally.ratios.end());
  const double median = tally.ratios[tally.ratios.size() / 2];
  EXPECT_LE(median, 2.0);
  ::testing::Test::RecordProperty("open_loop", static_cast<int>(tally.ratios.size()));
  ::testing::Test::RecordProperty("median_ratio", std::to_string(median));
}

class ShapeBounds : public ::testing::TestWithParam<std::string> {};

TEST_P(ShapeBounds, are_never_below_the_simulated_truth_and_mostly_within_twice) {
  Generator generator(6007);
  check_problems(random_shape_problem, GetParam(), generator);
}

TEST_P(ShapeBounds, of_shapes_that_move_are_neither) {
  Generator generator(6011);
  check_problems(random_moving_problem, GetParam(), generator);
}

INSTANTIATE_TEST_SUITE_P(kinds, ShapeBounds, ::testing::ValuesIn(shape_kinds()),
                         [](const auto& each) { return each.param; });

}  // namespace shape_soundness_test
}  // namespace qsmpc::controller
