// Where the obstacles that move will be, as far as it is known now: for each stage of the horizon a
// mixture of Gaussians. Regions of an unsafe set read it whenever they are asked, so whoever owns a
// drive writes it anew between the periods (docs/theory/motion.md).
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

/// One of the ways in which an obstacle may be moved at a stage: turned about the centre of its
/// shape by an angle that is known, and offset by a vector that is Gaussian.
struct ObstaclePlace {
  double weight = 1.0;                               ///< probability of this one
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< mean, m, from where the shape is written
  double turn = 0.0;                                 ///< rad
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of the offset, m²
};

/// One obstacle at all stages, 0 being the present: the same number of places each.
using PlacesByStage = std::vector<std::vector<ObstaclePlace>>;

/// Reading from several threads at the same time is safe while nobody writes.
class ObstacleForecast {
 public:
  /// Of `obstacles` that stand where they are written until more is known.
  explicit ObstacleForecast(std::size_t obstacles) : places_(obstacles, {{ObstaclePlace{}}}) {}

  [[nodiscard]] std::size_t size() const { return places_.size(); }

  /// Weights add up to 1. Beyond the last stage that is known, those of the last.
  [[nodiscard]] std::span<const ObstaclePlace> at(std::size_t obstacle, Eigen::Index stage) const;
  /// That of the greatest weight.
  [[nodiscard]] const ObstaclePlace& likeliest(std::size_t obstacle, Eigen::Index stage) const;
  /// All stages that are known, at least one.
  [[nodiscard]] const PlacesByStage& of(std::size_t obstacle) const { return places_[obstacle]; }
  /// Whether it is known for certain where all obstacles are at a stage.
  [[nodiscard]] bool is_certain(Eigen::Index stage) const;

  /// Throws std::invalid_argument on no stages, or a stage without places.
  void set(std::size_t obstacle, PlacesByStage places);

 private:
  std::vector<PlacesByStage> places_;
};

}  // namespace qsmpc::controller

#pragma GCC visibility pop
