#include "controller/regions/box_part_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "controller/certification/affine_surrogate.hpp"
#include "controller/measure/normal/bivariate_normal.hpp"
#include "controller/measure/normal/normal_distribution.hpp"
#include "controller/regions/box_part_norm_bound.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"
#include "tests/unit/controller/planning/planner_fixture.hpp"

namespace qsmpc::controller {
namespace unsafe_region_bound_test {

using namespace testing;
constexpr int kSamples = 20000;

bool inside(const Box& box, const Eigen::VectorXd& point) {
  return (point.array() >= box.lower.array()).all() && (point.array() <= box.upper.array()).all();
}

/// The parts of the unsafe set: half-spaces and boxes.
std::vector<BoxPart> parts_of(const SafeSet& room) {
  std::vector<BoxPart> parts = half_spaces(room.bounds);
  for (const Obstacle& obstacle : room.obstacles) parts.push_back(box_part(*obstacle.box()));
  return parts;
}

BoxPart part_of(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  BoxPart part{.box = {.lower = lower, .upper = upper}, .axes = {}};
  for (Eigen::Index axis = 0; axis < lower.size(); ++axis) {
    if (std::isfinite(lower[axis]) || std::isfinite(upper[axis])) part.axes.push_back(axis);
  }
  return part;
}

TEST(UnsafeParts, are_the_unsafe_set) {
  Generator generator(121);
  for (int repetition = 0; repetition < 40; ++repetition) {
    SafeSet room = unbounded_safe_set(3);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (uniform(generator, 0.0, 1.0) < 0.5) room.bounds.lower[axis] = -1.0;
      if (uniform(generator, 0.0, 1.0) < 0.5) room.bounds.upper[axis] = 1.0;
    }
    for (int obstacle = 0; obstacle < repetition % 3; ++obstacle) {
      const Eigen::VectorXd corner = random_matrix(generator, 3, 1);
      room.obstacles.push_back(Box{.lower = corner, .upper = corner.array() + 0.7});
      std::get<Box>(room.obstacles.back().form).upper[repetition % 2] = kInfinity;
    }
    const std::vector<BoxPart> parts = parts_of(room);
    for (const BoxPart& part : parts) {
      EXPECT_EQ(part.axes, part_of(part.box.lower, part.box.upper).axes);
      EXPECT_FALSE(part.axes.empty());
    }
    for (int i = 0; i < 200; ++i) {
      const Eigen::VectorXd point = random_matrix(generator, 3, 1, 1.5);
      const bool in_parts = std::any_of(
          parts.begin(), parts.end(), [&](const BoxPart& part) { return inside(part.box, point); });
      EXPECT_EQ(in_parts, distance_to_unsafe(point, room) == 0.0);
    }
  }
}

/// z = y + n, with an error that is a function of y.
struct Perturbed {
  Eigen::VectorXd mean;
  Eigen::MatrixXd rest;  ///< covariance of y
  Eigen::MatrixXd smoothing;
};

/// Errors of an adversary who knows y and the part.
enum class Adversary {
  kPushesWhoIsNear,  ///< to the part's nearest point and slightly beyond
  kPushesAll,        ///< a constant shift towards the part
  kPullsBoth,        ///< randomly to and fro, which only shows in second order
};
constexpr Adversary kAdversaries[] = {Adversary::kPushesWhoIsNear, Adversary::kPushesAll,
                                      Adversary::kPullsBoth};

Eigen::VectorXd error_at(Adversary adversary, const Eigen::VectorXd& y, const BoxPart& part,
                         double size, Generator& generator) {
  const Eigen::VectorXd across = y.cwiseMax(part.box.lower).cwiseMin(part.box.upper) - y;
  const double distance = across.norm();
  switch (adversary) {
    case Adversary::kPushesWhoIsNear:
      return distance < 3.0 * size ? Eigen::VectorXd(1.1 * across)
                                   : Eigen::VectorXd(Eigen::VectorXd::Zero(y.size()));
    case Adversary::kPushesAll:
      return distance > 0.0 ? Eigen::VectorXd(size / distance * across)
                            : Eigen::VectorXd(Eigen::VectorXd::Zero(y.size()));
    case Adversary::kPullsBoth:
      break;
  }
  Eigen::VectorXd error = random_matrix(generator, y.size(), 1);
  return error.cwiseSign() * size;
}

/// The rate at which z + e is in the part, and the root mean squares of e, over the same draws.
struct Attack {
  double frequency = 0.0;
  Eigen::VectorXd error;
};

Attack attack(const Perturbed& state, const BoxPart& part, Adversary adversary, double size,
              Generator& generator) {
  NormalSampler known(state.rest);
  NormalSampler smooth(state.smoothing);
  Attack result{.error = Eigen::VectorXd::Zero(state.mean.size())};
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::VectorXd y = state.mean + known(generator);
    const Eigen::VectorXd error = error_at(adversary, y, part, size, generator);
    if (inside(part.box, y + smooth(generator) + error)) result.frequency += 1.0 / kSamples;
    result.error += error.cwiseAbs2() / kSamples;
  }
  result.error = result.error.cwiseSqrt();
  return result;
}

