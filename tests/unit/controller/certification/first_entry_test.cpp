#include "controller/certification/first_entry.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "controller/certification/certificate.hpp"
#include "controller/certification/conditioned_bounds.hpp"
#include "controller/certification/error_budget.hpp"
#include "controller/measure/normal/normal_distribution.hpp"
#include "tests/support/executors.hpp"
#include "tests/support/simulated_truth.hpp"
#include "tests/unit/controller/certification/surrogate_cases.hpp"
#include "tests/unit/controller/certification/unsafe_ends.hpp"

namespace qsmpc::controller {
namespace first_entry_test {

using namespace testing;

constexpr int kPaths = 20000;

SurrogateBounds bounds_of(const PredictedMotion& motion, const UnsafeSet& unsafe) {
  return surrogate_bounds(motion, unsafe, CertificateEffort::kEvery, run_in_turn);
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Rates of paths that have been unsafe up to each of the stages 1 … horizon.
std::vector<double> rates_so_far(const PredictedMotion& motion, const SafeSet& safe_set,
                                 Generator& generator) {
  std::vector<Points> states;
  (void)simulate(motion, unbounded_safe_set(safe_set.dim()), kPaths, generator, &states);
  const UnsafeSet unsafe(safe_set);
  Eigen::Array<bool, Eigen::Dynamic, 1> ever =
      Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(kPaths, false);
  std::vector<double> rates;
  for (std::size_t k = 0; k < states.size(); ++k) {
    ever = ever || clearances(states[k], unsafe, static_cast<Eigen::Index>(k) + 1).array() <= 0.0;
    rates.push_back(static_cast<double>(ever.count()) / kPaths);
  }
  return rates;
}

/// Five standard deviations below the simulated rate.
double surely(double rate) { return rate - 5.0 * std::sqrt(rate / kPaths); }

/// A block at the paths' mid-horizon position, on one side, that covers `share` of them.
SafeSet blocked(const Case& one, double share) {
  Generator generator(302);
  std::vector<Points> states;
  SafeSet safe_set = unbounded_safe_set(one.dynamics->state_dim());
  (void)simulate(one.motion(), safe_set, kPaths, generator, &states);
  const Points& middle = states[states.size() / 2];
  Eigen::VectorXd beside = middle.row(1);
  std::sort(beside.begin(), beside.end());
  Box block = safe_set.bounds;
  const double x = middle.row(0).mean();
  block.lower.head<2>() =
      Eigen::Vector2d(x - 0.3, beside[static_cast<Eigen::Index>((1.0 - share) * kPaths)]);
  block.upper.head<2>() = Eigen::Vector2d(x + 0.3, beside[kPaths - 1] + 0.5);
  safe_set.obstacles.push_back(block);
  return safe_set;
}

/// The same with an elongated body instead of the point.
SafeSet with_body(SafeSet safe_set) {
  safe_set.body = {
      .discs = {{.radius = 0.05, .offset = {0.0, 0.0}}, {.radius = 0.05, .offset = {0.15, 0.0}}},
      .x = 0,
      .y = 1,
      .heading = 2};
  return safe_set;
}

struct Place {
  std::string name;
  Case one;
  SafeSet safe_set;
};

std::vector<Place> places() {
  const Feedback lqr{.closed_loop = true};
  const Feedback own{.closed_loop = true, .gain = Eigen::RowVector3d(0.2, -1.0, -1.5)};
  std::vector<Place> places;
  for (const Case& one : {dubins({}), dubins(lqr), dubins(own), bicycle({}), bicycle(lqr)}) {
    places.push_back({one.name + " beside a wall", one, unsafe_at_the_end(one, 1, 0.03)});
    places.push_back({one.name + " past a block", one, blocked(one, 0.03)});
    places.push_back({one.name + " with a body", one, with_body(blocked(one, 0.02))});
  }
  const Case pole = cart_pole(lqr);
  places.push_back({"cart-pole between walls", pole, unsafe_at_the_end(pole, 2, 0.02)});
  return places;
}

TEST(FirstEntry, bounds_every_first_stage_of_simulated_paths) {
  Generator generator(303);
  int informative = 0;
  for (const Place& place : places()) {
    const PredictedMotion motion = place.one.motion();
    const UnsafeSet unsafe(place.safe_set);
    const SurrogateBounds bounds = bounds_of(motion, unsafe);
    const std::vector<double> entries = first_entry_bounds(unsafe, bounds);
    const ConditionedBounds conditioned =
        conditioned_bounds(motion, unsafe, bounds, CertificateEffort::kEvery, run_in_turn);
    const std::vector<double> rates = rates_so_far(motion, place.safe_set, generator);
    double so_far = 0.0;
    double conditioned_so_far = 0.0;
    for (std::size_t k = 0; k < entries.size(); ++k) {
      so_far += entries[k];
      EXPECT_GE(so_far, surely(rates[k])) << place.name << ", stage " << k + 1;
      if (so_far < 0.5) ++informative;
      if (conditioned.entries.empty()) continue;
      conditioned_so_far += conditioned.entries[k];
      EXPECT_GE(conditioned_so_far, surely(rates[k])) << place.name << ", stage " << k + 1;
    }
  }
  EXPECT_GT(informative, 80);
}

/// A half-plane that turns towards the path, with known position.
SafeSet closing_door() {
  SafeSet safe_set = unbounded_safe_set(3);
  safe_set.body = {.discs = {}, .x = 0, .y = 1, .heading = 2};
  Obstacle door = PlanarShape(HalfPlaneShape{.normal = {0.0, 1.0}, .offset = 0.8});
  door.motion.emplace();
  safe_set.obstacles.push_back(door);
  PlacesByStage places;
  for (int k = 0; k <= 8; ++k) places.push_back({{.offset = {0.0, -0.02 * k}, .turn = -0.03 * k}});
  auto forecast = std::make_shared<ObstacleForecast>(1);
  forecast->set(0, places);
  safe_set.forecast = forecast;
  return safe_set;
}

TEST(FirstEntry, bounds_what_enters_a_half_plane_that_turns) {
  Generator generator(305);
  const Case one = dubins({}, 0.0);
  const PredictedMotion motion = one.motion();
  const SafeSet safe_set = closing_door();
  const UnsafeSet unsafe(safe_set);
  const SurrogateBounds bounds = bounds_of(motion, unsafe);
  const std::vector<double> entries = first_entry_bounds(unsafe, bounds);
  const std::vector<double> rates = rates_so_far(motion, safe_set, generator);
  ASSERT_GT(rates.back(), 0.01);
  ASSERT_LT(rates.back(), 0.5);
  double so_far = 0.0;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    so_far += entries[k];
    EXPECT_GE(so_far, surely(rates[k])) << k + 1;
  }
  EXPECT_LT(so_far, 1.4 * rates.back());
  EXPECT_LT(so_far, 0.8 * bounds.shares.sum());
}

// A block that the path passes at its middle: half-spaces are turned towards it there.
TEST(FirstEntry, counts_once_what_stays_in_a_block_at_mid_horizon) {
  const Case one = dubins({});
  const PredictedMotion motion = one.motion();
  const UnsafeSet unsafe(blocked(one, 0.03));
  const SurrogateBounds bounds = bounds_of(motion, unsafe);
  EXPECT_LT(sum(first_entry_bounds(unsafe, bounds)), 0.95 * bounds.shares.sum());
}

// With a wide heading the surrogate's error decides: the wall ahead of the car is entered more
// often by the state than by the surrogate.
TEST(FirstEntry, covers_the_error_of_a_wide_heading) {
  Generator generator(307);
  for (const double width : {0.6, 0.9}) {
    for (const double share : {0.03, 0.1}) {
      const Case one = dubins({}, 0.0, width);
      const PredictedMotion motion = one.motion();
      const SafeSet safe_set = unsafe_at_the_end(one, 0, share);
      const UnsafeSet unsafe(safe_set);
      const double entries = sum(first_entry_bounds(unsafe, bounds_of(motion, unsafe)));
      EXPECT_GE(entries, surely(rates_so_far(motion, safe_set, generator).back())) << width;
    }
  }
}

TEST(FirstEntry, is_certain_or_impossible_without_noise) {
  const Case car =
      make_case("certain", dubins_car(), around(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()),
                Eigen::Matrix3d::Zero(), Eigen::VectorXd::Zero(1), {});
  SafeSet safe_set = unbounded_safe_set(3);
  safe_set.bounds.upper[0] = 0.7;  // the car moves 0.15 m a stage
  const UnsafeSet unsafe(safe_set);
  const std::vector<double> entries = first_entry_bounds(unsafe, bounds_of(car.motion(), unsafe));
  ASSERT_EQ(entries.size(), 8U);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(entries[k], 0.0) << k + 1;
  EXPECT_EQ(entries[4], 1.0);
}

TEST(FirstEntry, counts_once_what_stays_unsafe) {
  Generator generator(304);
  // Noise that enters early keeps the car beyond the wall.
  Case one = dubins({}, 0.0);
  const PredictedMotion motion = one.motion();
  const SafeSet safe_set = unsafe_at_the_end(one, 1, 0.03);
  const UnsafeSet unsafe(safe_set);
  const SurrogateBounds bounds = bounds_of(motion, unsafe);
  const double truth = rates_so_far(motion, safe_set, generator).back();
  double stages = 0.0;
  for (const RegionProbability& stage : bounds.bounds) stages += stage.smooth;
  const double entries = sum(first_entry_bounds(unsafe, bounds));
  EXPECT_GT(stages, 1.8 * truth);
  EXPECT_LT(entries, 1.4 * truth);
}

TEST(FirstEntry, of_an_affine_step_is_the_probability_of_either_stage) {
  // z₁ ~ N(m₁, s₁²), z₂ given z₁ by the plain recursion: P(z₁ ≥ b or z₂ ≥ b) by Simpson's rule.
  const Case one = double_integrator({});
  const PredictedMotion motion = one.motion();
  SafeSet safe_set = unbounded_safe_set(2);
  safe_set.bounds.upper[0] = 1.25;
  const UnsafeSet unsafe(safe_set);
  const SurrogateBounds bounds = bounds_of(motion, unsafe);
  ASSERT_TRUE(bounds.surrogates[2].error.isZero(0.0));
  Eigen::Matrix2d step;
  step << 1.0, 0.1, 0.0, 1.0;
  const Eigen::Matrix2d noise = motion.noise_covariance;
  const Eigen::Matrix2d first = step * motion.belief.covariance * step.transpose() + noise;
  const Eigen::Vector2d mean = bounds.surrogates[1].law.mean;
  const Eigen::Matrix2d second = step * first * step.transpose() + noise;
  const double cross = (step * first)(0, 0);
  const double deviation = std::sqrt(first(0, 0));
  const double rest = std::sqrt(second(0, 0) - cross * cross / first(0, 0));
  const double wall = safe_set.bounds.upper[0];
  const double mean_then = bounds.surrogates[2].law.mean[0];
  double both_safe = 0.0;
  constexpr int kSteps = 4000;
  const double low = mean[0] - 9.0 * deviation;
  const double width = (wall - low) / kSteps;
  for (int i = 0; i <= kSteps; ++i) {
    const double at = low + width * i;
    const double then = mean_then + cross / first(0, 0) * (at - mean[0]);
    const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    both_safe += weight * width / 3.0 * normal_density((at - mean[0]) / deviation) / deviation *
                 normal_cumulative((wall - then) / rest);
  }
  const std::vector<double> entries = first_entry_bounds(unsafe, bounds);
  EXPECT_NEAR(entries[0], normal_cumulative((mean[0] - wall) / deviation), 1e-12);
  EXPECT_NEAR(entries[0] + entries[1], 1.0 - both_safe, 1e-9);
  EXPECT_LT(entries[0] + entries[1], 0.9 * (bounds.bounds[0].smooth + bounds.bounds[1].smooth));
}

TEST(FirstEntry, is_never_above_the_stages_shares) {
  for (const Place& place : places()) {
    const UnsafeSet unsafe(place.safe_set);
    const SurrogateBounds bounds = bounds_of(place.one.motion(), unsafe);
    const std::vector<double> entries = first_entry_bounds(unsafe, bounds);
    EXPECT_LE(sum(entries), bounds.shares.sum() + bounds.surrogates.back().leaving + 1e-12)
        << place.name;
  }
}

TEST(FirstEntry, is_what_the_horizon_is_certified_by) {
  const Case one = dubins({}, 0.0);
  const PredictedMotion motion = one.motion();
  const SafeSet safe_set = unsafe_at_the_end(one, 1, 0.03);
  for (const CertificateEffort effort : {CertificateEffort::kLeast, CertificateEffort::kEvery}) {
    const std::vector<StageCertificate> certificates =
        certify(motion, safe_set, error_budget(motion), effort);
    double stages = 0.0;
    double entries = 0.0;
    for (const StageCertificate& stage : certificates) {
      stages += stage.value;
      entries += stage.of("entry");
    }
    ASSERT_LT(entries, 0.9 * stages);
    EXPECT_DOUBLE_EQ(horizon_bound(certificates), entries);
  }
  // Where it is unknown, as in old traces, only the sum over the stages is available.
  std::vector<StageCertificate> old(3, blank_certificate());
  for (StageCertificate& stage : old) stage.value = 0.01;
  EXPECT_DOUBLE_EQ(horizon_bound(old), 0.03);
}

TEST(FirstEntry, says_nothing_of_laws_that_are_lost) {
  Case one = dubins({});
  one.plan.policy.inputs(0, 3) = std::nan("");
  SafeSet safe_set = unbounded_safe_set(3);
  safe_set.bounds.upper[1] = 5.0;
  const UnsafeSet unsafe(safe_set);
  const std::vector<double> entries = first_entry_bounds(unsafe, bounds_of(one.motion(), unsafe));
  ASSERT_EQ(entries.size(), 8U);
  EXPECT_LT(entries[2], 1.0);
  for (std::size_t k = 3; k < 8; ++k) EXPECT_EQ(entries[k], 1.0) << k;
}

}  // namespace first_entry_test
}  // namespace qsmpc::controller
