// Certificates among shapes of the plane are bounds, and tight: random problems, every stage, every
// kind of bound, against simulated paths of the model under the same policy.
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

const int kPaths = by_effort(10000, 40000, 100000);

/// Of each kind.
int problem_count() { return by_effort(84, 84, 1680); }

/// Clopper–Pearson: the truth is below this with a probability of at most 1e-3 in any of all
/// comparisons together; 6 kinds of bounds and 8 stages a problem are the most there can be.
double lower_limit(int successes) {
  const double comparisons =
      6.0 * 8.0 * problem_count() * static_cast<double>(shape_kinds().size());
  if (successes == 0) return 0.0;
  return boost::math::binomial_distribution<>::find_lower_bound_on_p(kPaths, successes,
                                                                     1e-3 / comparisons);
}

struct Tally {
  int stages = 0;
  int informative = 0;         // truth in 1e-3 … 0.5
  int nontrivial = 0;          // certificate below one there
  std::vector<double> ratios;  // of certificate and truth there, open loop
};

void compare(const StageCertificate& certificate, int unsafe_paths, const std::string& where) {
  const double least = lower_limit(unsafe_paths);
  for (const char* kind : {"c1", "c2", "c3", "c4"}) {
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

class ShapeBounds : public ::testing::TestWithParam<std::string> {};

TEST_P(ShapeBounds, are_never_below_the_simulated_truth_and_mostly_within_twice) {
  Generator generator(6007);
  Tally tally;
  for (int index = 0; index < problem_count(); ++index) {
    const Problem problem = random_shape_problem(generator, GetParam());
    check_problem(problem, problem.system + " " + std::to_string(index), generator, tally);
  }
  EXPECT_GT(tally.informative, tally.stages / 6);
  EXPECT_GT(tally.nontrivial, tally.informative / 2);
  ASSERT_GT(tally.ratios.size(), 30U);
  std::sort(tally.ratios.begin(), tally.ratios.end());
  const double median = tally.ratios[tally.ratios.size() / 2];
  EXPECT_LE(median, 2.0);
  RecordProperty("stages", tally.stages);
  RecordProperty("informative", tally.informative);
  RecordProperty("nontrivial", tally.nontrivial);
  RecordProperty("open_loop", static_cast<int>(tally.ratios.size()));
  RecordProperty("median_ratio", std::to_string(median));
}

INSTANTIATE_TEST_SUITE_P(kinds, ShapeBounds, ::testing::ValuesIn(shape_kinds()),
                         [](const auto& each) { return each.param; });

}  // namespace shape_soundness_test
}  // namespace qsmpc::controller
