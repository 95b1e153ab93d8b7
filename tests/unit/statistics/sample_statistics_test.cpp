#include "harness/statistics/sample_statistics.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace qsmpc::harness {
namespace sample_statistics_test {

const std::vector<double> kSample{4.0, 1.0, 7.0, 2.0};  // mean 3.5, sum of squared deviations 21

TEST(SampleStatistics, mean_of_shares_divides_before_it_sums) {
  EXPECT_DOUBLE_EQ(mean_of_shares(kSample), mean_of(kSample));
  // The sum overflows, the weighted terms do not.
  const std::vector<double> huge(2, 1.5e308);
  EXPECT_EQ(mean_of_shares(huge), 1.5e308);
  EXPECT_TRUE(std::isinf(mean_of(huge)));
}

TEST(SampleStatistics, median_of_an_even_number_is_the_mean_of_the_middle_two) {
  EXPECT_EQ(median_of(kSample), 3.0);
  EXPECT_EQ(median_of({3.0, 1.0, 2.0}), 2.0);
}

TEST(SampleStatistics, deviation_and_standard_error_are_about_the_mean) {
  EXPECT_DOUBLE_EQ(standard_deviation_about(kSample, 3.5), std::sqrt(21.0 / 3.0));
  EXPECT_DOUBLE_EQ(standard_error_about(kSample, 3.5), std::sqrt(21.0 / 3.0 / 4.0));
  EXPECT_EQ(standard_error_of(kSample), standard_error_about(kSample, mean_of(kSample)));
}

TEST(SampleStatistics, are_not_numbers_of_too_few) {
  for (const double value :
       {mean_of({}), mean_of_shares({}), median_of({}), largest_of({}), standard_error_of({1.0}),
        standard_error_about({1.0}, 1.0), standard_deviation_about({1.0}, 1.0)}) {
    EXPECT_TRUE(std::isnan(value));
  }
}

}  // namespace sample_statistics_test
}  // namespace qsmpc::harness
