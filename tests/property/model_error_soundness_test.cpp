// Certificates that are given a model error hold for plants that have it: random problems, plants
// whose error is of known norms and otherwise as bad as it gets, every stage, every kind of bound,
// against simulated paths of the plant under the same policy.
#include <algorithm>
#include <array>
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
#include "tests/property/marginal_w2.hpp"
#include "tests/property/random_problem.hpp"
#include "tests/support/effort.hpp"

namespace qsmpc::controller {
namespace model_error_soundness_test {

using namespace testing;
const int kPaths = by_effort(10000, 25000, 50000);
// Paths whose states are compared with the particles: each coordinate's are sorted.
constexpr int kSorted = 10000;
constexpr int kShards = 8;  // so that the test runner can use several cores

int problem_count() { return by_effort(320, 320, 4000); }

/// Clopper–Pearson: the truth is below this with a probability of at most 1e-3 in any of all
/// comparisons together; 6 kinds and 8 stages a problem are the most there can be.
double lower_limit(int successes) {
  const double significance = 1e-3 / (6.0 * 8.0 * problem_count());
  if (successes == 0) return 0.0;
  return boost::math::binomial_distribution<>::find_lower_bound_on_p(kPaths, successes,
                                                                     significance);
}

/// The truth is above this with such a probability.
double upper_limit(int successes) {
  const double significance = 1e-3 / (6.0 * 8.0 * problem_count());
  return boost::math::binomial_distribution<>::find_upper_bound_on_p(kPaths, successes,
                                                                     significance);
}

double uniform(Generator& generator, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(generator);
}

/// A plant's error and what is known of it. The norms hold at every moment, or those of a period at
/// its moments, whatever happened.
struct Plant {
  std::string kind;
  ModelError norms;
  PlantError error;
};

/// Norms of order 2, 4 and 8 of a variable, for coordinates that are these multiples of it.
ModelError scaled_norms(const Eigen::VectorXd& size, const std::array<double, 3>& norms) {
  ModelError error = model_error_of_size(norms[0] * size);
  error.higher[0] = norms[1] * size;
  error.higher[1] = norms[2] * size;
  return error;
}

/// From every point the shortest way to the unsafe set; infinite where there is none.
Points ways_to_unsafe(const SafeSet& safe_set, const Points& points) {
  std::vector<Box> parts = safe_set.obstacles;
  for (Eigen::Index axis = 0; axis < points.rows(); ++axis) {
    Box face{.lower = Eigen::VectorXd::Constant(points.rows(), -kInfinity),
             .upper = Eigen::VectorXd::Constant(points.rows(), kInfinity)};
    face.lower[axis] = safe_set.bounds.upper[axis];
    parts.push_back(face);
    face.lower[axis] = -kInfinity;
    face.upper[axis] = safe_set.bounds.lower[axis];
    parts.push_back(face);
  }
  Points ways = Points::Constant(points.rows(), points.cols(), kInfinity);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    double least = kInfinity;
    for (const Box& part : parts) {
      const Eigen::VectorXd point = points.col(i);
      const Eigen::VectorXd way = point.cwiseMax(part.lower).cwiseMin(part.upper) - point;
      if (!(way.norm() < least)) continue;
      least = way.norm();
      ways.col(i) = way;
    }
  }
  return ways;
}

/// −1 or 1 in each coordinate: where the nearest part of the unsafe set is from every point.
Points towards_unsafe(const SafeSet& safe_set, const Points& points) {
  return ways_to_unsafe(safe_set, points).unaryExpr([](double way) {
    return way < 0.0 ? -1.0 : 1.0;
  });
}

Plant biased(const Eigen::VectorXd& size, Generator& generator) {
  const Eigen::VectorXd bias =
      size.unaryExpr([&](double one) { return uniform(generator, 0.0, 1.0) < 0.5 ? -one : one; });
  return {.kind = "biased",
          .norms = scaled_norms(size, {1.0, 1.0, 1.0}),
          .error = [bias](const PlantMoment& moment) {
            return Points(bias.replicate(1, moment.stepped.cols()));
          }};
}

/// Waves in a coordinate of the state: at most `size`.
Plant wavy(const Eigen::VectorXd& size, Generator& generator) {
  const double phase = uniform(generator, 0.0, 6.0);
  const double number = uniform(generator, 0.5, 10.0);
  const auto axis = std::uniform_int_distribution<Eigen::Index>(0, size.size() - 1)(generator);
  return {.kind = "wavy",
          .norms = scaled_norms(size, {1.0, 1.0, 1.0}),
          .error = [=](const PlantMoment& moment) {
            const Eigen::RowVectorXd wave =
                (number * moment.stepped.row(axis).array() + phase).sin().matrix();
            return Points(size * wave);
          }};
}

/// Always the whole size, always to where it is worst.
Plant hostile(const Eigen::VectorXd& size, const SafeSet& safe_set) {
  return {.kind = "hostile",
          .norms = scaled_norms(size, {1.0, 1.0, 1.0}),
          .error = [=](const PlantMoment& moment) {
            return Points(size.asDiagonal() * towards_unsafe(safe_set, moment.stepped));
          }};
}

/// Rarely, but then by far and to where it is worst.
Plant jumping(const Eigen::VectorXd& size, const SafeSet& safe_set, Generator& generator) {
  const double share = uniform(generator, 0.01, 0.2);
  const double jump = 1.0 / std::sqrt(share);  // of root mean square one
  return {.kind = "jumping",
          .norms = scaled_norms(
              size, {1.0, jump * std::pow(share, 1.0 / 4.0), jump * std::pow(share, 1.0 / 8.0)}),
          .error = [=, &generator](const PlantMoment& moment) {
            Points error = size.asDiagonal() * towards_unsafe(safe_set, moment.stepped);
            for (Eigen::Index i = 0; i < error.cols(); ++i) {
              error.col(i) *= uniform(generator, 0.0, 1.0) < share ? jump : 0.0;
            }
            return error;
          }};
}

/// A hidden state that the noises so far have moved, h⁺ = keep h + w, pushes on in every period.
Plant dragging(double strength, const Eigen::MatrixXd& noise, Generator& generator) {
  const double keep = uniform(generator, 0.5, 0.95);
  // h is Gaussian, and at most as wide as it is in the end.
  const Eigen::VectorXd size =
      strength * noise.diagonal().cwiseMax(0.0).cwiseSqrt() / std::sqrt(1.0 - keep * keep);
  return {.kind = "dragging",
          .norms = scaled_norms(size, {1.0, std::pow(3.0, 1.0 / 4.0), std::pow(105.0, 1.0 / 8.0)}),
          .error = [=, hidden = Points()](const PlantMoment& moment) mutable {
            hidden =
                hidden.size() == 0 ? moment.last_noise : Points(keep * hidden + moment.last_noise);
            return Points(strength * hidden);
          }};
}

/// Student's t of ten degrees of freedom, turned to where it is worst.
Plant heavy_tailed(const Eigen::VectorXd& size, const SafeSet& safe_set, Generator& generator) {
  constexpr double kFreedom = 10.0;
  constexpr double kSquare = kFreedom / (kFreedom - 2.0);
  constexpr double kFourth = 3.0 * kFreedom / (kFreedom - 4.0) * kSquare;
  constexpr double kEighth =
      35.0 * kFreedom * kFreedom / ((kFreedom - 6.0) * (kFreedom - 8.0)) * kFourth;
  return {.kind = "heavy-tailed",
          .norms = scaled_norms(size, {std::sqrt(kSquare), std::pow(kFourth, 1.0 / 4.0),
                                       std::pow(kEighth, 1.0 / 8.0)}),
          .error = [=, &generator](const PlantMoment& moment) {
            std::student_t_distribution<double> student(kFreedom);
            Points error = size.asDiagonal() * towards_unsafe(safe_set, moment.stepped);
            for (Eigen::Index i = 0; i < error.cols(); ++i) {
              error.col(i) *= std::abs(student(generator));
            }
            return error;
          }};
}

/// None, but close to the unsafe set, into which it leads; a correlation with all noises so far
/// that nothing must be smoothed over.
PlantError lurking_error(const Eigen::VectorXd& reach, const SafeSet& safe_set) {
  return [=](const PlantMoment& moment) {
    Points error = ways_to_unsafe(safe_set, moment.stepped);
    for (Eigen::Index i = 0; i < error.cols(); ++i) {
      const bool near = (error.col(i).array().abs() < reach.array()).all();
      error.col(i) *= near ? 1.0 : 0.0;
    }
    return Points(error.unaryExpr([](double one) { return std::isfinite(one) ? one : 0.0; }));
  };
}

/// Its norms: those of what is `reach` with the probability of any error, of which simulated paths
/// give an upper limit, and else zero.
Plant lurking(const PredictedMotion& motion, const SafeSet& safe_set, const Eigen::VectorXd& reach,
              Generator& generator) {
  const PlantError error = lurking_error(reach, safe_set);
  Eigen::VectorXd most = Eigen::VectorXd::Zero(reach.size());  // paths, at any moment
  const PlantError counted = [&](const PlantMoment& moment) {
    const Points one = error(moment);
    most = most.cwiseMax((one.array() != 0.0).cast<double>().rowwise().sum().matrix());
    return one;
  };
  (void)simulate(motion, safe_set, kPaths, generator, nullptr, counted);
  Plant plant{.kind = "lurking", .norms = scaled_norms(reach, {1.0, 1.0, 1.0}), .error = error};
  for (Eigen::Index i = 0; i < reach.size(); ++i) {
    const double share = upper_limit(static_cast<int>(most[i]));
    plant.norms.root_mean_square[i] *= std::sqrt(share);
    plant.norms.higher[0][i] *= std::pow(share, 1.0 / 4.0);
    plant.norms.higher[1][i] *= std::pow(share, 1.0 / 8.0);
  }
  return plant;
}

/// Any of the plants above; over the horizon its error adds up to between 0.03 and three times what
/// the state deviates from its mean.
Plant random_plant(const Problem& problem, const PredictedMotion& motion, Generator& generator) {
  const PlannerSettings& settings = problem.settings;
  const double total = std::pow(10.0, uniform(generator, -1.5, 0.5));
  const Eigen::VectorXd spread = (problem.belief.covariance.diagonal() +
                                  0.5 * settings.horizon * settings.noise_covariance.diagonal())
                                     .cwiseMax(0.0)
                                     .cwiseSqrt();
  const Eigen::VectorXd size = total / settings.horizon * spread;
  switch (std::uniform_int_distribution<int>(0, 7)(generator)) {
    case 0:
      return biased(size, generator);
    case 1:
      return wavy(size, generator);
    case 2:
      return hostile(size, settings.safe_set);
    case 3:
      return jumping(size, settings.safe_set, generator);
    case 4:
      return dragging(uniform(generator, 0.05, 0.5), settings.noise_covariance, generator);
    case 5:
    case 6:
      return lurking(motion, settings.safe_set, uniform(generator, 0.1, 0.6) * spread, generator);
    default:
      return heavy_tailed(size, settings.safe_set, generator);
  }
}

/// `plant`, whose norms hold whatever its error did before, with errors of another size about an
/// offset in each of the first periods of a drive, and small ones later. Its stages begin with
/// period `begin`.
Plant setting_out(Plant plant, Eigen::Index begin, Generator& generator) {
  const int periods = std::uniform_int_distribution<int>(1, 4)(generator);
  const double later = std::pow(10.0, uniform(generator, -1.5, 0.0));
  std::vector<double> factors;
  std::vector<ModelError> first;
  for (int k = 0; k < periods; ++k) {
    const double exponent = k == 0 ? uniform(generator, 0.5, 1.3) : uniform(generator, -0.5, 0.5);
    factors.push_back(std::pow(10.0, exponent));
    first.push_back(widened(plant.norms, factors.back()));
    first.back().offset = plant.norms.root_mean_square.unaryExpr(
        [&](double one) { return uniform(generator, -5.0, 5.0) * one; });
  }
  plant.norms = widened(plant.norms, later);
  plant.norms.first = first;
  plant.error = [=, error = plant.error](const PlantMoment& moment) {
    const Points one = error(moment);
    const auto period = static_cast<std::size_t>(begin + moment.stage);
    if (period >= first.size()) return Points(later * one);
    return Points((factors[period] * one).colwise() + first[period].offset);
  };
  return plant;
}

/// Forgets, in one of three cases each, the norms of order 8 or all but the mean square.
ModelError as_known(ModelError norms, Generator& generator) {
  for (ModelError& own : norms.first) own = as_known(own, generator);
  const int forgotten = std::uniform_int_distribution<int>(0, 2)(generator);
  if (forgotten >= 1) norms.higher[1].setConstant(kInfinity);
  if (forgotten == 2) norms.higher[0].setConstant(kInfinity);
  return norms;
}

/// What the comparisons of a shard came to.
struct Tally {
  int stages = 0;
  int informative = 0;  // truth in 1e-3 … 0.5
  int nontrivial = 0;   // certificate below one half there
  int finite_w2 = 0;
  int violated = 0;        // problems in which certificates that know no model error are wrong
  int setting_out = 0;     // problems with a plant that errs by other norms at first
  int violated_later = 0;  // of these, in which certificates that know the later norms alone are
  std::map<std::string, int> violated_by;
};

void compare(const StageCertificate& certificate, double least, const std::string& where) {
  EXPECT_GE(certificate.particles, least) << "C1 " << where;
  EXPECT_GE(certificate.mixture, least) << "C2 " << where;
  EXPECT_GE(certificate.surrogate, least) << "C3 " << where;
  EXPECT_GE(certificate.smoothed, least) << "C4 " << where;
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

/// Certificates that take the norms of later periods for those of all.
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
  Plant plant = random_plant(problem, motion, generator);
  // What lurks counts on where its own error has led.
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
  // The plants can tell a certificate that knows of them from one that does not.
  EXPECT_GT(tally.violated, 0);
  EXPECT_GT(tally.violated_by.size(), 1U);
  // And one that knows what the plant does at first from one that does not.
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
