// Bounds C3 that are searched for only as far as they are useful: they are those of the whole
// search or 1, and cost C4, which takes the lesser of the two, nothing.
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "controller/regions/box_part.hpp"
#include "controller/regions/box_part_bound.hpp"
#include "controller/regions/box_part_norm_bound.hpp"
#include "controller/regions/unsafe_region.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace useful_bound_test {

using namespace testing;

// Relative accuracy of the searches for t and τ.
constexpr double kSearch = 0.03;

/// A law in two dimensions near a part of them, and a deviation of any size from it.
struct Case {
  Gaussian law;
  Eigen::VectorXd error;
  Eigen::MatrixXd smoothing;
  BoxPart part;
};

Case random_case(Generator& generator) {
  Case one;
  one.law.mean = random_matrix(generator, 2, 1, 0.8);
  const Eigen::MatrixXd root = random_matrix(generator, 2, 2, 0.3);
  one.law.covariance = root * root.transpose() + 1e-3 * Eigen::Matrix2d::Identity();
  one.smoothing = 0.4 * one.law.covariance;
  one.error = Eigen::VectorXd::Constant(2, std::pow(10.0, uniform(generator, -3.5, -0.7)));
  one.part = {.box = {.lower = Eigen::Vector2d(0.9, -0.4), .upper = Eigen::Vector2d(1.3, 0.5)},
              .axes = {0, 1}};
  if (uniform(generator, 0.0, 1.0) < 0.3) {
    one.part.box.upper[0] = kInfinity;
    one.part.box.lower[1] = -kInfinity;
    one.part.box.upper[1] = kInfinity;
    one.part.axes = {0};
  }
  return one;
}

/// Whether the bound was passed over; it may be only where it cannot be below `useful`.
bool is_passed_over(double bound, double whole, double useful) {
  if (bound == 1.0 && whole < 1.0) {
    EXPECT_GE(whole, useful * (1.0 - kSearch));
    return true;
  }
  EXPECT_NEAR(bound, whole, kSearch * whole);
  return false;
}

TEST(UsefulBound, of_c3_is_that_of_the_whole_search_or_not_below_what_is_useful) {
  Generator generator(417);
  int passed_over = 0;
  int found = 0;
  for (int repetition = 0; repetition < 300; ++repetition) {
    const Case one = random_case(generator);
    const PerturbedGaussian state{.law = one.law, .error = one.error, .smoothing = one.smoothing};
    const double useful = std::pow(10.0, uniform(generator, -4.0, 0.0));
    const bool passed = is_passed_over(markov_region_bound(state, one.part, useful),
                                       markov_region_bound(state, one.part), useful);
    ++(passed ? passed_over : found);
    const Eigen::VectorXd norms = 1.5 * one.error;
    for (const int order : kHigherOrders) {
      const bool is_passed =
          is_passed_over(tail_region_bound(one.law, norms, order, one.part, useful),
                         tail_region_bound(one.law, norms, order, one.part), useful);
      ++(is_passed ? passed_over : found);
    }
  }
  EXPECT_GT(passed_over, 200);
  EXPECT_GT(found, 200);
}

/// The bounds of the part if greater ones than `useful` are not wanted.
RegionProbability bounds_of(const Case& one, WantedBounds wanted, double useful = 1.0) {
  const std::function<Eigen::MatrixXd(const std::vector<Eigen::Index>&)> smoothing =
      [&](const std::vector<Eigen::Index>&) { return one.smoothing; };
  HigherNorms higher;
  for (Eigen::VectorXd& norms : higher) norms = 1.5 * one.error;
  RegionProbability sum;
  add_part_probability({.law = one.law,
                        .error = one.error,
                        .higher = higher,
                        .smoothing = smoothing,
                        .wanted = wanted,
                        .useful = useful},
                       one.part, sum);
  return sum;
}

TEST(UsefulBound, leaves_c4_as_it_is) {
  Generator generator(418);
  int lower = 0;
  for (int repetition = 0; repetition < 300; ++repetition) {
    const Case one = random_case(generator);
    const RegionProbability both = bounds_of(one, WantedBounds::kBoth);
    const RegionProbability least = bounds_of(one, WantedBounds::kLeast);
    EXPECT_NEAR(least.smooth, both.smooth, kSearch * both.smooth);
    EXPECT_LE(least.smooth, least.markov);
    if (both.markov < least.markov * (1.0 - kSearch)) ++lower;
  }
  EXPECT_GT(lower, 20);
}

TEST(UsefulBound, below_one_that_is_known_is_found) {
  Generator generator(419);
  int below = 0;
  int above = 0;
  for (int repetition = 0; repetition < 300; ++repetition) {
    const Case one = random_case(generator);
    const double known = std::pow(10.0, uniform(generator, -4.0, 0.0));
    const double whole = bounds_of(one, WantedBounds::kBoth).smooth;
    const double found = bounds_of(one, WantedBounds::kLeast, known).smooth;
    EXPECT_NEAR(std::min(known, found), std::min(known, whole), kSearch * whole);
    ++(whole < known ? below : above);
  }
  EXPECT_GT(below, 50);
  EXPECT_GT(above, 50);
}

}  // namespace useful_bound_test
}  // namespace qsmpc::controller