Perturbed random_state(Generator& generator, Eigen::Index dim, bool diagonal) {
  Perturbed state{
      .mean = random_matrix(generator, dim, 1),
      .rest = random_spd(generator, dim, std::pow(10.0, uniform(generator, -2.5, -0.5))),
      .smoothing = random_spd(generator, dim, std::pow(10.0, uniform(generator, -2.5, -0.5)))};
  if (diagonal) {
    state.rest = state.rest.diagonal().asDiagonal();
    state.smoothing = state.smoothing.diagonal().asDiagonal();
  }
  return state;
}

/// A face, a slab or a box somewhere beside the mean.
BoxPart random_part(Generator& generator, const Perturbed& state) {
  const Eigen::Index dim = state.mean.size();
  Eigen::VectorXd lower = state.mean + random_matrix(generator, dim, 1);
  Eigen::VectorXd upper = lower + Eigen::VectorXd(random_matrix(generator, dim, 1).cwiseAbs());
  const int free = static_cast<int>(uniform(generator, 0.0, static_cast<double>(dim)));
  for (int axis = 0; axis < free; ++axis) {
    lower[axis] = -kInfinity;
    upper[axis] = kInfinity;
  }
  if (uniform(generator, 0.0, 1.0) < 0.3) upper[dim - 1] = kInfinity;
  return part_of(lower, upper);
}

TEST(PartBounds, hold_under_adversarial_errors) {
  Generator generator(122);
  int informative = 0;
  for (int repetition = 0; repetition < 120; ++repetition) {
    const Eigen::Index dim = 2 + repetition % 2;
    const Perturbed state = random_state(generator, dim, repetition % 3 == 0);
    const BoxPart part = random_part(generator, state);
    const Gaussian law{.mean = state.mean, .covariance = state.rest + state.smoothing};
    const double size =
        std::sqrt(state.smoothing(0, 0)) * std::pow(10.0, uniform(generator, -1.5, 0.3));
    const Adversary adversary = kAdversaries[repetition % std::size(kAdversaries)];
    const Attack truth = attack(state, part, adversary, size, generator);
    const PerturbedGaussian bounded{.law = law, .error = truth.error, .smoothing = state.smoothing};
    const double markov = markov_region_bound(bounded, part);
    const double smooth = smooth_region_bound(bounded, part);
    // Five standard errors of the frequency; the errors' root mean squares are taken from the
    // draws.
    const double allowance =
        5.0 * std::sqrt(truth.frequency * (1.0 - truth.frequency) / kSamples) + 1e-15;
    EXPECT_GE(markov, truth.frequency - allowance) << repetition;
    EXPECT_GE(smooth, truth.frequency - allowance) << repetition;
    EXPECT_LE(markov, 1.0);
    EXPECT_LE(smooth, 1.0);
    if (truth.frequency > 1e-3 && std::min(markov, smooth) < 0.9) ++informative;
  }
  EXPECT_GT(informative, 20);
}

