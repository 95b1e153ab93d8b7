#include "controller/measure/compression/mixture_split.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "controller/measure/wasserstein.hpp"
#include "controller/prediction/product_map.hpp"
#include "tests/support/executors.hpp"
#include "tests/unit/controller/measure/mixture_cases.hpp"

namespace qsmpc::controller {
namespace mixture_split_test {

using namespace testing;

// Sums of some thousand terms of order one.
constexpr double kRounding = 1e-12;

/// The cells' means as weighted points.
DiscreteMeasure cell_means(const MixtureCase& mixture, const MixtureCells& cells) {
  StageMap map;
  cluster_map(cells, run_in_turn, map);
  DiscreteMeasure means{.locations = Points(mixture.sources.dim(), cells.cells()),
                        .weights = map.weights};
  apply_stage_map(map, mixture.sources.locations, means.locations);
  return means;
}

/// Mass by source, and number of its parts.
struct SourceParts {
  std::vector<double> mass;
  std::vector<int> parts;
};

SourceParts by_source(const MixtureCase& mixture, const MixtureCells& cells) {
  SourceParts result{.mass = std::vector<double>(mixture.sources.size(), 0.0),
                     .parts = std::vector<int>(mixture.sources.size(), 0)};
  for (std::size_t k = 0; k < cells.mass.size(); ++k) {
    result.mass[cells.source[k]] += cells.mass[k];
    ++result.parts[cells.source[k]];
  }
  return result;
}

void expect_same_bits(const MixtureCells& one, const MixtureCells& other) {
  EXPECT_EQ(one.begin, other.begin);
  EXPECT_EQ(one.source, other.source);
  EXPECT_EQ(one.mass, other.mass);
  EXPECT_EQ(one.weight, other.weight);
  EXPECT_EQ(one.noise_mean, other.noise_mean);
  EXPECT_EQ(one.w2, other.w2);
}

/// Properties of every mixture; `scale` is the scale of its positions.
void expect_sound(const MixtureCase& mixture, double scale = 1.0) {
  SCOPED_TRACE(mixture.name);
  const MixtureCells cells = split(mixture);
  ASSERT_GE(cells.cells(), 1);
  EXPECT_LE(cells.cells(), mixture.cells);
  const SourceParts sources = by_source(mixture, cells);
  for (Eigen::Index i = 0; i < mixture.sources.size(); ++i) {
    EXPECT_NEAR(sources.mass[i], mixture.sources.weights[i], kRounding) << "source " << i;
    EXPECT_LE(sources.parts[i], mixture.parts) << "source " << i;
  }
  for (int n = 0; n < cells.cells(); ++n) {
    EXPECT_GT(cells.weight[n], 0.0);
    EXPECT_TRUE(std::is_sorted(cells.source.begin() + cells.begin[n],
                               cells.source.begin() + cells.begin[n + 1]));
  }
  const DiscreteMeasure means = cell_means(mixture, cells);
  ASSERT_TRUE(means.locations.allFinite());
  EXPECT_NEAR(means.weights.sum(), 1.0, kRounding);
  EXPECT_LE((mean_of(means) - mean_of(mixture.sources)).norm(), kRounding * scale);
  // The cost is the part of the mixture's second moment that the cells' means lack.
  const double lost = covariance_of(mixture.sources).trace() + mixture.covariance.trace() -
                      covariance_of(means).trace();
  EXPECT_NEAR(cells.w2 * cells.w2, lost, kRounding * scale * scale);
}

TEST(MixtureSplit, keeps_mass_by_source_and_mean_and_costs_what_second_moments_lose) {
  for (const MixtureCase& mixture : random_mixtures()) expect_sound(mixture);
}

TEST(MixtureSplit, is_sound_on_clusters_that_are_far_apart) {
  Generator generator(821);
  constexpr double kDistance = 1e6;
  DiscreteMeasure sources = random_measure(generator, 3, 80);
  for (int i = 0; i < 80; ++i) sources.locations(i % 3, i) += kDistance * (i % 2);
  expect_sound({.name = "clusters",
                .covariance = random_spd(generator, 3, 0.1),
                .sources = sources,
                .cells = 50,
                .parts = 20},
               kDistance);
}

TEST(MixtureSplit, is_sound_where_sources_coincide_or_weigh_nothing) {
  Generator generator(822);
  for (const Eigen::MatrixXd& covariance : covariances(generator, 2)) {
    DiscreteMeasure sources = random_measure(generator, 2, 60);
    for (int i = 20; i < 40; ++i) sources.locations.col(i) = sources.locations.col(i - 20);
    for (int i = 0; i < 60; i += 3) sources.weights[i] = 0.0;
    sources.weights /= sources.weights.sum();
    expect_sound({"pairs", covariance, sources, 25, 6});
    sources.locations.colwise() = Eigen::VectorXd(sources.locations.col(0));
    expect_sound({"one place", covariance, sources, 25, 6});
  }
}

TEST(MixtureSplit, is_sound_on_grids_of_thousands) {
  // Many small cells; for some, differences of moments leave nothing but rounding.
  const Gaussian belief{.mean = Eigen::Vector3d::Zero(),
                        .covariance = 0.01 * Eigen::Matrix3d::Identity()};
  for (const double noise : {0.01, 1e-4}) {
    expect_sound({.name = "grid, " + std::to_string(noise),
                  .covariance = Eigen::Vector3d(noise, noise, 0.1 * noise).asDiagonal(),
                  .sources = quantise(belief, 3000, QuantiserKind::kProduct).measure,
                  .cells = 3000,
                  .parts = 8});
  }
}

TEST(MixtureSplit, one_point_without_noise_stays_one_cell) {
  Generator generator(823);
  const MixtureCase mixture{.name = "point",
                            .covariance = Eigen::MatrixXd::Zero(3, 3),
                            .sources = random_measure(generator, 3, 1),
                            .cells = 10,
                            .parts = 10};
  const MixtureCells cells = split(mixture);
  EXPECT_EQ(cells.cells(), 1);
  EXPECT_EQ(cells.w2, 0.0);
}

TEST(MixtureSplit, scales_as_its_input_does) {
  // Scaled by powers of two, so rounding is unaffected: the same cells, bit for bit.
  Generator generator(824);
  const MixtureCase mixture{.name = "unit",
                            .covariance = random_spd(generator, 2, 0.3),
                            .sources = random_measure(generator, 2, 30),
                            .cells = 40,
                            .parts = 10};
  const MixtureCells cells = split(mixture);
  for (const int exponent : {-200, -80, -20, 20, 80, 200}) {
    const double scale = std::ldexp(1.0, exponent);
    MixtureCase scaled = mixture;
    scaled.covariance *= scale * scale;
    scaled.sources.locations *= scale;
    const MixtureCells other = split(scaled);
    ASSERT_EQ(other.begin, cells.begin) << exponent;
    EXPECT_EQ(other.mass, cells.mass) << exponent;
    EXPECT_EQ(other.w2, scale * cells.w2) << exponent;
  }
}

TEST(MixtureSplit, cost_is_no_less_than_the_distance_from_the_mixture) {
  constexpr int kGrid = 41;  // points per dimension of a grid that stands for a Gaussian
  Generator generator(825);
  for (const int cells : {1, 8, 40}) {
    const MixtureCase mixture{.name = "plane",
                              .covariance = random_spd(generator, 2, 0.2),
                              .sources = random_measure(generator, 2, 3),
                              .cells = cells,
                              .parts = 30};
    const GaussianQuantisation noise = quantise(
        {.mean = Eigen::VectorXd::Zero(2), .covariance = mixture.covariance}, kGrid * kGrid);
    const DiscreteMeasure fine = product_measure(mixture.sources, noise.measure);
    const MixtureCells result = split(mixture);
    const double distance = wasserstein2(fine, cell_means(mixture, result));
    // W2 is a metric: the mixture is within noise.w2 of its substitute.
    EXPECT_GE(result.w2 + noise.w2, distance);
    // It is also tight.
    EXPECT_LE(result.w2, 1.3 * (distance + noise.w2)) << cells << " cells";
  }
}

TEST(MixtureSplit, no_result_depends_on_the_order_of_the_tasks) {
  Generator generator(826);
  for (const int size : {100, 5000}) {
    const MixtureCase mixture{.name = "tasks",
                              .covariance = random_spd(generator, 3, 0.1),
                              .sources = random_measure(generator, 3, size),
                              .cells = 200,
                              .parts = 20};
    const MixtureCells in_turn = split(mixture);
    expect_same_bits(in_turn, split(mixture, run_backwards));
    expect_same_bits(in_turn, split(mixture, run_on_threads));
  }
}

TEST(MixtureSplit, nothing_is_left_over_from_the_mixtures_before) {
  Generator generator(827);
  const Eigen::MatrixXd covariance = random_spd(generator, 3, 0.1);
  MixtureSplitter used(covariance, 50, 20);
  MixtureCells cells;
  for (const int size : {3000, 1, 100, 7, 101}) {
    const MixtureCase mixture{.name = "next",
                              .covariance = covariance,
                              .sources = random_measure(generator, 3, size),
                              .cells = 50,
                              .parts = 20};
    used.split(mixture.sources.locations, mixture.sources.weights, run_in_turn, cells);
    expect_same_bits(cells, split(mixture));
  }
}

TEST(MixtureSplit, more_cells_cost_less) {
  Generator generator(828);
  MixtureCase mixture{.name = "growing",
                      .covariance = random_spd(generator, 3, 0.3),
                      .sources = random_measure(generator, 3, 40),
                      .cells = 1,
                      .parts = 50};
  double before = std::numeric_limits<double>::infinity();
  for (const int cells : {1, 2, 5, 20, 80, 300}) {
    mixture.cells = cells;
    const double cost = split(mixture).w2;
    EXPECT_LT(cost, before) << cells;
    before = cost;
  }
}

TEST(MixtureSplit, refuses_invalid_arguments) {
  const Eigen::MatrixXd good = Eigen::MatrixXd::Identity(3, 3);
  EXPECT_NO_THROW(MixtureSplitter(good, 1, 1));
  EXPECT_THROW(MixtureSplitter(good, 0, 1), std::invalid_argument);
  EXPECT_THROW(MixtureSplitter(good, 1, 0), std::invalid_argument);
  EXPECT_THROW(MixtureSplitter(-good, 1, 1), std::invalid_argument);
  EXPECT_THROW(MixtureSplitter(good * std::nan(""), 1, 1), std::invalid_argument);
  EXPECT_THROW(MixtureSplitter(Eigen::MatrixXd(0, 0), 1, 1), std::invalid_argument);
  EXPECT_NO_THROW(MixtureSplitter(Eigen::MatrixXd::Identity(8, 8), 1, 1));
  EXPECT_THROW(MixtureSplitter(Eigen::MatrixXd::Identity(9, 9), 1, 1), std::invalid_argument);
}

}  // namespace mixture_split_test
}  // namespace qsmpc::controller
