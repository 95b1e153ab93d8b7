#include "tests/property/erring_plants.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "controller/regions/planar/convex_surface.hpp"
#include "models/constants.hpp"
#include "tests/property/random_draws.hpp"

namespace qsmpc::testing {

using controller::Box;
using controller::ModelError;
using controller::PlannerSettings;
using controller::Points;
using controller::PredictedMotion;
using controller::SafeSet;

namespace {

/// Norms of orders 2, 4 and 8, for coordinates that are `size` times a scalar with `norms`.
ModelError scaled_norms(const Eigen::VectorXd& size, const std::array<double, 3>& norms) {
  ModelError error = controller::model_error_of_size(norms[0] * size);
  error.higher[0] = norms[1] * size;
  error.higher[1] = norms[2] * size;
  return error;
}

/// From every point the shortest vector to the unsafe set; infinite where there is none.
Points ways_to_unsafe(const SafeSet& safe_set, const Points& points) {
  std::vector<Box> parts;
  std::vector<controller::ConvexPart> shapes;
  for (const controller::Obstacle& obstacle : safe_set.obstacles) {
    if (const Box* box = obstacle.box()) {
      parts.push_back(*box);
    } else {
      for (controller::ConvexPart& part : controller::convex_parts(*obstacle.shape())) {
        shapes.push_back(std::move(part));
      }
    }
  }
  for (Eigen::Index axis = 0; axis < points.rows(); ++axis) {
    Box face{.lower = Eigen::VectorXd::Constant(points.rows(), -kInfinity),
             .upper = Eigen::VectorXd::Constant(points.rows(), kInfinity)};
    face.lower[axis] = safe_set.bounds.upper[axis];
    parts.push_back(face);
    face.lower[axis] = -kInfinity;
    face.upper[axis] = safe_set.bounds.lower[axis];
    parts.push_back(face);
  }
  Points ways = Points::Constant(points.rows(), points.cols(), kInfinity);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    double least = kInfinity;
    for (const Box& part : parts) {
      const Eigen::VectorXd point = points.col(i);
      const Eigen::VectorXd way = point.cwiseMax(part.lower).cwiseMin(part.upper) - point;
      if (!(way.norm() < least)) continue;
      least = way.norm();
      ways.col(i) = way;
    }
    if (shapes.empty()) continue;
    const Eigen::Vector2d position(points(safe_set.body.x, i), points(safe_set.body.y, i));
    const controller::SurfacePoint surface = controller::nearest_surface(shapes, position);
    if (!(std::max(0.0, surface.distance) < least)) continue;
    ways.col(i).setZero();
    ways(safe_set.body.x, i) = -std::max(0.0, surface.distance) * surface.outward.x();
    ways(safe_set.body.y, i) = -std::max(0.0, surface.distance) * surface.outward.y();
  }
  return ways;
}

/// −1 or 1 in each coordinate: the direction from every point to the nearest part of the unsafe
/// set.
Points towards_unsafe(const SafeSet& safe_set, const Points& points) {
  return ways_to_unsafe(safe_set, points).unaryExpr([](double way) {
    return way < 0.0 ? -1.0 : 1.0;
  });
}

ErringPlant biased(const Eigen::VectorXd& size, Generator& generator) {
  const Eigen::VectorXd bias =
      size.unaryExpr([&](double one) { return uniform(generator, 0.0, 1.0) < 0.5 ? -one : one; });
  return {.kind = "biased",
          .norms = scaled_norms(size, {1.0, 1.0, 1.0}),
          .error = [bias](const PlantMoment& moment) {
            return Points(bias.replicate(1, moment.stepped.cols()));
          }};
}

/// Waves in one coordinate of the state, bounded by `size`.
ErringPlant wavy(const Eigen::VectorXd& size, Generator& generator) {
  const double phase = uniform(generator, 0.0, 6.0);
  const double number = uniform(generator, 0.5, 10.0);
  const auto axis = std::uniform_int_distribution<Eigen::Index>(0, size.size() - 1)(generator);
  return {.kind = "wavy",
          .norms = scaled_norms(size, {1.0, 1.0, 1.0}),
          .error = [=](const PlantMoment& moment) {
            const Eigen::RowVectorXd wave =
                (number * moment.stepped.row(axis).array() + phase).sin().matrix();
            return Points(size * wave);
          }};
}

/// Always of full size, always in the worst direction.
ErringPlant hostile(const Eigen::VectorXd& size, const SafeSet& safe_set) {
  return {.kind = "hostile",
          .norms = scaled_norms(size, {1.0, 1.0, 1.0}),
          .error = [=](const PlantMoment& moment) {
            return Points(size.asDiagonal() * towards_unsafe(safe_set, moment.stepped));
          }};
}

/// Rarely, but then large and in the worst direction.
ErringPlant jumping(const Eigen::VectorXd& size, const SafeSet& safe_set, Generator& generator) {
  const double share = uniform(generator, 0.01, 0.2);
  const double jump = 1.0 / std::sqrt(share);  // of root mean square one
  return {.kind = "jumping",
          .norms = scaled_norms(
              size, {1.0, jump * std::pow(share, 1.0 / 4.0), jump * std::pow(share, 1.0 / 8.0)}),
          .error = [=, &generator](const PlantMoment& moment) {
            Points error = size.asDiagonal() * towards_unsafe(safe_set, moment.stepped);
            for (Eigen::Index i = 0; i < error.cols(); ++i) {
              error.col(i) *= uniform(generator, 0.0, 1.0) < share ? jump : 0.0;
            }
            return error;
          }};
}

/// A hidden state driven by the past noises, h⁺ = keep h + w, adds to the error in every period.
ErringPlant dragging(double strength, const Eigen::MatrixXd& noise, Generator& generator) {
  const double keep = uniform(generator, 0.5, 0.95);
  // h is Gaussian, and its deviation never exceeds the stationary one.
  const Eigen::VectorXd size =
      strength * noise.diagonal().cwiseMax(0.0).cwiseSqrt() / std::sqrt(1.0 - keep * keep);
  return {.kind = "dragging",
          .norms = scaled_norms(size, {1.0, std::pow(3.0, 1.0 / 4.0), std::pow(105.0, 1.0 / 8.0)}),
          .error = [=, hidden = Points()](const PlantMoment& moment) mutable {
            hidden =
                hidden.size() == 0 ? moment.last_noise : Points(keep * hidden + moment.last_noise);
            return Points(strength * hidden);
          }};
}

/// Student's t with ten degrees of freedom, in the worst direction.
ErringPlant heavy_tailed(const Eigen::VectorXd& size, const SafeSet& safe_set,
                         Generator& generator) {
  constexpr double kFreedom = 10.0;
  constexpr double kSquare = kFreedom / (kFreedom - 2.0);
  constexpr double kFourth = 3.0 * kFreedom / (kFreedom - 4.0) * kSquare;
  constexpr double kEighth =
      35.0 * kFreedom * kFreedom / ((kFreedom - 6.0) * (kFreedom - 8.0)) * kFourth;
  return {.kind = "heavy-tailed",
          .norms = scaled_norms(size, {std::sqrt(kSquare), std::pow(kFourth, 1.0 / 4.0),
                                       std::pow(kEighth, 1.0 / 8.0)}),
          .error = [=, &generator](const PlantMoment& moment) {
            std::student_t_distribution<double> student(kFreedom);
            Points error = size.asDiagonal() * towards_unsafe(safe_set, moment.stepped);
            for (Eigen::Index i = 0; i < error.cols(); ++i) {
              error.col(i) *= std::abs(student(generator));
            }
            return error;
          }};
}

/// Zero, except close to the unsafe set, where it leads into it: a dependence on all past noises
/// that a certificate must not smooth away.
PlantError lurking_error(const Eigen::VectorXd& reach, const SafeSet& safe_set) {
  return [=](const PlantMoment& moment) {
    Points error = ways_to_unsafe(safe_set, moment.stepped);
    for (Eigen::Index i = 0; i < error.cols(); ++i) {
      const bool near = (error.col(i).array().abs() < reach.array()).all();
      error.col(i) *= near ? 1.0 : 0.0;
    }
    return Points(error.unaryExpr([](double one) { return std::isfinite(one) ? one : 0.0; }));
  };
}

/// Its norms: those of a variable that equals `reach` with the probability of any error (an upper
/// limit from simulated paths) and is zero otherwise.
ErringPlant lurking(const PredictedMotion& motion, const SafeSet& safe_set,
                    const Eigen::VectorXd& reach, const SampledShare& sampled,
                    Generator& generator) {
  const PlantError error = lurking_error(reach, safe_set);
  Eigen::VectorXd most = Eigen::VectorXd::Zero(reach.size());  // number of paths with an error,
                                                               // maximum over the moments
  const PlantError counted = [&](const PlantMoment& moment) {
    const Points one = error(moment);
    most = most.cwiseMax((one.array() != 0.0).cast<double>().rowwise().sum().matrix());
    return one;
  };
  (void)simulate(motion, safe_set, sampled.paths, generator, nullptr, counted);
  ErringPlant plant{
      .kind = "lurking", .norms = scaled_norms(reach, {1.0, 1.0, 1.0}), .error = error};
  for (Eigen::Index i = 0; i < reach.size(); ++i) {
    const double share = sampled.upper_limit(static_cast<int>(most[i]));
    plant.norms.root_mean_square[i] *= std::sqrt(share);
    plant.norms.higher[0][i] *= std::pow(share, 1.0 / 4.0);
    plant.norms.higher[1][i] *= std::pow(share, 1.0 / 8.0);
  }
  return plant;
}

}  // namespace

