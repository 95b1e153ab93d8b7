#include "harness/mismatch/measured_error.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "models/random/random_numbers.hpp"

namespace qsmpc::harness {
namespace measured_error_test {

Eigen::MatrixXd normal_residuals(std::uint64_t seed, std::uint64_t unit, Eigen::Index periods,
                                 double deviation) {
  return deviation *
         models::standard_normal_sample(periods, {.seed = seed, .episode = unit}).transpose();
}

TEST(MeasuredModelError, of_residuals_that_are_all_alike_has_no_margin) {
  const std::vector<Eigen::MatrixXd> units(5, Eigen::Vector2d(0.2, -0.03).replicate(1, 4));
  const controller::ModelError error = measured_model_error({{.units = units}}, 1);
  EXPECT_TRUE(error.mean.isApprox(Eigen::Vector2d(0.2, -0.03), 1e-12));
  const Eigen::Vector2d size(0.2, 0.03);
  EXPECT_TRUE(error.root_mean_square.isApprox(size, 1e-12));
  for (const Eigen::VectorXd& norms : error.higher) EXPECT_TRUE(norms.isApprox(size, 1e-12));
}

TEST(MeasuredModelError, exceeds_the_true_norms_as_often_as_its_confidence_says) {
  int too_small = 0;
  constexpr int kRuns = 100;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    ResidualSample sample;
    for (std::uint64_t n = 0; n < 50; ++n) {
      sample.units.push_back(normal_residuals(run, n, 20, 0.3));
    }
    too_small += measured_model_error({sample}, run).root_mean_square[0] < 0.3 ? 1 : 0;
  }
  // One of 100 is expected; 6 or more have a probability of 5e-4.
  EXPECT_LE(too_small, 5);
}

// Fewer episodes give a wider margin; many periods per episode do not help if they are all alike.
TEST(MeasuredModelError, episodes_are_what_is_independent) {
  ResidualSample constant;
  ResidualSample changing;
  for (std::uint64_t n = 0; n < 20; ++n) {
    const double offset = models::standard_normal_sample(1, {.seed = 2, .episode = n})[0];
    constant.units.push_back(Eigen::MatrixXd::Constant(1, 50, offset));
    changing.units.push_back(normal_residuals(2, n, 50, 1.0));
  }
  const double of_constant = measured_model_error({constant}, 1).root_mean_square[0];
  const double of_changing = measured_model_error({changing}, 1).root_mean_square[0];
  EXPECT_GT(of_constant, 1.25);
  EXPECT_LT(of_changing, 1.15);
  EXPECT_GT(of_changing, 1.0);
}

TEST(MeasuredModelError, takes_the_worst_sample_and_the_worst_period) {
  const std::vector<Eigen::MatrixXd> small(4, Eigen::MatrixXd::Constant(1, 3, 0.1));
  Eigen::MatrixXd path(1, 3);
  path << 0.05, 0.4, 0.2;
  const ResidualSample planned{.units = std::vector<Eigen::MatrixXd>(6, path), .by_period = true};
  const controller::ModelError error = measured_model_error({{.units = small}, planned}, 1);
  EXPECT_NEAR(error.root_mean_square[0], 0.4, 1e-12);
  EXPECT_NEAR(error.higher[1][0], 0.4, 1e-12);
  EXPECT_NEAR(error.mean[0], 0.1, 1e-12) << "information on the first sample";
}

/// Two units with three periods: 0.5 ± 0.1, then 0.2, then 0.05.
std::vector<Eigen::MatrixXd> setting_out() {
  Eigen::MatrixXd one(1, 3);
  Eigen::MatrixXd other(1, 3);
  one << 0.6, 0.2, 0.05;
  other << 0.4, 0.2, 0.05;
  return {one, other};
}

TEST(MeasuredModelError, of_first_periods_is_their_own_about_their_mean) {
  const controller::ModelError error = measured_model_error({{.units = setting_out()}}, 1, 2);
  EXPECT_NEAR(error.root_mean_square[0], 0.05, 1e-12) << "of the third period alone";
  EXPECT_EQ(error.offset.size(), 0);
  ASSERT_EQ(error.first.size(), 2U);
  EXPECT_NEAR(error.first[0].offset[0], 0.5, 1e-12);
  // Both differ from the mean by 0.1 in every replicate; the mean itself is estimated from two.
  EXPECT_NEAR(error.first[0].root_mean_square[0], 0.1 * std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(error.first[0].higher[1][0], 0.1 * std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(error.first[1].offset[0], 0.2, 1e-12);
  EXPECT_NEAR(error.first[1].root_mean_square[0], 0.0, 1e-12);
}

TEST(MeasuredModelError, of_a_first_period_covers_every_sample_about_one_offset) {
  const ResidualSample loop{
      .units = std::vector<Eigen::MatrixXd>(7, Eigen::MatrixXd::Constant(1, 2, 0.3))};
  const ResidualSample planned{
      .units = std::vector<Eigen::MatrixXd>(9, Eigen::MatrixXd::Constant(1, 1, 0.1))};
  const controller::ModelError error = measured_model_error({loop, planned}, 1, 1);
  ASSERT_EQ(error.first.size(), 1U);
  EXPECT_NEAR(error.first[0].offset[0], 0.2, 1e-12);
  EXPECT_NEAR(error.first[0].root_mean_square[0], 0.1 * std::sqrt(8.0 / 6.0), 1e-12);
  EXPECT_NEAR(error.root_mean_square[0], 0.3, 1e-12) << "the other sample has no second period";
}

TEST(MeasuredModelError, of_later_periods_is_that_of_the_worst_stretch) {
  Eigen::MatrixXd unit(1, 6);
  unit << 0.9, 0.1, 0.1, 0.1, 0.7, 0.2;
  const ResidualSample sample{
      .units = std::vector<Eigen::MatrixXd>(5, unit), .by_period = true, .stretch = 2};
  const controller::ModelError error = measured_model_error({sample}, 1, 1);
  // After the first period: (0.1, 0.1), (0.1, 0.7), (0.2).
  EXPECT_NEAR(error.root_mean_square[0], 0.5, 1e-12);
  EXPECT_NEAR(error.first[0].offset[0], 0.9, 1e-12);
}

TEST(MeasuredModelError, of_later_periods_is_that_of_all_where_none_is_later) {
  const controller::ModelError error =
      measured_model_error({{.units = setting_out(), .by_period = true}}, 1, 5);
  EXPECT_EQ(error.first.size(), 3U);
  EXPECT_GT(error.root_mean_square[0], 0.5);
}

TEST(MeasuredModelError, of_a_single_unit_has_no_offset) {
  const controller::ModelError error = measured_model_error({{.units = {setting_out()[0]}}}, 1, 1);
  EXPECT_EQ(error.first[0].offset.size(), 0);
  EXPECT_NEAR(error.first[0].root_mean_square[0], 0.6, 1e-12);
}

// About the mean of the same units that the error is measured from.
TEST(MeasuredModelError, about_an_offset_exceeds_the_true_norms_as_often_as_its_confidence_says) {
  int too_small = 0;
  constexpr int kRuns = 100;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    ResidualSample sample;
    for (std::uint64_t n = 0; n < 50; ++n) {
      sample.units.push_back(normal_residuals(run, n, 1, 0.3).array() + 2.0);
    }
    const controller::ModelError own = measured_model_error({sample}, run, 1).first[0];
    const double truth = std::hypot(0.3, own.offset[0] - 2.0);
    too_small += own.root_mean_square[0] < truth ? 1 : 0;
  }
  // One of 100 is expected; 6 or more have a probability of 5e-4.
  EXPECT_LE(too_small, 5);
}

TEST(MeasuredModelError, periods_of_a_plant_that_broke_do_not_count) {
  Eigen::MatrixXd broken(1, 2);
  broken << 0.1, std::numeric_limits<double>::quiet_NaN();
  const std::vector<Eigen::MatrixXd> units{broken, Eigen::MatrixXd::Constant(1, 2, 0.1)};
  for (const bool by_period : {false, true}) {
    const controller::ModelError error =
        measured_model_error({{.units = units, .by_period = by_period}}, 1);
    EXPECT_NEAR(error.root_mean_square[0], 0.1, 1e-12);
  }
  broken(0, 0) = broken(0, 1);
  EXPECT_THROW((void)measured_model_error({{.units = {broken}}}, 1), std::invalid_argument);
}

TEST(MeasuredModelError, norms_grow_with_their_order_and_depend_on_the_seed_alone) {
  ResidualSample sample;
  for (std::uint64_t n = 0; n < 30; ++n) sample.units.push_back(normal_residuals(9, n, 8, 1e-3));
  const controller::ModelError error = measured_model_error({sample}, 4);
  EXPECT_GT(error.higher[0][0], error.root_mean_square[0]);
  EXPECT_GT(error.higher[1][0], error.higher[0][0]);
  EXPECT_EQ(measured_model_error({sample}, 4).higher[1], error.higher[1]);
  EXPECT_NE(measured_model_error({sample}, 5).higher[1], error.higher[1]);
}

}  // namespace measured_error_test
}  // namespace qsmpc::harness