TEST(TailBound, holds_under_adversarial_errors) {
  Generator generator(129);
  int informative = 0;
  for (int repetition = 0; repetition < 60; ++repetition) {
    const Perturbed state = random_state(generator, 2, repetition % 3 == 0);
    const BoxPart part = random_part(generator, state);
    const Gaussian law{.mean = state.mean, .covariance = state.rest + state.smoothing};
    // The worst error of a given size: straight towards the part, wherever the state is.
    const double size =
        std::sqrt(state.smoothing(0, 0)) * std::pow(10.0, uniform(generator, -1.5, 0.3));
    NormalSampler draw(law.covariance);
    double frequency = 0.0;
    std::array<Eigen::VectorXd, kHigherOrders.size()> norms;
    norms.fill(Eigen::VectorXd::Zero(2));
    for (int i = 0; i < kSamples; ++i) {
      const Eigen::VectorXd z = law.mean + draw(generator);
      const Eigen::VectorXd towards = z.cwiseMax(part.box.lower).cwiseMin(part.box.upper) - z;
      const double reach = size * std::abs(uniform(generator, -1.0, 1.0));
      const Eigen::VectorXd error = towards.norm() <= reach ? towards : Eigen::VectorXd(0.0 * z);
      if (inside(part.box, z + error)) frequency += 1.0 / kSamples;
      for (std::size_t k = 0; k < norms.size(); ++k) {
        norms[k] += error.array().pow(kHigherOrders[k]).matrix() / kSamples;
      }
    }
    const double allowance = 5.0 * std::sqrt(frequency * (1.0 - frequency) / kSamples) + 1e-15;
    for (std::size_t k = 0; k < norms.size(); ++k) {
      const Eigen::VectorXd root = norms[k].array().pow(1.0 / kHigherOrders[k]).matrix();
      const double tail = tail_region_bound(law, root, kHigherOrders[k], part);
      EXPECT_GE(tail, frequency - allowance) << repetition;
      EXPECT_GE(far_region_bound(law, root, kHigherOrders[k], part, 1e-3), frequency - allowance);
      if (frequency > 1e-3 && tail < 0.9) ++informative;
    }
  }
  EXPECT_GT(informative, 20);
}

TEST(TailBound, says_one_where_nothing_is_known_and_nearly_nothing_far_away) {
  const Gaussian law{.mean = Eigen::Vector2d::Zero(), .covariance = Eigen::Matrix2d::Identity()};
  const BoxPart far =
      part_of(Eigen::Vector2d(10.0, -kInfinity), Eigen::Vector2d(kInfinity, kInfinity));
  const Eigen::Vector2d small(0.05, 0.05);
  EXPECT_LT(far_region_bound(law, small, 8, far, 1e-8), 1e-8);
  EXPECT_EQ(tail_region_bound(law, Eigen::Vector2d(kInfinity, 0.05), 8, far), 1.0);
  EXPECT_EQ(far_region_bound(law, Eigen::Vector2d(kInfinity, 0.05), 8, far, 1e-8), 1.0);
}

TEST(SmoothBound, holds_for_an_error_along_one_axis_of_a_correlated_part) {
  // n moves along the diagonal, the part lies beside the diagonal through y, and the error is along
  // one axis only, onto it: the probability's second derivative in that direction is governed by
  // the extent of n across the diagonal, which is narrow.
  const Perturbed state{.mean = Eigen::Vector2d(0.1, 0.0),
                        .rest = Eigen::Matrix2d::Zero(),
                        .smoothing = Eigen::Matrix2d{{1.0, 0.9999}, {0.9999, 1.0}}};
  const BoxPart part = part_of(Eigen::Vector2d(0.0, -kInfinity), Eigen::Vector2d(kInfinity, -0.2));
  const Eigen::Vector2d error(0.3, 0.0);
  const double truth =
      rectangle_probability(state.mean + error, state.smoothing, part.box.lower, part.box.upper);
  EXPECT_GT(truth, 0.05);
  const Gaussian law{.mean = state.mean, .covariance = state.smoothing};
  const Eigen::VectorXd bound = error;
  EXPECT_GE(smooth_region_bound({.law = law, .error = bound, .smoothing = state.smoothing}, part),
            truth);
}

