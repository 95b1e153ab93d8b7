// No certificate lies below the truth: random problems, every stage, every kind of bound, against
// simulated paths of the model under the same policy.
#include <cmath>
#include <cstdlib>
#include <string>

#include <boost/math/distributions/binomial.hpp>
#include <gtest/gtest.h>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "tests/property/random_problem.hpp"

namespace qsmpc::testing {
namespace {

constexpr int kPaths = 100000;

/// A few seconds' worth by default, a long sweep where scripts/test is called with --slow.
int problem_count() { return std::getenv("QSMPC_SLOW_TESTS") == nullptr ? 120 : 5000; }

/// Clopper–Pearson: the truth is below this with a probability of at most 1e-3 in any of all
/// comparisons together; 5 kinds and 8 stages a problem are the most there can be.
double lower_limit(int successes) {
  const double significance = 1e-3 / (5.0 * 8.0 * problem_count());
  if (successes == 0) return 0.0;
  return boost::math::binomial_distribution<>::find_lower_bound_on_p(kPaths, successes,
                                                                     significance);
}

struct Tally {
  int stages = 0;
  int informative = 0;   // truth in 1e-3 … 0.5
  int nontrivial = 0;    // certificate below one there
  int surrogates = 0;    // C3 below one there
  int thesis_below = 0;  // the thesis's value is certainly below the truth
};

void compare(const StageCertificate& certificate, int unsafe_paths, const std::string& where,
             Tally& tally) {
  const double least = lower_limit(unsafe_paths);
  EXPECT_GE(certificate.particles, least) << "C1 " << where;
  EXPECT_GE(certificate.mixture, least) << "C2 " << where;
  EXPECT_GE(certificate.surrogate, least) << "C3 " << where;
  EXPECT_GE(certificate.value, least) << "value " << where;
  EXPECT_LE(certificate.value, 1.0) << where;
  const double truth = static_cast<double>(unsafe_paths) / kPaths;
  ++tally.stages;
  if (certificate.thesis < least) ++tally.thesis_below;
  if (truth < 1e-3 || truth > 0.5) return;
  ++tally.informative;
  if (certificate.value < 1.0) ++tally.nontrivial;
  if (certificate.surrogate < 1.0) ++tally.surrogates;
}

TEST(Certificates, are_never_below_the_simulated_truth) {
  Generator generator(7919);
  Tally tally;
  for (int index = 0; index < problem_count(); ++index) {
    const Problem problem = random_problem(generator);
    Planner planner(*problem.dynamics, problem.settings);
    const Plan& plan = planner.plan(problem.belief);
    const PredictedMotion motion = motion_of(planner, problem.belief, plan);
    const std::vector<StageCertificate> certificates =
        certify(motion, problem.settings.safe_set, error_budget(motion));
    const UnsafeCounts truth = simulate(problem, plan.policy, kPaths, generator);
    ASSERT_EQ(certificates.size(), truth.stages.size());
    const std::string name = "problem " + std::to_string(index);
    for (std::size_t k = 0; k < certificates.size(); ++k) {
      compare(certificates[k], truth.stages[k], name + ", stage " + std::to_string(k + 1), tally);
    }
    EXPECT_GE(horizon_bound(certificates), lower_limit(truth.any)) << name;
  }
  // The problems can tell a bound from a number that is none: many truths are neither rare nor
  // certain, many certificates say something there, and the thesis's value is caught.
  EXPECT_GT(tally.informative, tally.stages / 4);
  EXPECT_GT(tally.nontrivial, tally.informative / 4);
  EXPECT_GT(tally.surrogates, 0);
  EXPECT_GT(tally.thesis_below, 0);
  RecordProperty("stages", tally.stages);
  RecordProperty("informative", tally.informative);
  RecordProperty("nontrivial", tally.nontrivial);
  RecordProperty("surrogates", tally.surrogates);
  RecordProperty("thesis_below", tally.thesis_below);
}

}  // namespace
}  // namespace qsmpc::testing
