// Certificates with a given model error hold for plants that have it: random problems, worst-case
// plants whose error has known norms, every stage, every kind of bound, against simulated paths of
// the plant under the same policy.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <boost/math/distributions/binomial.hpp>
#include <gtest/gtest.h>

#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "controller/prediction/model_error.hpp"
#include "models/constants.hpp"
#include "tests/property/erring_plants.hpp"
#include "tests/property/marginal_w2.hpp"
#include "tests/property/random_draws.hpp"
#include "tests/property/random_problem.hpp"
#include "tests/support/effort.hpp"

namespace qsmpc::controller {
namespace model_error_soundness_test {

using namespace testing;
const int kPaths = by_effort(10000, 25000, 50000);
// Number of paths compared with the particles: each coordinate is sorted.
constexpr int kSorted = 10000;
constexpr int kShards = 8;  // so that the test runner can use several cores

int problem_count() { return by_effort(320, 320, 4000); }

/// Clopper–Pearson: the probability that the truth is below this in any of all comparisons together
/// is at most 1e-3; there are at most 7 kinds of bounds and 8 stages per problem.
double lower_limit(int successes) {
  const double significance = 1e-3 / (7.0 * 8.0 * problem_count());
  if (successes == 0) return 0.0;
  return boost::math::binomial_distribution<>::find_lower_bound_on_p(kPaths, successes,
                                                                     significance);
}

/// The truth exceeds this with the same probability.
double upper_limit(int successes) {
  const double significance = 1e-3 / (7.0 * 8.0 * problem_count());
  return boost::math::binomial_distribution<>::find_upper_bound_on_p(kPaths, successes,
                                                                     significance);
}

/// With probability one third each, drops the norms of order 8, or all but the root mean square.
ModelError as_known(ModelError norms, Generator& generator) {
  for (ModelError& own : norms.first) own = as_known(own, generator);
  const int forgotten = std::uniform_int_distribution<int>(0, 2)(generator);
  if (forgotten >= 1) norms.higher[1].setConstant(kInfinity);
  if (forgotten == 2) norms.higher[0].setConstant(kInfinity);
  return norms;
}

/// Results of the comparisons of a shard.
struct Tally {
  int stages = 0;
  int informative = 0;  // truth in 1e-3 … 0.5
  int nontrivial = 0;   // certificate below one half there
  int finite_w2 = 0;
  int violated = 0;        // problems in which certificates without the model error are wrong
  int setting_out = 0;     // problems with a plant whose error has other norms at first
  int violated_later = 0;  // of these, in which certificates with only the later norms are wrong
  std::map<std::string, int> violated_by;
};

void compare(const StageCertificate& certificate, double least, const std::string& where) {
  EXPECT_GE(certificate.of("c1"), least) << "C1 " << where;
  EXPECT_GE(certificate.of("c2"), least) << "C2 " << where;
  EXPECT_GE(certificate.of("c3"), least) << "C3 " << where;
  EXPECT_GE(certificate.of("c4"), least) << "C4 " << where;
  EXPECT_GE(certificate.of("c5"), least) << "C5 " << where;
  EXPECT_GE(certificate.value, least) << "value " << where;
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

/// Certificates that use the norms of later periods for all periods.
std::vector<StageCertificate> later_certificates(PredictedMotion motion, const SafeSet& safe_set) {
  ModelError later = *motion.model_error;
  later.first.clear();
  motion.model_error = &later;
  if (motion.belief_error != nullptr) motion.belief_error = &later;
  return certify(motion, safe_set, error_budget(motion));
}

void check_problem(const Problem& problem, const std::string& name, Generator& generator,
                   Tally& tally) {
  Planner planner(*problem.dynamics, problem.settings);
  const Plan& plan = planner.plan(problem.belief);
  PredictedMotion motion = motion_of(planner, problem.belief, plan);
  const PredictedMotion model = motion;
  ModelError known;
  motion.model_error = &known;
  if (uniform(generator, 0.0, 1.0) < 0.3) {
    motion.belief_error = &known;
    motion.first_period = std::uniform_int_distribution<Eigen::Index>(1, 3)(generator);
  }
  ErringPlant plant =
      random_plant(problem, motion, {.paths = kPaths, .upper_limit = upper_limit}, generator);
  // The norms of a lurking plant were estimated with its own error acting.
  if (plant.kind != "lurking" && uniform(generator, 0.0, 1.0) < 0.5) {
    plant = setting_out(plant, motion.first_period, generator);
  }
  known = as_known(plant.norms, generator);
  if (motion.belief_error != nullptr) {
    motion.belief_error = &known.of_period(motion.first_period - 1);
  }
  const SafeSet& safe_set = problem.settings.safe_set;
  const CertificateEffort effort =
      uniform(generator, 0.0, 1.0) < 0.5 ? CertificateEffort::kLeast : CertificateEffort::kEvery;
  const std::vector<StageBudget> budgets = error_budget(motion);
  const std::vector<StageCertificate> certificates = certify(motion, safe_set, budgets, effort);
  const std::vector<StageCertificate> of_model = certify(model, safe_set, error_budget(model));
  const std::vector<StageCertificate> of_later = later_certificates(motion, safe_set);
  std::vector<Points> states;
  const UnsafeCounts truth = simulate(motion, safe_set, kPaths, generator, &states, plant.error);
  bool violated = false;
  bool violated_later = false;
  for (std::size_t k = 0; k < certificates.size(); ++k) {
    const std::string where = name + ", " + plant.kind + ", stage " + std::to_string(k + 1);
    const double least = lower_limit(truth.stages[k]);
    compare(certificates[k], least, where);
    compare_w2(budgets[k + 1], plan.prediction.stages[k + 1], states[k], where, tally);
    violated = violated || of_model[k].value < least;
    violated_later = violated_later || of_later[k].value < least;
    ++tally.stages;
    const double rate = static_cast<double>(truth.stages[k]) / kPaths;
    if (rate < 1e-3 || rate > 0.5) continue;
    ++tally.informative;
    if (certificates[k].value < 0.5) ++tally.nontrivial;
  }
  EXPECT_GE(horizon_bound(certificates), lower_limit(truth.any)) << name;
  if (!known.first.empty()) {
    ++tally.setting_out;
    if (violated_later) ++tally.violated_later;
  }
  if (!violated) return;
  ++tally.violated;
  ++tally.violated_by[plant.kind];
}

class ModelErrorBounds : public ::testing::TestWithParam<int> {};

TEST_P(ModelErrorBounds, hold_for_plants_with_the_error) {
  const int shard = GetParam();
  Generator generator(6007 + static_cast<std::uint64_t>(shard));
  Tally tally;
  for (int index = shard; index < problem_count(); index += kShards) {
    const Problem problem = random_problem(generator);
    check_problem(problem, problem.system + " " + std::to_string(index), generator, tally);
  }
  // The plants can distinguish a certificate with the model error from one without.
  EXPECT_GT(tally.violated, 0);
  EXPECT_GT(tally.violated_by.size(), 1U);
  // And one with the norms of the first periods from one without.
  EXPECT_GT(tally.violated_later, 0);
  EXPECT_GT(tally.informative, tally.stages / 5);
  EXPECT_GT(tally.nontrivial, 0);
  EXPECT_GT(tally.finite_w2, tally.stages / 2);
  RecordProperty("stages", tally.stages);
  RecordProperty("informative", tally.informative);
  RecordProperty("nontrivial", tally.nontrivial);
  RecordProperty("finite_w2", tally.finite_w2);
  RecordProperty("violated", tally.violated);
  RecordProperty("setting_out", tally.setting_out);
  RecordProperty("violated_later", tally.violated_later);
  for (const auto& [kind, count] : tally.violated_by) RecordProperty(kind, count);
}

INSTANTIATE_TEST_SUITE_P(shards, ModelErrorBounds, ::testing::Range(0, kShards));

}  // namespace model_error_soundness_test
}  // namespace qsmpc::controller
