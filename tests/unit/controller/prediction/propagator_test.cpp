#include "controller/prediction/propagator.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/measure/compression/compression.hpp"
#include "controller/measure/compression/soft_compression.hpp"
#include "controller/measure/wasserstein.hpp"
#include "controller/prediction/moment_matching.hpp"
#include "models/linear_algebra.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace propagator_test {

using namespace testing;

// Sums of some thousand terms of order one.
constexpr double kRounding = 1e-12;

PropagatorSettings random_settings(Generator& generator, int noise_points, int compressed_points) {
  return {.noise = {.mean = Eigen::VectorXd::Zero(3), .covariance = random_spd(generator, 3, 0.1)},
          .noise_points = noise_points,
          .compressed_points = compressed_points};
}

/// All sums of a stepped point and a noise point.
DiscreteMeasure all_sums(const DiscreteMeasure& stepped, const DiscreteMeasure& noise) {
  DiscreteMeasure sums{.locations = Points(stepped.dim(), stepped.size() * noise.size()),
                       .weights = Eigen::VectorXd(stepped.size() * noise.size())};
  Eigen::Index at = 0;
  for (Eigen::Index i = 0; i < stepped.size(); ++i) {
    for (Eigen::Index j = 0; j < noise.size(); ++j, ++at) {
      sums.locations.col(at) = stepped.locations.col(i) + noise.locations.col(j);
      sums.weights[at] = stepped.weights[i] * noise.weights[j];
    }
  }
  return sums;
}

/// The image under `map` of the points that it was built for.
DiscreteMeasure mapped(const StageMap& map, const DiscreteMeasure& stepped) {
  DiscreteMeasure next{.locations = Points::Constant(stepped.dim(), map.clusters(), std::nan("")),
                       .weights = map.weights};
  apply_stage_map(map, stepped.locations, next.locations);
  return next;
}

TEST(CompressedPropagator, map_gives_the_cluster_means_of_all_sums) {
  Generator generator(41);
  for (const int kept : {1, 7, 40}) {
    const PropagatorSettings settings = random_settings(generator, 12, kept);
    const auto propagator = make_propagator("compressed", settings);
    const DiscreteMeasure stepped = random_measure(generator, 3, 25);
    const StageMap map = propagator->stage_map(stepped.locations, stepped.weights);

    const GaussianQuantisation noise = quantise(settings.noise, settings.noise_points);
    const Compression expected = compress(all_sums(stepped, noise.measure), kept, 0);
    Points out = Points::Constant(3, map.clusters(), std::nan(""));
    apply_stage_map(map, stepped.locations, out);
    ASSERT_EQ(map.clusters(), expected.measure.size());
    EXPECT_LE((out - expected.measure.locations).cwiseAbs().maxCoeff(), kRounding);
    EXPECT_LE((map.weights - expected.measure.weights).cwiseAbs().maxCoeff(), kRounding);
    EXPECT_NEAR(map.compression_w2, expected.w2, kRounding);
    EXPECT_EQ(propagator->noise_w2(), noise.w2);
  }
}

TEST(CompressedPropagator, map_stays_exact_when_the_points_move_and_the_assignments_do_not) {
  Generator generator(42);
  const PropagatorSettings settings = random_settings(generator, 10, 8);
  const DiscreteMeasure stepped = random_measure(generator, 3, 15);
  const StageMap map =
      make_propagator("compressed", settings)->stage_map(stepped.locations, stepped.weights);
  const GaussianQuantisation noise = quantise(settings.noise, settings.noise_points);
  const Compression frozen = compress(all_sums(stepped, noise.measure), 8, 0);

  const DiscreteMeasure shifted{
      .locations = stepped.locations + Points(random_matrix(generator, 3, 15)),
      .weights = stepped.weights};
  const DiscreteMeasure sums = all_sums(shifted, noise.measure);
  Points means = Points::Zero(3, map.clusters());
  for (Eigen::Index i = 0; i < sums.size(); ++i) {
    const int n = frozen.assignment[i];
    means.col(n) += sums.weights[i] / frozen.measure.weights[n] * sums.locations.col(i);
  }
  Points out(3, map.clusters());
  apply_stage_map(map, shifted.locations, out);
  EXPECT_LE((out - means).cwiseAbs().maxCoeff(), kRounding);
}

