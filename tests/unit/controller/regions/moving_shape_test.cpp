// A moving shape, compared with the same shape at rest in its position, and with laws that include
// its uncertainty.
#include "controller/regions/planar/moving_shape.hpp"

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "controller/regions/planar/shape_region.hpp"
#include "controller/regions/unsafe_set.hpp"
#include "models/constants.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace moving_shape_test {

using namespace testing;

constexpr Growth kGrowth{.radius = 0.1, .x = 0, .y = 1};
constexpr Eigen::Index kStage = 2;

std::vector<PlanarShape> shapes() {
  PolygonShape corner{.corners = Eigen::Matrix2Xd(2, 6)};
  corner.corners << 0.0, 0.8, 0.8, 0.3, 0.3, 0.0,  //
      0.0, 0.0, 0.25, 0.25, 0.9, 0.9;
  return {DiscShape{.centre = {0.2, -0.1}, .radius = 0.3},
          EllipseShape{.centre = {0.1, 0.2}, .semi_axes = {0.4, 0.2}, .angle = 0.3},
          TurnedBoxShape{.centre = {-0.2, 0.1}, .size = {0.6, 0.3}, .angle = 0.7}, corner,
          HalfPlaneShape{.normal = {0.6, 0.8}, .offset = 0.2}};
}

/// A forecast of one obstacle, with `places` at kStage and far away at the other stages.
std::shared_ptr<const ObstacleForecast> forecast_of(const std::vector<ObstaclePlace>& places) {
  std::vector<ObstaclePlace> away = places;
  for (ObstaclePlace& place : away) place.offset.array() += 100.0;
  auto forecast = std::make_shared<ObstacleForecast>(1);
  forecast->set(0, {away, away, places, away});
  return forecast;
}

/// A law in three dimensions, the first two of which form the plane, and the state's deviation from
/// it.
struct RandomLaw {
  Gaussian law;
  Eigen::VectorXd error = Eigen::VectorXd::Constant(3, 0.02);
  HigherNorms higher = constant_norms(3, 0.03);
  Eigen::MatrixXd smooth;
  std::function<Eigen::MatrixXd(const std::vector<Eigen::Index>&)> smoothing =
      [this](const std::vector<Eigen::Index>&) { return smooth; };

  explicit RandomLaw(Generator& generator) {
    law.mean = random_matrix(generator, 3, 1, 0.8);
    const Eigen::MatrixXd root = random_matrix(generator, 3, 3, 0.25);
    law.covariance = root * root.transpose();
    smooth = 0.5 * law.covariance;
  }
  RandomLaw(const RandomLaw& other)
      : law(other.law), error(other.error), higher(other.higher), smooth(other.smooth) {}
  RandomLaw& operator=(const RandomLaw&) = delete;

  [[nodiscard]] SurrogateLaw surrogate() const {
    return {.law = law, .error = error, .higher = higher, .smoothing = smoothing};
  }
};

RegionProbability probability(const UnsafeRegion& region, const RandomLaw& law) {
  RegionProbability sum;
  region.add_probability(kStage, law.surrogate(), sum);
  return sum;
}

TailSum tails(const UnsafeRegion& region, const RandomLaw& law) {
  TailSum sum;
  sum.clear(3);
  region.add_tail(kStage, law.law, sum);
  return sum;
}

