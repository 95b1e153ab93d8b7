#include "controller/measure/compression/compression.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace compression_test {

using namespace testing;

// Sums of some hundred terms of order one.
constexpr double kRounding = 1e-12;

TEST(Compression, keeps_mass_and_mean_and_accounts_for_the_lost_covariance) {
  Generator generator(21);
  for (const int count : {1, 2, 7, 30, 99}) {
    for (const int refinements : {0, 1, 3}) {
      for (const Eigen::Index dim : {1, 3, 6}) {
        const DiscreteMeasure measure = random_measure(generator, dim, 150);
        const Compression compression = compress(measure, count, refinements);
        EXPECT_LE(compression.measure.size(), count);
        EXPECT_NEAR(compression.measure.weights.sum(), 1.0, kRounding);
        EXPECT_GT(compression.measure.weights.minCoeff(), 0.0);
        EXPECT_LE((mean_of(compression.measure) - mean_of(measure)).norm(), kRounding);
        EXPECT_LE((covariance_of(compression.measure) + compression.within_covariance -
                   covariance_of(measure))
                      .norm(),
                  kRounding);
        EXPECT_NEAR(compression.w2 * compression.w2, compression.within_covariance.trace(),
                    kRounding);
      }
    }
  }
}

TEST(Compression, points_are_the_means_of_the_assigned_points) {
  Generator generator(22);
  const DiscreteMeasure measure = random_measure(generator, 2, 80);
  const Compression compression = compress(measure, 9, 2);
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(compression.measure.size());
  Eigen::MatrixXd moment = Eigen::MatrixXd::Zero(2, compression.measure.size());
  double cost = 0.0;
  for (Eigen::Index i = 0; i < measure.size(); ++i) {
    const int n = compression.assignment[i];
    mass[n] += measure.weights[i];
    moment.col(n) += measure.weights[i] * measure.locations.col(i);
    cost += measure.weights[i] *
            (measure.locations.col(i) - compression.measure.locations.col(n)).squaredNorm();
  }
  for (Eigen::Index n = 0; n < mass.size(); ++n) {
    EXPECT_NEAR(compression.measure.weights[n], mass[n], kRounding);
    EXPECT_LE((compression.measure.locations.col(n) - moment.col(n) / mass[n]).norm(), kRounding);
  }
  EXPECT_NEAR(compression.w2 * compression.w2, cost, kRounding);
}

TEST(Compression, refinements_never_cost_more) {
  Generator generator(23);
  for (int repetition = 0; repetition < 20; ++repetition) {
    const DiscreteMeasure measure = random_measure(generator, 3, 120);
    double before = compress(measure, 12, 0).w2;
    for (int refinements = 1; refinements <= 5; ++refinements) {
      const double after = compress(measure, 12, refinements).w2;
      EXPECT_LE(after, before + kRounding);
      before = after;
    }
  }
}

TEST(Compression, at_convergence_clusters_are_voronoi_cells_and_their_means) {
  Generator generator(28);
  for (const Eigen::Index dim : {1, 2, 3, 7}) {
    const DiscreteMeasure measure = random_measure(generator, dim, 400);
    const Compression compression = compress(measure, 20, kToConvergence);
    double to_nearest = 0.0;
    for (Eigen::Index i = 0; i < measure.size(); ++i) {
      to_nearest +=
          measure.weights[i] * (compression.measure.locations.colwise() - measure.locations.col(i))
                                   .colwise()
                                   .squaredNorm()
                                   .minCoeff();
    }
    EXPECT_NEAR(compression.w2, std::sqrt(to_nearest), kRounding);
    EXPECT_LE((mean_of(compression.measure) - mean_of(measure)).norm(), kRounding);
    EXPECT_LT(compression.w2, compress(measure, 20, 1).w2);  // one round was not enough for it
  }
}