TEST(Propagator, keeps_mass_and_mean) {
  Generator generator(43);
  for (const PropagatorEntry& entry : propagators()) {
    const auto propagator = make_propagator(entry.name, random_settings(generator, 30, 20));
    const DiscreteMeasure stepped = random_measure(generator, 3, 50);
    const StageMap map = propagator->stage_map(stepped.locations, stepped.weights);
    DiscreteMeasure next{.locations = Points(3, map.clusters()), .weights = map.weights};
    apply_stage_map(map, stepped.locations, next.locations);
    EXPECT_NEAR(map.weights.sum(), 1.0, kRounding) << entry.name;
    EXPECT_LE((mean_of(next) - mean_of(stepped)).norm(), kRounding) << entry.name;
  }
}

TEST(Propagator, pullback_is_the_transpose_and_overwrites) {
  Generator generator(44);
  for (const PropagatorEntry& entry : propagators()) {
    const auto propagator = make_propagator(entry.name, random_settings(generator, 20, 15));
    const DiscreteMeasure stepped = random_measure(generator, 3, 30);
    const StageMap map = propagator->stage_map(stepped.locations, stepped.weights);
    const Points direction = random_matrix(generator, 3, 30);
    const Points adjoint = random_matrix(generator, 3, map.clusters());
    Points there(3, map.clusters());
    apply_stage_map(map, direction, there);
    Points constant(3, map.clusters());
    apply_stage_map(map, Points::Zero(3, 30), constant);
    there -= constant;  // the linear part
    Points back = Points::Constant(3, 30, std::nan(""));
    pullback_stage_map(map, adjoint, back);
    EXPECT_NEAR(there.cwiseProduct(adjoint).sum(), direction.cwiseProduct(back).sum(), kRounding)
        << entry.name;
  }
}

TEST(Propagator, pullback_is_the_derivative_at_held_assignments) {
  constexpr double kStep = 1e-4;
  Generator generator(48);
  for (const PropagatorEntry& entry : propagators()) {
    const auto propagator = make_propagator(entry.name, random_settings(generator, 20, 15));
    const DiscreteMeasure stepped = random_measure(generator, 3, 30);
    const StageMap map = propagator->stage_map(stepped.locations, stepped.weights);
    const Points adjoint = random_matrix(generator, 3, map.clusters());
    Points gradient(3, 30);
    pullback_stage_map(map, adjoint, gradient);
    const auto value = [&](const Points& points) {
      Points out(3, map.clusters());
      apply_stage_map(map, points, out);
      return out.cwiseProduct(adjoint).sum();
    };
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      for (Eigen::Index i = 0; i < 30; i += 7) {
        Points beyond = stepped.locations;
        Points before = stepped.locations;
        beyond(axis, i) += kStep;
        before(axis, i) -= kStep;
        // The map is affine: differences are exact up to rounding, divided by the step.
        EXPECT_NEAR(gradient(axis, i), (value(beyond) - value(before)) / (2.0 * kStep),
                    kRounding / kStep)
            << entry.name;
      }
    }
  }
}

TEST(Propagator, cost_of_a_map_is_no_less_than_the_distance_from_the_products) {
  Generator generator(49);
  for (const PropagatorEntry& entry : propagators()) {
    if (entry.name == "noise_free") continue;  // has no products
    for (const int kept : {1, 5, 25}) {
      const PropagatorSettings settings = random_settings(generator, 10, kept);
      const DiscreteMeasure stepped = random_measure(generator, 3, 20);
      const StageMap map =
          make_propagator(entry.name, settings)->stage_map(stepped.locations, stepped.weights);
      const QuantiserKind kind =
          entry.name == "moment_matched" ? QuantiserKind::kLloyd : QuantiserKind::kProduct;
      const GaussianQuantisation noise = quantise(settings.noise, settings.noise_points, kind);
      const DiscreteMeasure sums = all_sums(stepped, noise.measure);
      const double distance = wasserstein2(sums, mapped(map, stepped));
      EXPECT_GE(map.compression_w2, distance - kRounding) << entry.name;
      // Soft shares lose accuracy by their softness; the others are tight.
      if (entry.name != "soft") {
        EXPECT_LE(map.compression_w2, 1.5 * distance) << entry.name;
      }
    }
  }
}