TEST(SmoothBound, counts_an_error_along_one_axis_once) {
  // The other coordinate has neither error nor smoothing, like the heading of an open-loop
  // unicycle.
  const Gaussian law{.mean = Eigen::Vector2d::Zero(),
                     .covariance = Eigen::Vector2d(1.0, 0.04).asDiagonal()};
  const Eigen::VectorXd error = Eigen::Vector2d(0.05, 0.0);
  const Eigen::MatrixXd smoothing = Eigen::Vector2d(0.5, 0.0).asDiagonal();
  const BoxPart part = part_of(Eigen::Vector2d(1.0, 0.3), Eigen::Vector2d(2.0, 0.6));
  const double bound =
      smooth_region_bound({.law = law, .error = error, .smoothing = smoothing}, part);
  const double slab = smooth_region_bound(
      {.law = law, .error = error, .smoothing = smoothing},
      part_of(Eigen::Vector2d(1.0, -kInfinity), Eigen::Vector2d(2.0, kInfinity)));
  EXPECT_GE(bound, normal_probability(1.0, 2.0) * normal_probability(1.5, 3.0));
  EXPECT_LT(bound, 0.3 * slab);
}

TEST(MarkovBound, is_attained_by_the_worst_error) {
  // Moves all of (c, 2) onto the wall at 2: the most that E e² = ∫(2 − y)² φ dy can move. The bound
  // is the dual of this problem.
  const Gaussian law{.mean = Eigen::VectorXd::Zero(1), .covariance = Eigen::MatrixXd::Ones(1, 1)};
  const BoxPart wall =
      part_of(Eigen::VectorXd::Constant(1, 2.0), Eigen::VectorXd::Constant(1, kInfinity));
  for (const double c : {1.99, 1.9, 1.5, 1.0}) {
    // Cumulative moments of the normal density between c and 2.
    const double mass = normal_probability(c, 2.0);
    const double first = normal_density(c) - normal_density(2.0);
    const double second = mass + c * normal_density(c) - 2.0 * normal_density(2.0);
    const Eigen::VectorXd error =
        Eigen::VectorXd::Constant(1, std::sqrt(4.0 * mass - 4.0 * first + second));
    const double worst = normal_cumulative(-c);
    const double bound = markov_region_bound(
        {.law = law, .error = error, .smoothing = Eigen::MatrixXd::Zero(1, 1)}, wall);
    EXPECT_GE(bound, worst * (1.0 - 1e-9)) << c;  // cancellation in the error
    EXPECT_LE(bound, 1.05 * worst) << c;          // the search for t
  }
}

TEST(PartBounds, without_error_are_the_probability) {
  Generator generator(123);
  for (int repetition = 0; repetition < 50; ++repetition) {
    const Perturbed state = random_state(generator, 2, false);
    const Gaussian law{.mean = state.mean, .covariance = state.rest + state.smoothing};
    const Eigen::VectorXd none = Eigen::Vector2d::Zero();
    const PerturbedGaussian exact{.law = law, .error = none, .smoothing = state.smoothing};
    const Eigen::VectorXd lower = state.mean + random_matrix(generator, 2, 1);
    const BoxPart box = part_of(lower, lower.array() + 0.5);
    const double in_box =
        rectangle_probability(law.mean, law.covariance, box.box.lower, box.box.upper);
    EXPECT_GE(smooth_region_bound(exact, box), in_box);
    EXPECT_LE(smooth_region_bound(exact, box), in_box + rectangle_error(law.covariance));
    EXPECT_GE(markov_region_bound(exact, box), in_box);

    const BoxPart face =
        part_of(Eigen::Vector2d(lower[0], -kInfinity), Eigen::Vector2d(kInfinity, kInfinity));
    const double deviation = std::sqrt(law.covariance(0, 0));
    const double behind = normal_cumulative((law.mean[0] - lower[0]) / deviation);
    EXPECT_NEAR(smooth_region_bound(exact, face), behind, 1e-15);
    // The probability within the least reach, 1e-4, before the wall.
    EXPECT_GE(markov_region_bound(exact, face), behind);
    EXPECT_LE(markov_region_bound(exact, face), behind + 1e-4 / deviation);
  }
}