ErringPlant random_plant(const Problem& problem, const PredictedMotion& motion,
                         const SampledShare& sampled, Generator& generator) {
  const PlannerSettings& settings = problem.settings;
  const double total = std::pow(10.0, uniform(generator, -1.5, 0.5));
  const Eigen::VectorXd spread = (problem.belief.covariance.diagonal() +
                                  0.5 * settings.horizon * settings.noise_covariance.diagonal())
                                     .cwiseMax(0.0)
                                     .cwiseSqrt();
  const Eigen::VectorXd size = total / settings.horizon * spread;
  switch (std::uniform_int_distribution<int>(0, 7)(generator)) {
    case 0:
      return biased(size, generator);
    case 1:
      return wavy(size, generator);
    case 2:
      return hostile(size, settings.safe_set);
    case 3:
      return jumping(size, settings.safe_set, generator);
    case 4:
      return dragging(uniform(generator, 0.05, 0.5), settings.noise_covariance, generator);
    case 5:
    case 6:
      return lurking(motion, settings.safe_set, uniform(generator, 0.1, 0.6) * spread, sampled,
                     generator);
    default:
      return heavy_tailed(size, settings.safe_set, generator);
  }
}

ErringPlant setting_out(ErringPlant plant, Eigen::Index begin, Generator& generator) {
  const int periods = std::uniform_int_distribution<int>(1, 4)(generator);
  const double later = std::pow(10.0, uniform(generator, -1.5, 0.0));
  std::vector<double> factors;
  std::vector<ModelError> first;
  for (int k = 0; k < periods; ++k) {
    const double exponent = k == 0 ? uniform(generator, 0.5, 1.3) : uniform(generator, -0.5, 0.5);
    factors.push_back(std::pow(10.0, exponent));
    first.push_back(controller::widened(plant.norms, factors.back()));
    first.back().offset = plant.norms.root_mean_square.unaryExpr(
        [&](double one) { return uniform(generator, -5.0, 5.0) * one; });
  }
  plant.norms = controller::widened(plant.norms, later);
  plant.norms.first = first;
  plant.error = [=, error = plant.error](const PlantMoment& moment) {
    const Points one = error(moment);
    const auto period = static_cast<std::size_t>(begin + moment.stage);
    if (period >= first.size()) return Points(later * one);
    return Points((factors[period] * one).colwise() + first[period].offset);
  };
  return plant;
}

}  // namespace qsmpc::testing