/// Compares everything that planning queries.
void expect_same_for_planning(const UnsafeRegion& one, const UnsafeRegion& other,
                              Generator& generator) {
  constexpr int kPoints = 60;
  const Points points = random_matrix(generator, 3, kPoints, 1.2);
  Eigen::ArrayXd one_least = Eigen::ArrayXd::Constant(kPoints, 0.7);
  Eigen::ArrayXd other_least = one_least;
  one.lower_to_distances(kStage, points, one_least);
  other.lower_to_distances(kStage, points, other_least);
  EXPECT_LT((one_least - other_least).abs().maxCoeff(), 1e-12);
  NearestFaces one_faces{.distance = Eigen::ArrayXd::Constant(kPoints, 0.7),
                         .slope = Points::Zero(3, kPoints)};
  NearestFaces other_faces = one_faces;
  one.lower_to_faces(kStage, points, one_faces);
  other.lower_to_faces(kStage, points, other_faces);
  EXPECT_LT((one_faces.slope - other_faces.slope).cwiseAbs().maxCoeff(), 1e-9);
  const Eigen::VectorXd weights = Eigen::VectorXd::LinSpaced(kPoints, 0.1, 1.0);
  Points one_adjoint = Points::Zero(3, kPoints);
  Points other_adjoint = one_adjoint;
  const ParticleRange range{.begin = 3, .end = kPoints};
  const double value = one.add_penalty(kStage, {.locations = points,
                                                .weights = weights,
                                                .range = range,
                                                .scale = 2.0,
                                                .length = 0.4,
                                                .adjoint = one_adjoint});
  EXPECT_NEAR(value,
              other.add_penalty(kStage, {.locations = points,
                                         .weights = weights,
                                         .range = range,
                                         .scale = 2.0,
                                         .length = 0.4,
                                         .adjoint = other_adjoint}),
              1e-10 * std::abs(value));
  EXPECT_LT((one_adjoint - other_adjoint).cwiseAbs().maxCoeff(), 1e-9);
  for (int i = 0; i < kPoints; ++i) {
    EXPECT_NEAR(one.signed_distance(kStage, points.col(i)),
                other.signed_distance(kStage, points.col(i)), 1e-12);
  }
}

TEST(MovingShape, at_a_certain_place_is_the_shape_standing_there) {
  Generator generator(3);
  const ObstaclePlace place{.offset = {0.3, -0.4}, .turn = 0.8};
  for (const PlanarShape& shape : shapes()) {
    const RegionPointer moving = make_moving_shape(shape, kGrowth, forecast_of({place}), 0);
    const RegionPointer standing = make_shape(moved(shape, place.offset, place.turn), kGrowth);
    expect_same_for_planning(*moving, *standing, generator);
    for (int repetition = 0; repetition < 20; ++repetition) {
      const RandomLaw law(generator);
      const RegionProbability bound = probability(*moving, law);
      const RegionProbability expected = probability(*standing, law);
      EXPECT_NEAR(bound.markov, std::min(1.0, expected.markov), 1e-9);
      EXPECT_NEAR(bound.smooth, std::min(1.0, expected.smooth), 1e-9);
      const TailSum moving_tails = tails(*moving, law);
      const TailSum standing_tails = tails(*standing, law);
      EXPECT_NEAR(moving_tails.value(), standing_tails.value(), 1e-9);
      EXPECT_LT((moving_tails.by_mean() - standing_tails.by_mean()).norm(), 1e-7);
      EXPECT_LT((moving_tails.by_covariance() - standing_tails.by_covariance()).norm(), 1e-6);
      EXPECT_NEAR(
          moving->soft_probability(kStage, law.law.mean, law.law.covariance, 0.2),
          std::min(1.0, standing->soft_probability(kStage, law.law.mean, law.law.covariance, 0.2)),
          1e-9);
    }
    // Those of a disc and of a half-plane may start elsewhere.
    if (std::holds_alternative<DiscShape>(shape) || std::holds_alternative<HalfPlaneShape>(shape)) {
      continue;
    }
    const Eigen::Matrix2Xd outline = moving->outline(kStage, 0, 1).corners;
    EXPECT_LT((outline - standing->outline(kStage, 0, 1).corners).cwiseAbs().maxCoeff(), 1e-12);
  }
}

/// The law with an obstacle's uncertainty added.
RandomLaw relative(RandomLaw law, const Eigen::Matrix2d& covariance) {
  law.law.covariance.topLeftCorner<2, 2>() += covariance;
  law.smooth.topLeftCorner<2, 2>() += covariance;
  return law;
}

