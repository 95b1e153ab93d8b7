#include "controller/certification/path_tilt.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "controller/certification/affine_surrogate.hpp"
#include "controller/measure/normal/normal_distribution.hpp"
#include "tests/unit/controller/certification/surrogate_cases.hpp"

namespace qsmpc::controller {
namespace path_tilt_test {

using namespace testing;

TEST(TiltGrid, dominates_the_standard_normal_density) {
  for (const double spread : {0.05, 0.15, 0.25, 0.35, 0.5, 0.8}) {
    const TiltGrid grid = tilt_grid(spread);
    for (double at = -4.0; at <= 4.0; at += 0.013) {
      double sum = 0.0;
      for (Eigen::Index i = 0; i < grid.weights.size(); ++i) {
        sum += grid.weights[i] * normal_density((at - grid.places[i]) / spread) / spread;
      }
      // Further out, places that are not listed contribute.
      const double density = normal_density(at);
      EXPECT_GE(sum, density * (1.0 - 1e-4 * (std::abs(at) > 2.0))) << spread << ' ' << at;
      EXPECT_LE(sum, 1.01 * density) << spread << ' ' << at;
    }
    EXPECT_NEAR(grid.weights.sum() + grid.left_out, 1.0, 0.01);
    EXPECT_LE(grid.left_out, 1e-4) << spread;
  }
}

/// Functionals with random weights.
PathFunctionals random_functionals(const PredictedMotion& motion, Eigen::Index count,
                                   Generator& generator) {
  PathFunctionals functionals;
  while (functionals.count() < count) {
    std::vector<Eigen::VectorXd> weights;
    for (Eigen::Index k = 0; k <= motion.policy.horizon(); ++k) {
      weights.emplace_back(random_matrix(generator, motion.belief.mean.size(), 1));
    }
    EXPECT_TRUE(add_functional(motion, weights, functionals));
  }
  return functionals;
}

/// r x samples
Points functionals_of(const std::vector<Points>& noise, const PathFunctionals& functionals) {
  Points values = Points::Zero(functionals.count(), noise[0].cols());
  for (std::size_t j = 0; j < noise.size(); ++j) {
    values += functionals.weights[j].transpose() * noise[j];
  }
  return values;
}

/// Draws of the plain law turned into draws of the tilted one: the functionals are moved, and the
/// noise with them.
std::vector<Points> tilted(std::vector<Points> noise, const PathTilt& tilt) {
  const Points plain = functionals_of(noise, tilt.functionals);
  const Points wanted = (tilt.spreads.asDiagonal() * plain).colwise() + tilt.centre;
  for (std::size_t j = 0; j < noise.size(); ++j) {
    noise[j] += tilt.functionals.moves[j] * (wanted - plain);
  }
  return noise;
}

TEST(PathFunctionals, are_uncorrelated_and_of_variance_one) {
  Generator generator(211);
  const Case one = skewed_dubins({.closed_loop = true}, generator);
  const PredictedMotion motion = one.motion();
  const PathFunctionals functionals = random_functionals(motion, 3, generator);
  const Points values = functionals_of(draw_noise(motion, generator), functionals);
  EXPECT_LE((sample_covariance(values, values) - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(),
            0.06);
  // A functional that is already present adds nothing.
  std::vector<Eigen::VectorXd> again;
  for (const Eigen::MatrixXd& block : functionals.weights) again.emplace_back(block.col(1));
  PathFunctionals more = functionals;
  EXPECT_FALSE(add_functional(motion, again, more));
  EXPECT_EQ(more.count(), 3);
}

TEST(PathTilt, independent_part_is_what_the_other_blocks_do_not_explain) {
  Generator generator(212);
  const Case one = skewed_dubins({}, generator);
  const PredictedMotion motion = one.motion();
  const PathTilt tilt{.functionals = random_functionals(motion, 2, generator),
                      .centre = Eigen::Vector2d(0.3, -1.0),
                      .spreads = Eigen::Vector2d(0.4, 0.1)};
  // The covariance of all blocks under the tilt, written out.
  const Eigen::Index blocks = motion.policy.horizon() + 1;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(3 * blocks, 3 * blocks);
  Eigen::MatrixXd moves(3 * blocks, 2);
  for (Eigen::Index j = 0; j < blocks; ++j) {
    whole.block<3, 3>(3 * j, 3 * j) = j == 0 ? motion.belief.covariance : motion.noise_covariance;
    moves.middleRows<3>(3 * j) = tilt.functionals.moves[j];
  }
  const Eigen::Vector2d shares = 1.0 - tilt.spreads.array().square();
  whole -= moves * shares.asDiagonal() * moves.transpose();
  const Eigen::MatrixXd precision = whole.inverse();
  for (Eigen::Index j = 0; j < blocks; ++j) {
    const Eigen::Matrix3d expected = precision.block<3, 3>(3 * j, 3 * j).inverse();
    const Eigen::MatrixXd part =
        independent_part(j == 0 ? motion.belief.covariance : motion.noise_covariance, tilt, j);
    EXPECT_LE((part - expected).norm(), 1e-9 * expected.norm()) << j;
  }
}

/// Tilts of one functional and of two.
std::vector<PathTilt> some_tilts(const PredictedMotion& motion, Generator& generator) {
  std::vector<PathTilt> tilts;
  for (const double spread : {0.25, 0.6}) {
    tilts.push_back({.functionals = random_functionals(motion, 1, generator),
                     .centre = Eigen::VectorXd::Constant(1, 1.3),
                     .spreads = Eigen::VectorXd::Constant(1, spread)});
  }
  tilts.push_back({.functionals = random_functionals(motion, 2, generator),
                   .centre = Eigen::Vector2d(-0.8, 0.5),
                   .spreads = Eigen::Vector2d(0.35, 0.2)});
  return tilts;
}

std::vector<Eigen::VectorXd> shifts_of(const PathTilt& tilt) {
  std::vector<Eigen::VectorXd> shifts;
  for (const Eigen::MatrixXd& moves : tilt.functionals.moves)
    shifts.emplace_back(moves * tilt.centre);
  return shifts;
}

TEST(PathTilt, surrogate_has_the_law_and_the_error_of_simulated_paths) {
  Generator generator(213);
  for (const Case& one : all_cases(generator)) {
    const PredictedMotion motion = one.motion();
    for (const PathTilt& tilt : some_tilts(motion, generator)) {
      const std::vector<SurrogateStage> stages = affine_surrogates(motion, kWideCore, tilt);
      const Pairs pairs =
          pairs_under(motion, stages, tilted(draw_noise(motion, generator), tilt), shifts_of(tilt));
      for (std::size_t k = 0; k < stages.size(); ++k) {
        const Gaussian& law = stages[k].law;
        const Eigen::VectorXd deviation = law.covariance.diagonal().cwiseSqrt();
        const Eigen::VectorXd mean = pairs.surrogate[k].rowwise().mean();
        const Eigen::MatrixXd covariance =
            sample_covariance(pairs.surrogate[k], pairs.surrogate[k]);
        const double five = 5.0 / std::sqrt(kSamples);
        if (k > 0) {
          const Eigen::VectorXd before = stages[k - 1].law.covariance.diagonal().cwiseSqrt();
          const Eigen::MatrixXd apart =
              sample_covariance(pairs.surrogate[k], pairs.surrogate[k - 1]) - stages[k].with_last;
          const Eigen::ArrayXXd allowed =
              (1.5 * five * deviation * before.transpose()).array() + 1e-12;
          EXPECT_TRUE((apart.array().abs() <= allowed).all()) << one.name << k;
        }
        const Eigen::VectorXd distance = root_mean_squares(pairs.state[k] - pairs.surrogate[k]);
        for (Eigen::Index i = 0; i < mean.size(); ++i) {
          EXPECT_NEAR(mean[i], law.mean[i], five * deviation[i] + 1e-12) << one.name << k;
          EXPECT_NEAR(covariance(i, i), law.covariance(i, i),
                      1.5 * five * deviation[i] * deviation[i] + 1e-12)
              << one.name << k;
          // Five standard errors of a mean of squares, bounded by the fourth powers.
          const double fourth = stages[k].higher[0][i];
          EXPECT_LE(distance[i] * distance[i],
                    stages[k].error[i] * stages[k].error[i] + five * fourth * fourth + 1e-26)
              << one.name << k << i;
        }
      }
    }
  }
}

TEST(PathTilt, smoothing_is_independent_of_the_error_and_of_the_rest) {
  // x − z and z − n must not change with n: compared with the part of the last noise alone.
  Generator generator(214);
  for (const bool closed_loop : {false, true}) {
    const Case one = skewed_dubins({.closed_loop = closed_loop}, generator);
    const PredictedMotion motion = one.motion();
    for (const PathTilt& tilt : some_tilts(motion, generator)) {
      const std::vector<SurrogateStage> stages = affine_surrogates(motion, kWideCore, tilt);
      const std::vector<Points> noise = tilted(draw_noise(motion, generator), tilt);
      const Pairs pairs = pairs_under(motion, stages, noise, shifts_of(tilt));
      for (Eigen::Index k = 1; k <= motion.policy.horizon(); ++k) {
        // The part of the last noise that regression on the earlier noise does not explain.
        Points before(3 * k, kSamples);
        for (Eigen::Index j = 0; j < k; ++j) before.middleRows(3 * j, 3) = noise[j];
        const Points rest = before.colwise() - before.rowwise().mean();
        const Points last = noise[k].colwise() - noise[k].rowwise().mean();
        const Eigen::MatrixXd slope =
            (rest * rest.transpose()).ldlt().solve(rest * last.transpose()).transpose();
        const Points part = last - slope * rest;
        const Eigen::MatrixXd covariance = sample_covariance(part, part);
        const Eigen::MatrixXd smoothing = smoothing_covariance(motion, k, {0, 1, 2}, tilt);
        // Correlated later noise explains more of it, but has not entered the state yet.
        const Eigen::MatrixXd more = covariance - smoothing;
        if (closed_loop) {
          EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(more).eigenvalues().minCoeff(),
                    -0.1 * covariance.norm())
              << k;
        }
        EXPECT_LE((smoothing - stages[k].law.covariance).diagonal().maxCoeff(), 1e-12) << k;
      }
    }
  }
}

TEST(PathTilt, that_concerns_headings_alone_leaves_what_smooths_beside_them) {
  Generator generator(215);
  const Case one = skewed_dubins({}, generator);
  const PredictedMotion motion = one.motion();
  std::vector<Eigen::VectorXd> weights(9, Eigen::Vector3d(0.0, 0.0, 1.0));
  const Eigen::VectorXd narrow = Eigen::VectorXd::Constant(1, 0.25);
  PathTilt tilt{.functionals = {}, .centre = Eigen::VectorXd::Zero(1), .spreads = narrow};
  ASSERT_TRUE(add_functional(motion, weights, tilt.functionals));
  EXPECT_LE((smoothing_covariance(motion, 5, {0, 1, 2}, tilt) -
             smoothing_covariance(motion, 5, {0, 1, 2}))
                .norm(),
            1e-12);
  // For a functional of positions, only the noise that it does not involve is left.
  weights.assign(9, Eigen::Vector3d::Zero());
  weights[0] = Eigen::Vector3d(1.0, 0.0, 0.0);
  PathTilt first{.functionals = {}, .centre = Eigen::VectorXd::Zero(1), .spreads = narrow};
  ASSERT_TRUE(add_functional(motion, weights, first.functionals));
  const double left = smoothing_covariance(motion, 5, {0, 1, 2}, first)(0, 0);
  const double before = smoothing_covariance(motion, 5, {0, 1, 2})(0, 0);
  EXPECT_LT(left, before);
  EXPECT_GT(left, 0.0);
}

}  // namespace path_tilt_test
}  // namespace qsmpc::controller
