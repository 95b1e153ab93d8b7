// The mixture split compared with its plain version: which part of which source is in which cell.
#include <cmath>

#include <gtest/gtest.h>

#include "controller/prediction/product_map.hpp"
#include "tests/support/plain_mixture.hpp"
#include "tests/unit/controller/measure/mixture_cases.hpp"

namespace qsmpc::controller {
namespace mixture_reference_test {

using namespace testing;

// Weights, shares and positions are of order one. A cell's moments are differences of moments of
// the cells it was cut from, so rounding errors accumulate with the number of cells.
constexpr double kTolerance = 1e-9;
constexpr double kSquareTolerance = 1e-13;  // of the mixture's second moment

void expect_equal(const MixtureCase& mixture) {
  SCOPED_TRACE(mixture.name);
  const MixtureCells cells = split(mixture);
  const PlainMixture plain = plain_split(mixture.covariance, mixture.cells, mixture.parts,
                                         mixture.sources.locations, mixture.sources.weights);
  ASSERT_EQ(cells.cells(), static_cast<int>(plain.cells.size()));
  // Both are roots of differences, and the fast version includes an allowance for their rounding.
  EXPECT_GE(cells.w2, plain.w2 - kTolerance);
  EXPECT_NEAR(cells.w2 * cells.w2, plain.w2 * plain.w2,
              kSquareTolerance * cells.whole_covariance.trace());
  StageMap map;
  cluster_map(cells, run_in_turn, map);
  for (int n = 0; n < cells.cells(); ++n) {
    const PlainCell& cell = plain.cells[n];
    ASSERT_EQ(cells.begin[n + 1] - cells.begin[n], static_cast<int>(cell.parts.size()))
        << "cell " << n;
    EXPECT_NEAR(cells.weight[n], cell.weight, kTolerance);
    for (std::size_t k = 0; k < cell.parts.size(); ++k) {
      const std::size_t at = cells.begin[n] + k;
      EXPECT_EQ(cells.source[at], cell.parts[k].source);
      EXPECT_NEAR(cells.mass[at], cell.parts[k].mass, kTolerance);
      EXPECT_NEAR(map.shares.value[at], cell.parts[k].mass / cell.weight, kTolerance);
    }
    EXPECT_LE((map.offset.col(n) - cell.noise_mean).cwiseAbs().maxCoeff(), kTolerance);
    EXPECT_NEAR(map.weights[n], cell.weight, kTolerance);
  }
  EXPECT_EQ(map.compression_w2, cells.w2);
  Points means(mixture.sources.dim(), cells.cells());
  apply_stage_map(map, mixture.sources.locations, means);
  for (int n = 0; n < cells.cells(); ++n) {
    EXPECT_LE((means.col(n) - plain.cells[n].mean).cwiseAbs().maxCoeff(), kTolerance);
  }
}

TEST(MixtureReference, agrees_on_random_mixtures) {
  for (const MixtureCase& mixture : random_mixtures()) expect_equal(mixture);
}

TEST(MixtureReference, agrees_on_more_sources_than_one_task_works_on) {
  Generator generator(812);
  expect_equal({.name = "3000 sources",
                .covariance = random_spd(generator, 3, 0.05),
                .sources = random_measure(generator, 3, 3000),
                .cells = 1500,
                .parts = 20});
}

TEST(MixtureReference, agrees_on_clusters_that_are_far_apart) {
  Generator generator(813);
  for (const double distance : {1e2, 1e4}) {
    DiscreteMeasure sources = random_measure(generator, 3, 90);
    for (int i = 0; i < 90; ++i) sources.locations(i % 3, i) += distance * (i % 4);
    // This test compares positions to 1e-9 m: no farther than the precision of doubles allows.
    expect_equal({.name = "clusters",
                  .covariance = random_spd(generator, 3, 0.1),
                  .sources = sources,
                  .cells = 20,
                  .parts = 30});
  }
}

}  // namespace mixture_reference_test
}  // namespace qsmpc::controller