TEST(MovingShape, uncertain_place_widens_the_law_that_probabilities_are_of) {
  Generator generator(4);
  const ObstaclePlace place{.offset = {-0.2, 0.3},
                            .turn = -0.5,
                            .covariance = (Eigen::Matrix2d() << 0.04, 0.01, 0.01, 0.02).finished()};
  for (const PlanarShape& shape : shapes()) {
    const RegionPointer moving = make_moving_shape(shape, kGrowth, forecast_of({place}), 0);
    const RegionPointer standing = make_shape(moved(shape, place.offset, place.turn), kGrowth);
    for (int repetition = 0; repetition < 20; ++repetition) {
      const RandomLaw law(generator);
      const RandomLaw wide = relative(law, place.covariance);
      const RegionProbability bound = probability(*moving, law);
      const RegionProbability expected = probability(*standing, wide);
      EXPECT_NEAR(bound.markov, std::min(1.0, expected.markov), 1e-9);
      EXPECT_NEAR(bound.smooth, std::min(1.0, expected.smooth), 1e-9);
      EXPECT_NEAR(tails(*moving, law).value(), tails(*standing, wide).value(), 1e-9);
      EXPECT_LT(
          (tails(*moving, law).by_covariance() - tails(*standing, wide).by_covariance()).norm(),
          1e-6);
    }
  }
}

TEST(MovingShape, distances_keep_two_deviations_of_its_place) {
  const ObstaclePlace place{.offset = {1.0, 0.0},
                            .covariance = Eigen::Vector2d(0.01, 0.04).asDiagonal()};
  const RegionPointer moving = make_moving_shape(DiscShape{.centre = {0.0, 0.0}, .radius = 0.5},
                                                 kGrowth, forecast_of({place}), 0);
  EXPECT_NEAR(moving->signed_distance(kStage, Eigen::Vector3d(4.0, 0.0, 9.0)),
              3.0 - 0.5 - 0.1 - 2.0 * 0.2, 1e-12);
}

TEST(MovingShape, several_ways_count_as_their_probabilities) {
  Generator generator(6);
  const ObstaclePlace left{.weight = 0.25, .offset = {0.0, 0.5}};
  const ObstaclePlace right{
      .weight = 0.75, .offset = {0.0, -0.5}, .covariance = 0.01 * Eigen::Matrix2d::Identity()};
  ObstaclePlace only_left = left;
  ObstaclePlace only_right = right;
  only_left.weight = only_right.weight = 1.0;
  for (const PlanarShape& shape : shapes()) {
    const RegionPointer both = make_moving_shape(shape, kGrowth, forecast_of({left, right}), 0);
    const RegionPointer one = make_moving_shape(shape, kGrowth, forecast_of({only_left}), 0);
    const RegionPointer other = make_moving_shape(shape, kGrowth, forecast_of({only_right}), 0);
    for (int repetition = 0; repetition < 20; ++repetition) {
      const RandomLaw law(generator);
      EXPECT_NEAR(probability(*both, law).smooth,
                  0.25 * probability(*one, law).smooth + 0.75 * probability(*other, law).smooth,
                  1e-12);
      EXPECT_NEAR(tails(*both, law).value(),
                  0.25 * tails(*one, law).value() + 0.75 * tails(*other, law).value(), 1e-12);
      const auto soft = [&](const RegionPointer& region) {
        return region->soft_probability(kStage, law.law.mean, law.law.covariance, 0.3);
      };
      EXPECT_NEAR(soft(both), 0.25 * soft(one) + 0.75 * soft(other), 1e-12);
      EXPECT_DOUBLE_EQ(both->signed_distance(kStage, law.law.mean),
                       std::min(one->signed_distance(kStage, law.law.mean),
                                other->signed_distance(kStage, law.law.mean)));
    }
  }
}