TEST(MomentMatchedPropagator, restores_what_quantised_noise_and_compression_lose) {
  Generator generator(50);
  for (const int kept : {20, 60}) {
    const PropagatorSettings settings = random_settings(generator, 30, kept);
    const DiscreteMeasure stepped = random_measure(generator, 3, 50);
    const Eigen::MatrixXd full = covariance_of(stepped) + settings.noise.covariance;
    const auto covariance = [&](std::string_view name) {
      return covariance_of(mapped(
          make_propagator(name, settings)->stage_map(stepped.locations, stepped.weights), stepped));
    };
    EXPECT_LE((covariance("moment_matched") - full).cwiseAbs().maxCoeff(), kRounding);
    EXPECT_GE((covariance("compressed") - full).cwiseAbs().maxCoeff(), 1e-2);
  }
}

TEST(MomentMatchedPropagator, knows_the_error_of_its_own_noise_quantiser) {
  Generator generator(55);
  const PropagatorSettings settings = random_settings(generator, 30, 20);
  EXPECT_EQ(make_propagator("moment_matched", settings)->noise_w2(),
            quantise(settings.noise, settings.noise_points, QuantiserKind::kLloyd).w2);
}

TEST(MomentMatchedPropagator, refinements_lower_the_cost) {
  Generator generator(51);
  PropagatorSettings settings = random_settings(generator, 30, 20);
  const DiscreteMeasure stepped = random_measure(generator, 3, 50);
  const auto cost = [&](int refinements) {
    settings.refinements = refinements;
    return make_propagator("moment_matched", settings)
        ->stage_map(stepped.locations, stepped.weights)
        .compression_w2;
  };
  EXPECT_LT(cost(3), cost(0));
}

TEST(MomentMatchedPropagator, degenerate_measures_stay_finite_and_where_they_are) {
  Generator generator(52);
  const DiscreteMeasure lone = random_measure(generator, 3, 1);
  DiscreteMeasure coincident = random_measure(generator, 3, 12);
  coincident.locations.colwise() = Eigen::VectorXd(lone.locations.col(0));
  PropagatorSettings settings = random_settings(generator, 20, 8);
  settings.noise.covariance = Eigen::MatrixXd::Zero(3, 3);
  for (const DiscreteMeasure& stepped : {lone, coincident}) {
    const StageMap map =
        make_propagator("moment_matched", settings)->stage_map(stepped.locations, stepped.weights);
    const DiscreteMeasure next = mapped(map, stepped);
    ASSERT_TRUE(next.locations.allFinite());
    EXPECT_LE((next.locations.colwise() - lone.locations.col(0)).cwiseAbs().maxCoeff(), kRounding);
    EXPECT_LE(map.compression_w2, kRounding);
  }
}

TEST(MomentMatchedPropagator, directions_without_particles_are_left_alone) {
  Generator generator(53);
  // Noise along a single axis, from one of its points, and stepped points along the others.
  PropagatorSettings settings = random_settings(generator, 1, 8);
  settings.noise.covariance = Eigen::Vector3d(0.0, 0.0, 0.04).asDiagonal();
  DiscreteMeasure stepped = random_measure(generator, 3, 30);
  stepped.locations.row(2).setConstant(0.7);
  const StageMap map =
      make_propagator("moment_matched", settings)->stage_map(stepped.locations, stepped.weights);
  const DiscreteMeasure next = mapped(map, stepped);
  const Eigen::MatrixXd difference = covariance_of(next) - covariance_of(stepped);
  EXPECT_LE(difference.cwiseAbs().maxCoeff(), kRounding);  // the other axes regain their covariance
  EXPECT_LE((next.locations.row(2).array() - 0.7).abs().maxCoeff(), kRounding);
}

TEST(SoftPropagator, map_gives_the_soft_means_of_all_sums) {
  Generator generator(56);
  PropagatorSettings settings = random_settings(generator, 12, 10);
  settings.sharpness = 3.0;
  const DiscreteMeasure stepped = random_measure(generator, 3, 25);
  const StageMap map =
      make_propagator("soft", settings)->stage_map(stepped.locations, stepped.weights);
  const GaussianQuantisation noise = quantise(settings.noise, settings.noise_points);
  const SoftCompression expected = compress_soft(all_sums(stepped, noise.measure),
                                                 {.count = 10, .sharpness = settings.sharpness});
  const DiscreteMeasure next = mapped(map, stepped);
  ASSERT_EQ(next.size(), expected.measure.size());
  EXPECT_LE((next.locations - expected.measure.locations).cwiseAbs().maxCoeff(), kRounding);
  EXPECT_LE((next.weights - expected.measure.weights).cwiseAbs().maxCoeff(), kRounding);
  EXPECT_EQ(map.compression_w2, expected.w2);
}

