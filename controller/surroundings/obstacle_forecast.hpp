// A forecast of the moving obstacles' places: a mixture of Gaussians for each stage of the horizon.
// Regions of an unsafe set read it on every query, so the owner of a drive rewrites it between
// periods (docs/theory/motion.md).
//
//   auto forecast = std::make_shared<ObstacleForecast>(1);
//   safe_set.forecast = forecast;            // before controllers are made of it
//   forecast->set(0, filter.forecast(20));   // in every period
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// One possible displacement of an obstacle at a stage: a rotation by a known angle about the
/// centre of its shape, and a Gaussian offset.
struct ObstaclePlace {
  double weight = 1.0;                               ///< probability of this displacement
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< mean, m, from where the shape is defined
  double turn = 0.0;                                 ///< rad
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of the offset, m²
};

/// One obstacle at all stages, 0 being the present; the number of places is the same at each.
using PlacesByStage = std::vector<std::vector<ObstaclePlace>>;

/// Concurrent reads are safe while nobody writes.
class ObstacleForecast {
 public:
  /// A forecast of `obstacles` obstacles, which stay where they are defined until `set` is called.
  explicit ObstacleForecast(std::size_t obstacles) : places_(obstacles, {{ObstaclePlace{}}}) {}

  [[nodiscard]] std::size_t size() const { return places_.size(); }

  /// The places of an obstacle at a stage; weights sum to 1. Beyond the last known stage, those of
  /// the last.
  [[nodiscard]] std::span<const ObstaclePlace> at(std::size_t obstacle, Eigen::Index stage) const;
  /// The place of greatest weight.
  [[nodiscard]] const ObstaclePlace& likeliest(std::size_t obstacle, Eigen::Index stage) const;
  /// All known stages, at least one.
  [[nodiscard]] const PlacesByStage& of(std::size_t obstacle) const { return places_[obstacle]; }
  /// Whether the places of all obstacles at a stage are certain.
  [[nodiscard]] bool is_certain(Eigen::Index stage) const;

  /// Sets an obstacle's places. Throws std::invalid_argument if there are no stages, or a stage has
  /// no places.
  void set(std::size_t obstacle, PlacesByStage places);

 private:
  std::vector<PlacesByStage> places_;
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
