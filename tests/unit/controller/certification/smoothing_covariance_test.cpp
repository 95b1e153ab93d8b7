#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "models/linear_algebra.hpp"
#include "tests/unit/controller/certification/surrogate_cases.hpp"

namespace qsmpc::controller {
namespace smoothing_covariance_test {

using namespace testing;

TEST(Smoothing, is_a_part_of_the_surrogate) {
  Generator generator(115);
  for (const Case& one : all_cases(generator)) {
    const PredictedMotion motion = one.motion();
    const std::vector<SurrogateStage> stages = affine_surrogates(motion);
    const Eigen::Index dim = motion.belief.mean.size();
    for (Eigen::Index k = 1; k < static_cast<Eigen::Index>(stages.size()); ++k) {
      for (Eigen::Index axis = 0; axis < dim; ++axis) {
        const std::vector<Eigen::Index> axes = {0, axis};
        const Eigen::MatrixXd smoothing = smoothing_covariance(motion, k, axes);
        const Eigen::MatrixXd& covariance = stages[k].law.covariance;
        const auto least = [](const Eigen::MatrixXd& matrix) {
          return models::symmetric_eigenvalues(matrix)[0];
        };
        EXPECT_GE(least(smoothing), -1e-15) << one.name;
        // n is independent of the rest only in the coordinates of `axes`.
        const Eigen::MatrixXd rest = covariance - smoothing;
        EXPECT_GE(least(rest(axes, axes)), -1e-14 * covariance.trace())
            << one.name << ", stage " << k << ", axis " << axis;
        EXPECT_GT(smoothing(0, 0), 0.0);
      }
    }
  }
}

TEST(Smoothing, has_the_known_form_for_the_known_example) {
  // Nothing is correlated: in open loop all noise of the belief and of the stages in the position
  // counts; with feedback that of the last two noises, at first the belief and one noise.
  const std::vector<Eigen::Index> position = {0, 1};
  const std::vector<Eigen::Index> all = {0, 1, 2};
  const Eigen::Matrix3d noise = Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal();
  Eigen::Matrix3d planar = noise;
  planar(2, 2) = 0.0;
  const Case open = dubins({});
  const Case closed = dubins({.closed_loop = true});
  for (Eigen::Index k = 1; k <= 8; ++k) {
    const double steps = static_cast<double>(k);
    for (const auto& axes : {position, all}) {
      EXPECT_LE((smoothing_covariance(open.motion(), k, axes) - (steps + 1.0) * planar).norm(),
                1e-15);
    }
    EXPECT_LE((smoothing_covariance(closed.motion(), k, position) - 2.0 * planar).norm(), 1e-15);
    EXPECT_EQ(smoothing_covariance(closed.motion(), k, all), noise);
    EXPECT_EQ(smoothing_covariance(closed.motion(), k, {2}), noise);
  }
  const Case cart = cart_pole({});
  EXPECT_EQ(smoothing_covariance(cart.motion(), 3, {0}), cart.settings.noise_covariance);
}

// Feedback moves the headings with the position, however gently.
TEST(Smoothing, does_not_depend_on_the_size_of_the_gains) {
  const std::vector<Eigen::Index> position = {0, 1};
  const std::vector<Eigen::Index> all = {0, 1, 2};
  const Eigen::RowVector3d gain(0.2, -1.0, -1.5);
  const Case stiff = dubins({.closed_loop = true, .gain = gain});
  const Case gentle = dubins({.closed_loop = true, .gain = 0.01 * gain});
  for (Eigen::Index k = 1; k <= 8; ++k) {
    for (const auto& axes : {position, all}) {
      EXPECT_EQ(smoothing_covariance(gentle.motion(), k, axes),
                smoothing_covariance(stiff.motion(), k, axes))
          << k;
    }
  }
}

TEST(Smoothing, leaves_out_what_moves_a_restricted_heading) {
  Generator generator(117);
  const Case one = skewed_dubins({}, generator);
  const auto beside = [](const Eigen::MatrixXd& covariance) {
    const Eigen::Vector2d cross = covariance.col(2).head<2>();
    return Eigen::Matrix2d(covariance.topLeftCorner<2, 2>() -
                           cross * cross.transpose() / covariance(2, 2));
  };
  const Eigen::Matrix2d expected =
      beside(one.belief.covariance) + 3.0 * beside(one.settings.noise_covariance);
  const Eigen::MatrixXd smoothing = smoothing_covariance(one.motion(), 3, {0, 2});
  EXPECT_LE((smoothing.topLeftCorner<2, 2>() - expected).norm(), 1e-15);
  EXPECT_EQ(smoothing.row(2), Eigen::RowVector3d::Zero());
}

/// The part of the positions in `draws` that is independent of their headings, under `covariance`.
Points beside_heading(const Points& draws, const Eigen::MatrixXd& covariance) {
  const Eigen::Vector2d slope = covariance.col(2).head<2>() / covariance(2, 2);
  return draws.topRows(2) - slope * draws.row(2);
}

TEST(Smoothing, is_independent_of_the_error_and_of_the_rest) {
  // n assembled from the draws, compared with z − n, the error of the position, and the squares of
  // both: none may be correlated.
  Generator generator(116);
  for (const bool closed_loop : {false, true}) {
    const Case one = skewed_dubins({.closed_loop = closed_loop}, generator);
    const PredictedMotion motion = one.motion();
    const std::vector<SurrogateStage> stages = affine_surrogates(motion);
    const Pairs pairs = simulate_pairs(motion, stages, generator);
    for (Eigen::Index k = 1; k <= 8; ++k) {
      Points part = pairs.noise[k].topRows(2);
      const Eigen::Index first = closed_loop ? std::max<Eigen::Index>(k - 1, 0) : 0;
      for (Eigen::Index j = k - 1; j >= first; --j) {
        part += beside_heading(pairs.noise[j],
                               j == 0 ? motion.belief.covariance : motion.noise_covariance);
      }
      const Eigen::Matrix2d expected =
          smoothing_covariance(motion, k, {0, 1}).topLeftCorner<2, 2>();
      const double five = 5.0 / std::sqrt(kSamples);
      EXPECT_LE((sample_covariance(part, part) - expected).cwiseAbs().maxCoeff(),
                1.5 * five * expected.diagonal().maxCoeff());
      Points others(8, kSamples);
      others << pairs.surrogate[k].topRows(2) - part,
          (pairs.state[k] - pairs.surrogate[k]).topRows(2), Points::Zero(4, kSamples);
      others.bottomRows(4) = others.topRows(4).cwiseAbs2();
      const Eigen::MatrixXd both = sample_covariance(part, others);
      const Eigen::VectorXd spread = sample_covariance(others, others).diagonal().cwiseSqrt();
      for (Eigen::Index i = 0; i < 2; ++i) {
        for (Eigen::Index j = 0; j < others.rows(); ++j) {
          EXPECT_LE(std::abs(both(i, j)), five * std::sqrt(expected(i, i)) * spread[j])
              << closed_loop << ", stage " << k << ", " << j;
        }
      }
    }
  }
}

}  // namespace smoothing_covariance_test
}  // namespace qsmpc::controller