TEST(SpreadBetween, meets_the_covariance_and_moves_no_more_than_two_gaussians_are_apart) {
  Generator generator(54);
  int compared = 0;
  for (int round = 0; round < 20; ++round) {
    const Eigen::MatrixXd from = random_spd(generator, 4);
    const Eigen::MatrixXd to = from + random_spd(generator, 4, 0.1);
    const Eigen::MatrixXd spread = spread_between(from, to);
    if (models::symmetric_eigenvalues(spread)[3] >= kLargestStretch) {
      continue;
    }
    ++compared;
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(4);
    const double apart = wasserstein2(Gaussian{.mean = zero, .covariance = from},
                                      Gaussian{.mean = zero, .covariance = to});
    EXPECT_LE((spread * from * spread - to).cwiseAbs().maxCoeff(), kRounding);
    EXPECT_LE((spread - spread.transpose()).cwiseAbs().maxCoeff(), kRounding);
    EXPECT_NEAR(spread_w2(from, spread), apart, 1e-10);  // a root of differences
  }
  EXPECT_GE(compared, 10);
}

TEST(SpreadBetween, stretches_by_no_more_than_its_limit) {
  const Eigen::MatrixXd from = Eigen::Vector3d(1e-8, 1.0, 0.0).asDiagonal();
  const Eigen::MatrixXd to = Eigen::Vector3d(1.0, 1.21, 1.0).asDiagonal();
  const Eigen::MatrixXd expected = Eigen::Vector3d(kLargestStretch, 1.1, 1.0).asDiagonal();
  EXPECT_LE((spread_between(from, to) - expected).cwiseAbs().maxCoeff(), kRounding);
}

TEST(NoiseFreePropagator, leaves_the_points_alone_and_counts_the_noise_as_error) {
  Generator generator(45);
  const PropagatorSettings settings = random_settings(generator, 20, 15);
  const auto propagator = make_propagator("noise_free", settings);
  const DiscreteMeasure stepped = random_measure(generator, 3, 30);
  const StageMap map = propagator->stage_map(stepped.locations, stepped.weights);
  Points out(3, 30);
  apply_stage_map(map, stepped.locations, out);
  EXPECT_EQ(out, stepped.locations);
  EXPECT_EQ(map.weights, stepped.weights);
  EXPECT_EQ(map.compression_w2, 0.0);
  EXPECT_DOUBLE_EQ(propagator->noise_w2(), std::sqrt(settings.noise.covariance.trace()));
}

TEST(CompressedPropagator, points_that_are_not_finite_cost_infinitely_much_and_do_not_throw) {
  Generator generator(46);
  const auto propagator = make_propagator("compressed", random_settings(generator, 20, 15));
  DiscreteMeasure stepped = random_measure(generator, 3, 30);
  stepped.locations(1, 7) = std::nan("");
  const StageMap map = propagator->stage_map(stepped.locations, stepped.weights);
  EXPECT_TRUE(std::isinf(map.compression_w2));
  Points out(3, map.clusters());
  apply_stage_map(map, stepped.locations, out);
  EXPECT_TRUE(out.row(1).hasNaN());
}

TEST(MakePropagator, refuses_unknown_names_and_invalid_settings) {
  Generator generator(47);
  PropagatorSettings settings = random_settings(generator, 20, 15);
  try {
    (void)make_propagator("telepathy", settings);
    FAIL() << "an unknown propagator was made";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("telepathy"));
    for (const PropagatorEntry& entry : propagators()) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(entry.name));
    }
  }
  settings.compressed_points = 0;
  EXPECT_THROW((void)make_propagator("compressed", settings), std::invalid_argument);
  settings = random_settings(generator, 0, 15);
  EXPECT_THROW((void)make_propagator("compressed", settings), std::invalid_argument);
  settings = random_settings(generator, 20, 15);
  settings.refinements = -1;
  EXPECT_THROW((void)make_propagator("moment_matched", settings), std::invalid_argument);
  settings = random_settings(generator, 20, 15);
  settings.sharpness = 0.0;
  EXPECT_THROW((void)make_propagator("soft", settings), std::invalid_argument);
  settings = random_settings(generator, 20, 15);
  settings.noise.mean[0] = 0.1;
  EXPECT_THROW((void)make_propagator("compressed", settings), std::invalid_argument);
  settings = random_settings(generator, 20, 15);
  settings.noise.covariance(0, 0) = -1.0;
  EXPECT_THROW((void)make_propagator("noise_free", settings), std::invalid_argument);
}

}  // namespace propagator_test
}  // namespace qsmpc::controller
