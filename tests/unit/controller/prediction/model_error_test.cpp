// Estimates of a model error from samples.
#include "controller/prediction/model_error.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace qsmpc::controller {
namespace prediction_model_error_test {

// Rounding of sums of few terms.
constexpr double kRounding = 1e-14;

Eigen::MatrixXd two_by_four() {
  Eigen::MatrixXd residuals(2, 4);
  residuals << 1.0, -1.0, 3.0, 1.0,  //
      0.0, 0.0, 0.0, 2.0;
  return residuals;
}

TEST(model_error, moments_and_norms_are_those_of_the_samples) {
  const ModelError error = model_error_of(two_by_four());
  EXPECT_NEAR(error.mean[0], 1.0, kRounding);
  EXPECT_NEAR(error.mean[1], 0.5, kRounding);
  EXPECT_NEAR(error.covariance(0, 0), 2.0, kRounding);
  EXPECT_NEAR(error.covariance(0, 1), 0.0, kRounding);
  EXPECT_NEAR(error.covariance(1, 1), 0.75, kRounding);
  EXPECT_NEAR(error.root_mean_square[0], std::sqrt(3.0), kRounding);
  EXPECT_NEAR(error.root_mean_square[1], 1.0, kRounding);
  EXPECT_NEAR(error.higher[0][0], std::pow(21.0, 0.25), kRounding);
  EXPECT_NEAR(error.higher[1][0], std::pow(1641.0, 0.125), kRounding);
  EXPECT_NEAR(error.higher[1][1], std::pow(64.0, 0.125), kRounding);
}

TEST(model_error, radius_is_the_root_mean_square_of_the_whole_unless_another_is_stated) {
  ModelError error = model_error_of(two_by_four());
  EXPECT_NEAR(error.radius(), 2.0, kRounding);
  error.stated_radius = 2.5;
  EXPECT_EQ(error.radius(), 2.5);
}

TEST(model_error, tiny_and_huge_samples_keep_their_norms) {
  for (const double scale : {1e-200, 1e200}) {
    const ModelError error = model_error_of(scale * two_by_four());
    EXPECT_NEAR(error.higher[1][0] / scale, std::pow(1641.0, 0.125), kRounding);
  }
}

TEST(model_error, widening_scales_every_norm_and_the_radius_and_no_moment) {
  ModelError error = model_error_of(two_by_four());
  error.stated_radius = 2.5;
  const ModelError wide = widened(error, 2.0);
  EXPECT_EQ(wide.root_mean_square, 2.0 * error.root_mean_square);
  EXPECT_EQ(wide.higher[0], 2.0 * error.higher[0]);
  EXPECT_EQ(wide.higher[1], 2.0 * error.higher[1]);
  EXPECT_EQ(wide.radius(), 5.0);
  EXPECT_EQ(wide.mean, error.mean);
  EXPECT_EQ(wide.covariance, error.covariance);
}

TEST(model_error, an_offset_adds_to_the_radius_coordinate_by_coordinate) {
  ModelError error = model_error_of_size(Eigen::Vector2d(1.0, 2.0));
  error.offset = Eigen::Vector2d(-2.0, 2.0);
  EXPECT_NEAR(error.radius(), 5.0, kRounding);
}

TEST(model_error, widening_reaches_the_first_periods_and_leaves_offsets_alone) {
  ModelError error = model_error_of(two_by_four());
  error.first = {error};
  error.first[0].offset = Eigen::Vector2d(0.1, -0.2);
  const ModelError wide = widened(error, 2.0);
  EXPECT_EQ(wide.first[0].root_mean_square, 2.0 * error.root_mean_square);
  EXPECT_EQ(wide.first[0].higher[1], 2.0 * error.higher[1]);
  EXPECT_EQ(wide.first[0].offset, error.first[0].offset);
}

TEST(model_error, without_higher_norms_they_are_unknown) {
  const ModelError error = model_error_of_size(Eigen::Vector2d(0.3, 0.4));
  EXPECT_NEAR(error.radius(), 0.5, kRounding);
  EXPECT_EQ(error.higher[0][1], std::numeric_limits<double>::infinity());
  EXPECT_EQ(error.mean.size(), 0);
}

TEST(model_error, without_samples_it_is_refused) {
  EXPECT_THROW((void)model_error_of(Eigen::MatrixXd(3, 0)), std::invalid_argument);
}

}  // namespace prediction_model_error_test
}  // namespace qsmpc::controller