TEST(Compression, is_deterministic) {
  Generator generator(24);
  const DiscreteMeasure measure = random_measure(generator, 3, 200);
  const Compression first = compress(measure, 17, 1);
  const Compression second = compress(measure, 17, 1);
  EXPECT_EQ(first.assignment, second.assignment);
  EXPECT_EQ(first.measure.locations, second.measure.locations);
  EXPECT_EQ(first.measure.weights, second.measure.weights);
}

TEST(Compression, enough_points_keep_every_point) {
  Generator generator(25);
  for (const int count : {40, 41, 1000}) {
    const DiscreteMeasure measure = random_measure(generator, 2, 40);
    const Compression compression = compress(measure, count);
    EXPECT_EQ(compression.measure.size(), 40);
    // Each point is weight · location / weight: one rounding of numbers of order one.
    EXPECT_LE(compression.w2, 1e-15);
  }
}

TEST(Compression, duplicates_share_a_point_at_no_cost) {
  DiscreteMeasure measure{.locations = Points(1, 6), .weights = Eigen::VectorXd(6)};
  measure.locations << 1.0, 2.0, 1.0, 2.0, 1.0, 2.0;
  measure.weights << 0.125, 0.125, 0.25, 0.125, 0.125, 0.25;
  const Compression compression = compress(measure, 5);
  EXPECT_EQ(compression.measure.size(), 2);
  EXPECT_EQ(compression.w2, 0.0);
  EXPECT_EQ(compression.measure.weights.minCoeff(), 0.5);
}

TEST(Compression, points_without_weight_change_nothing) {
  Generator generator(26);
  DiscreteMeasure measure = random_measure(generator, 2, 30);
  for (Eigen::Index i = 0; i < 30; i += 3) {
    measure.weights[i] = 0.0;
    measure.locations.col(i).setConstant(1e6);
  }
  measure.weights /= measure.weights.sum();
  for (const int count : {1, 5, 30}) {
    const Compression compression = compress(measure, count, 2);
    EXPECT_NEAR(compression.measure.weights.sum(), 1.0, kRounding);
    EXPECT_LE((mean_of(compression.measure) - mean_of(measure)).norm(), kRounding);
    EXPECT_LE(compression.measure.locations.cwiseAbs().maxCoeff(), 2.0);
    for (const int cluster : compression.assignment) {
      EXPECT_GE(cluster, 0);
      EXPECT_LT(cluster, compression.measure.size());
    }
  }
}

TEST(Compression, one_point_stays_as_it_is) {
  const DiscreteMeasure measure{.locations = Points::Constant(3, 1, 0.7),
                                .weights = Eigen::VectorXd::Ones(1)};
  const Compression compression = compress(measure, 10);
  EXPECT_EQ(compression.measure.locations, measure.locations);
  EXPECT_EQ(compression.w2, 0.0);
}

TEST(Compression, refuses_invalid_measures) {
  Generator generator(27);
  const DiscreteMeasure good = random_measure(generator, 2, 10);
  EXPECT_THROW((void)compress(good, 0), std::invalid_argument);
  EXPECT_THROW((void)compress(good, 3, -1), std::invalid_argument);
  EXPECT_THROW((void)compress({}, 3), std::invalid_argument);

  DiscreteMeasure undefined = good;
  undefined.locations(1, 4) = std::nan("");
  EXPECT_THROW((void)compress(undefined, 3), std::invalid_argument);
  DiscreteMeasure negative = good;
  negative.weights[0] += negative.weights[1] + 0.1;
  negative.weights[1] = -0.1;
  EXPECT_THROW((void)compress(negative, 3), std::invalid_argument);
  DiscreteMeasure heavy = good;
  heavy.weights *= 1.001;
  EXPECT_THROW((void)compress(heavy, 3), std::invalid_argument);
  DiscreteMeasure unequal = good;
  unequal.weights = Eigen::VectorXd::Constant(9, 1.0 / 9.0);
  EXPECT_THROW((void)compress(unequal, 3), std::invalid_argument);
}

}  // namespace compression_test
}  // namespace qsmpc::controller
