#include "controller/certification/unicycle_surrogate.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/controller/random_measures.hpp"

namespace qsmpc::testing {
namespace {

struct Walk {
  UnicycleStructure unicycle{.reach = 0.15, .input_gain = 0.1};
  Gaussian belief;
  Eigen::VectorXd inputs;
  Eigen::MatrixXd noise;
};

Walk random_walk(Generator& generator, int horizon) {
  Walk walk;
  walk.belief = {.mean = random_matrix(generator, 3, 1),
                 .covariance = random_spd(generator, 3, 0.05)};
  walk.inputs = random_matrix(generator, horizon, 1, 2.0);
  walk.noise = random_spd(generator, 3, 0.02);
  return walk;
}

/// Sample moments of the last stage's state and surrogate, both driven by the same draws.
struct Simulated {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  double squares = 0.0;  // E|x − surrogate|²
};

Simulated simulate(const Walk& walk, int samples, Generator& generator) {
  NormalSampler belief(walk.belief.covariance);
  NormalSampler noise(walk.noise);
  Simulated result;
  for (int i = 0; i < samples; ++i) {
    Eigen::Vector3d state = walk.belief.mean + belief(generator);
    Eigen::Vector3d surrogate = state;
    double heading = walk.belief.mean[2];
    double variance = walk.belief.covariance(2, 2);
    for (const double input : walk.inputs) {
      const Eigen::Vector3d disturbance = noise(generator);
      const double phi = state[2];
      const double offset = phi - heading;
      const double shrink = std::exp(-0.5 * variance);
      state.head<2>() += walk.unicycle.reach * Eigen::Vector2d(std::cos(phi), std::sin(phi));
      surrogate.head<2>() += walk.unicycle.reach * shrink *
                             Eigen::Vector2d(std::cos(heading) - std::sin(heading) * offset,
                                             std::sin(heading) + std::cos(heading) * offset);
      state[2] += walk.unicycle.input_gain * input;
      state += disturbance;
      surrogate[2] = phi + walk.unicycle.input_gain * input;
      surrogate += disturbance;
      heading += walk.unicycle.input_gain * input;
      variance += walk.noise(2, 2);
    }
    result.mean += surrogate / samples;
    result.second += surrogate * surrogate.transpose() / samples;
    result.squares += (state - surrogate).squaredNorm() / samples;
  }
  return result;
}

TEST(UnicycleSurrogate, law_and_radius_match_simulation) {
  Generator generator(71);
  for (const int horizon : {1, 3, 8}) {
    const Walk walk = random_walk(generator, horizon);
    const GaussianSurrogate last =
        unicycle_surrogates(walk.unicycle, walk.belief, walk.inputs, walk.noise).back();
    const Simulated simulated = simulate(walk, 1000000, generator);
    // The squared residual is heavy-tailed (of fourth order in a normal variable): its mean has a
    // standard error of some 0.3 % at 1e6 samples.
    EXPECT_NEAR(last.radius, std::sqrt(simulated.squares), 0.02 * last.radius) << horizon;
    // Standard errors of mean and covariance are at most 1e-3 of the deviation and variance.
    const double scale = last.law.covariance.trace();
    EXPECT_LE((last.law.mean - simulated.mean).norm(), 5e-3 * std::sqrt(scale)) << horizon;
    const Eigen::Matrix3d covariance =
        simulated.second - simulated.mean * simulated.mean.transpose();
    EXPECT_LE((last.law.covariance - covariance).norm(), 5e-3 * scale) << horizon;
  }
}

TEST(UnicycleSurrogate, is_exact_for_a_heading_that_is_known) {
  Walk walk{.belief = {.mean = Eigen::Vector3d(1.0, 2.0, 0.5), .covariance = {}},
            .inputs = Eigen::Vector3d(0.3, -0.2, 0.1),
            .noise = Eigen::Vector3d(0.01, 0.01, 0.0).asDiagonal()};
  walk.belief.covariance = Eigen::Vector3d(0.1, 0.1, 0.0).asDiagonal();
  for (const GaussianSurrogate& surrogate :
       unicycle_surrogates(walk.unicycle, walk.belief, walk.inputs, walk.noise)) {
    EXPECT_EQ(surrogate.radius, 0.0);
  }
}

TEST(UnicycleSurrogate, radius_stays_right_for_tiny_and_huge_heading_variances) {
  const auto radius_of = [](double variance) {
    Walk walk{.belief = {.mean = Eigen::Vector3d::Zero(), .covariance = Eigen::Matrix3d::Zero()},
              .inputs = Eigen::VectorXd::Zero(1),
              .noise = Eigen::Matrix3d::Zero()};
    walk.belief.covariance(2, 2) = variance;
    return unicycle_surrogates(walk.unicycle, walk.belief, walk.inputs, walk.noise).back().radius;
  };
  // Second order: E|r|² → v²/2; rounding is about ε/v relative.
  EXPECT_NEAR(radius_of(1e-6), 0.15 * 1e-6 / std::sqrt(2.0), 1e-5 * 0.15 * 1e-6);
  // Nothing is left of the affine fit: the whole unit vector is residual. e^v overflows from 710.
  EXPECT_NEAR(radius_of(60.0), 0.15, 1e-12);
  EXPECT_NEAR(radius_of(2000.0), 0.15, 1e-12);
}

TEST(UnicycleSurrogate, known_example_has_the_known_radius) {
  // Belief N(0, 0.01 I), u = 0.3, noise diag(0.01, 0.01, 0.001), 0.15 m a step: 0.0104 at stage 8.
  const Walk walk{
      .belief = {.mean = Eigen::Vector3d::Zero(), .covariance = 0.01 * Eigen::Matrix3d::Identity()},
      .inputs = Eigen::VectorXd::Constant(8, 0.3),
      .noise = Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal()};
  const auto surrogates = unicycle_surrogates(walk.unicycle, walk.belief, walk.inputs, walk.noise);
  ASSERT_EQ(surrogates.size(), 8U);
  EXPECT_NEAR(surrogates.back().radius, 0.0104, 5e-5);  // as printed
}

}  // namespace
}  // namespace qsmpc::testing