TEST(PartBounds, grow_with_the_error) {
  Generator generator(124);
  for (int repetition = 0; repetition < 30; ++repetition) {
    const Perturbed state = random_state(generator, 3, false);
    const BoxPart part = random_part(generator, state);
    const Gaussian law{.mean = state.mean, .covariance = state.rest + state.smoothing};
    double markov = 0.0;
    double smooth = 0.0;
    for (double size = 1e-6; size < 10.0; size *= 3.0) {
      const Eigen::VectorXd error = Eigen::Vector3d::Constant(size);
      const PerturbedGaussian bounded{.law = law, .error = error, .smoothing = state.smoothing};
      const double next_markov = markov_region_bound(bounded, part);
      const double next_smooth = smooth_region_bound(bounded, part);
      EXPECT_GE(next_markov, 0.98 * markov);  // the search for t is good to 2 %
      EXPECT_GE(next_smooth, smooth);
      markov = next_markov;
      smooth = next_smooth;
    }
    EXPECT_GT(markov, 0.9);
    EXPECT_EQ(smooth, 1.0);
  }
}

TEST(PartBounds, say_one_where_nothing_is_known) {
  const double nan = std::nan("");
  const Gaussian law{.mean = Eigen::Vector2d::Zero(), .covariance = Eigen::Matrix2d::Identity()};
  const Eigen::MatrixXd smoothing = 0.5 * Eigen::Matrix2d::Identity();
  const Eigen::MatrixXd none = Eigen::Matrix2d::Zero();
  const BoxPart face =
      part_of(Eigen::Vector2d(5.0, -kInfinity), Eigen::Vector2d(kInfinity, kInfinity));
  const BoxPart box = part_of(Eigen::Vector2d(5.0, 5.0), Eigen::Vector2d(6.0, 6.0));
  for (const BoxPart& part : {face, box}) {
    for (const double error : {kInfinity, nan}) {
      const Eigen::VectorXd unknown = Eigen::Vector2d::Constant(error);
      const PerturbedGaussian state{.law = law, .error = unknown, .smoothing = smoothing};
      EXPECT_EQ(markov_region_bound(state, part), 1.0);
      EXPECT_EQ(smooth_region_bound(state, part), 1.0);
    }
    const Eigen::VectorXd small = Eigen::Vector2d::Constant(0.01);
    EXPECT_EQ(smooth_region_bound({.law = law, .error = small, .smoothing = none}, part), 1.0);
    Gaussian broken = law;
    broken.mean.setConstant(nan);
    EXPECT_EQ(markov_region_bound({.law = broken, .error = small, .smoothing = smoothing}, part),
              1.0);
    EXPECT_EQ(smooth_region_bound({.law = broken, .error = small, .smoothing = smoothing}, part),
              1.0);
  }
  // A coordinate that the part does not restrict may be arbitrary.
  const Eigen::VectorXd beside = Eigen::Vector2d(0.01, kInfinity);
  const PerturbedGaussian state{.law = law, .error = beside, .smoothing = smoothing};
  EXPECT_LT(markov_region_bound(state, face), 1e-3);
  EXPECT_LT(smooth_region_bound(state, face), 1e-3);
}

TEST(PartBounds, known_example_has_the_known_figures) {
  // Belief N(0, 0.01 I), u = 0.3 open loop, safe set [−1, 12]², stage 8: the truth is 2.9e-4 (1e6
  // samples); C4 was 6.6e-4 before the error was split by coordinate.
  const auto car = dubins_car();
  PlannerSettings settings = dubins_settings();
  settings.horizon = 8;
  settings.closed_loop = false;
  Planner planner(*car, settings);
  const Gaussian belief = dubins_belief();
  const Plan& plan = planner.prescribe(belief, Eigen::MatrixXd::Constant(1, 8, 0.3));
  const PredictedMotion motion = motion_of(planner, belief, plan);
  const SurrogateStage last = affine_surrogates(motion).back();
  double markov = 0.0;
  double smooth = 0.0;
  for (const BoxPart& part : parts_of(settings.safe_set)) {
    const Eigen::MatrixXd smoothing = smoothing_covariance(motion, 8, part.axes);
    const PerturbedGaussian state{.law = last.law, .error = last.error, .smoothing = smoothing};
    markov += markov_region_bound(state, part);
    smooth += smooth_region_bound(state, part);
  }
  EXPECT_GE(smooth, 2.9e-4);
  EXPECT_LT(smooth, 6.6e-4);
  EXPECT_LT(smooth, markov);
  EXPECT_LT(markov, 1e-3);
}

}  // namespace unsafe_region_bound_test
}  // namespace qsmpc::controller
