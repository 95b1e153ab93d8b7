#include "controller/measure/quantisation/normal_quantiser.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "controller/measure/normal/normal_distribution.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace normal_quantiser_test {

struct KnownDistortion {
  int count;
  double w2_squared;
};

// Computed by an independent high-precision implementation.
constexpr KnownDistortion kKnown[] = {
    {1, 1.0},
    {2, 0.363380227632419},
    {3, 0.190174039247901},
    {4, 0.117481847829329},
    {5, 0.0799411270882774},
    {6, 0.057977653715073},
    {7, 0.0440003824986234},
    {8, 0.0345477607885037},
    {9, 0.0278532609506944},
    {10, 0.0229370529045015},
    {11, 0.019219508031384},
    {12, 0.0163396578824342},
    {13, 0.0140630562728806},
    {14, 0.0122320001083862},
    {15, 0.0107372105591903},
    {16, 0.00950100800819189},
    {17, 0.00846693841671285},
    {18, 0.00759316921749199},
    {19, 0.0068481657204271},
    {20, 0.00620778988488803},
    {21, 0.005653310431031408},
    {22, 0.0051700110229156975},
    {23, 0.004746199457674986},
    {24, 0.004372490983311005},
    {25, 0.004041282327692845},
    {26, 0.003746360541868558},
    {27, 0.003482608546708509},
    {28, 0.0032457809825482474},
    {29, 0.0030323318047424767},
    {30, 0.002839280404280611},
    {31, 0.002664106716192523},
    {32, 0.0025046683556745053},
    {33, 0.0023591346476073555},
    {34, 0.0022259337237021744},
    {35, 0.0021037098096231208},
    {36, 0.0019912885184160257},
    {37, 0.0018876484794028575},
    {38, 0.0017918980140998663},
    {39, 0.0017032558582503563},
    {40, 0.0016210351470217431},
    {41, 0.0015446300468723467},
    {42, 0.001473504545619805},
    {43, 0.001407183011405853},
    {44, 0.001345242208519864},
    {45, 0.0012873045186466473},
    {46, 0.001233032163900609},
    {47, 0.0011821222659158179},
    {48, 0.0011343026054862146},
    {49, 0.0010893279714725445},
    {50, 0.0010469770071933554},
    {51, 0.0010070494783010677},
    {52, 0.0009693638989528911},
    {53, 0.0009337554635629879},
    {54, 0.0009000742399777324},
    {55, 0.0008681835869774049},
    {56, 0.0008379587648236098},
    {57, 0.000809285712396206},
    {58, 0.0007820599684725363},
    {59, 0.0007561857180529395},
    {60, 0.0007315749474316098},
    {64, 0.0006442396653170089},
    {100, 0.0002667122194611027},
    {200, 6.733112412593578e-05},
    {500, 1.0837920556094509e-05},
    {1000, 2.7150262418950572e-06},
};

TEST(NormalQuantiser, distortion_matches_the_reference) {
  // The reference is given to 1e-8 relative.
  for (const auto& [count, w2_squared] : kKnown) {
    EXPECT_NEAR(normal_quantiser(count).distortion, w2_squared, 1e-8 * w2_squared) << count;
  }
}

TEST(NormalQuantiser, weights_sum_to_one_and_points_are_symmetric_and_increasing) {
  for (const int count : {1, 2, 3, 8, 33, 200, 1000}) {
    const NormalQuantiser& quantiser = normal_quantiser(count);
    ASSERT_EQ(quantiser.points.size(), count);
    EXPECT_NEAR(quantiser.weights.sum(), 1.0, 1e-14);  // rounding of a sum of `count` numbers
    EXPECT_EQ(quantiser.points, -quantiser.points.reverse());
    for (int i = 1; i < count; ++i) EXPECT_LT(quantiser.points[i - 1], quantiser.points[i]);
  }
}

TEST(NormalQuantiser, points_are_the_centroids_of_their_cells) {
  for (const int count : {2, 3, 8, 33, 200, 1000}) {
    const NormalQuantiser& quantiser = normal_quantiser(count);
    for (int i = 0; i < count; ++i) {
      const double low =
          i == 0 ? -kInfinity : 0.5 * (quantiser.points[i - 1] + quantiser.points[i]);
      const double high =
          i + 1 == count ? kInfinity : 0.5 * (quantiser.points[i] + quantiser.points[i + 1]);
      const double mass = normal_probability(low, high);
      const double moment = normal_density(low) - normal_density(high);
      EXPECT_DOUBLE_EQ(quantiser.weights[i], mass);
      // Moments are differences of numbers up to 0.4: rounding of 1e-16, whatever the cell's mass.
      EXPECT_NEAR(quantiser.points[i] * mass, moment, 1e-15);
    }
  }
}

TEST(NormalQuantiser, lost_variance_is_the_distortion) {
  for (const int count : {1, 2, 5, 50, 400}) {
    const NormalQuantiser& quantiser = normal_quantiser(count);
    const double kept = (quantiser.weights.array() * quantiser.points.array().square()).sum();
    EXPECT_NEAR(kept + quantiser.distortion, 1.0, 1e-13);  // rounding of sums near one
  }
}

TEST(NormalQuantiser, approximate_distortion_is_exact_up_to_its_limit_and_close_beyond) {
  EXPECT_DOUBLE_EQ(approximate_distortion(kExactDistortions),
                   normal_quantiser(kExactDistortions).distortion);
  // The next term of the asymptotic expansion is of relative order 1/n.
  EXPECT_NEAR(approximate_distortion(1000), 2.7150262418950572e-06, 0.02 * 2.7150262418950572e-06);
}

TEST(NormalQuantiser, no_points_are_refused) {
  EXPECT_THROW((void)normal_quantiser(0), std::invalid_argument);
  EXPECT_THROW((void)normal_quantiser(-3), std::invalid_argument);
}

TEST(NormalDistribution, tails_keep_their_relative_accuracy) {
  // Φ(−10) and Φ(−11) from tables; both are far below the spacing of doubles near one.
  EXPECT_NEAR(normal_cumulative(-10.0) / 7.619853024160527e-24, 1.0, 1e-12);
  EXPECT_NEAR(normal_probability(10.0, kInfinity) / 7.619853024160527e-24, 1.0, 1e-12);
  EXPECT_NEAR(normal_probability(-kInfinity, kInfinity), 1.0, 0.0);
  EXPECT_EQ(normal_density_moment(kInfinity), 0.0);
}

}  // namespace normal_quantiser_test
}  // namespace qsmpc::controller