TEST(MovingShape, softened_is_the_same_for_many_centres) {
  Generator generator(7);
  const std::vector<ObstaclePlace> places = {
      {.weight = 0.4, .offset = {0.2, 0.0}, .turn = 0.4},
      {.weight = 0.6, .offset = {-0.3, 0.1}, .covariance = 0.02 * Eigen::Matrix2d::Identity()}};
  const Points centres = random_matrix(generator, 3, 30, 0.7);
  const Eigen::MatrixXd covariance = 0.01 * Eigen::MatrixXd::Identity(3, 3);
  const Eigen::VectorXd lowest = centres.rowwise().minCoeff();
  const Eigen::VectorXd highest = centres.rowwise().maxCoeff();
  for (const PlanarShape& shape : shapes()) {
    const RegionPointer moving = make_moving_shape(shape, kGrowth, forecast_of(places), 0);
    const auto soft = moving->soften(
        kStage,
        {.centres = centres, .covariance = covariance, .lowest = lowest, .highest = highest});
    std::vector<double> totals(30, 0.0);
    soft->add(0.25, 0, 30, totals.data());
    for (int i = 0; i < 30; ++i) {
      EXPECT_NEAR(totals[static_cast<std::size_t>(i)],
                  moving->soft_probability(kStage, centres.col(i), covariance, 0.25), 3e-8);
    }
  }
}

/// A room with one moving disc.
SafeSet room_with_a_walker(std::shared_ptr<const ObstacleForecast> forecast) {
  SafeSet safe_set = unbounded_safe_set(3);
  safe_set.body = {.discs = {}, .x = 0, .y = 1, .heading = 2};
  Obstacle walker(DiscShape{.centre = {0.0, 0.0}, .radius = 0.5});
  walker.motion.emplace();
  safe_set.obstacles = {walker};
  safe_set.forecast = std::move(forecast);
  return safe_set;
}

TEST(MovingShape, unsafe_set_follows_the_forecast_that_it_shares) {
  auto forecast = std::make_shared<ObstacleForecast>(1);
  const UnsafeSet unsafe(room_with_a_walker(forecast));
  const Eigen::Vector3d state(3.0, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(clearance(state, unsafe), 2.5);
  EXPECT_TRUE(unsafe.is_certain(0));
  forecast->set(0, {{{.offset = {1.0, 0.0}}},
                    {{.offset = {2.0, 0.0}, .covariance = 0.01 * Eigen::Matrix2d::Identity()}}});
  EXPECT_DOUBLE_EQ(clearance(state, unsafe, 0), 1.5);
  EXPECT_NEAR(clearance(state, unsafe, 1), 0.3, 1e-12);
  EXPECT_NEAR(clearance(state, unsafe, 7), 0.3, 1e-12);  // as at the last known stage
  EXPECT_TRUE(unsafe.is_certain(0));
  EXPECT_FALSE(unsafe.is_certain(1));
}

TEST(MovingShape, without_a_forecast_it_stands_where_it_is_written) {
  const UnsafeSet unsafe(room_with_a_walker(nullptr));
  EXPECT_DOUBLE_EQ(clearance(Eigen::Vector3d(3.0, 0.0, 0.0), unsafe, 5), 2.5);
  EXPECT_TRUE(unsafe.is_certain(5));
}

TEST(MovingShape, safe_set_refuses_what_cannot_move_and_forecasts_of_others) {
  SafeSet safe_set = room_with_a_walker(std::make_shared<ObstacleForecast>(2));
  EXPECT_THROW(check_safe_set(safe_set), std::invalid_argument);
  safe_set.forecast = nullptr;
  EXPECT_NO_THROW(check_safe_set(safe_set));
  Obstacle box(Box{.lower = Eigen::Vector3d::Zero(), .upper = Eigen::Vector3d::Ones()});
  box.motion.emplace();
  safe_set.obstacles.push_back(box);
  EXPECT_THROW(check_safe_set(safe_set), std::invalid_argument);
}

TEST(ObstacleForecast, refuses_stages_without_places) {
  ObstacleForecast forecast(1);
  EXPECT_THROW(forecast.set(0, {}), std::invalid_argument);
  EXPECT_THROW(forecast.set(0, {{ObstaclePlace{}}, {}}), std::invalid_argument);
  EXPECT_THROW(forecast.set(1, {{ObstaclePlace{}}}), std::out_of_range);
}

}  // namespace moving_shape_test
}  // namespace qsmpc::controller
