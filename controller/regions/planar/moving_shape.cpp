#include "controller/regions/planar/moving_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "controller/regions/planar/shape_parts.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// Less probable places are ignored for distances.
constexpr double kImprobable = 1e-3;
// Beyond this many standard deviations a tail is below 10⁻²³ and is left out: of many moving
// obstacles, most are that far away.
constexpr double kNoMovingTail = 10.0;

/// The largest standard deviation in any direction.
double largest_deviation(const Eigen::Matrix2d& covariance) {
  return std::sqrt(std::max(0.0, largest_variance(covariance)));
}

/// The places of one stage, prepared for Gaussians about many centres.
class SoftPlaces final : public SoftRegion {
 public:
  /// Keeps references to the centres.
  SoftPlaces(PlaneAxes axes, const GaussianCentres& centres, std::size_t count)
      : axes_(axes), centres_(centres) {
    places_.reserve(count);  // shapes keep references to their parts
  }

  void take(double weight, std::vector<BoundedPart> parts, const Eigen::Matrix2d& covariance) {
    Place& place = places_.emplace_back(Place{.weight = weight, .parts = std::move(parts)});
    place.shape = std::make_unique<const SoftShape>(
        place.parts, axes_, centres_, plane_covariance(centres_.covariance, axes_) + covariance);
  }

  void add(double t, Eigen::Index begin, Eigen::Index count, double* totals) const override {
    for (const Place& place : places_) {
      std::array<double, kSoftBlock> here{};
      place.shape->add(t, begin, count, here.data());
      for (Eigen::Index i = 0; i < count; ++i) totals[i] += place.weight * std::min(1.0, here[i]);
    }
  }

 private:
  struct Place {
    double weight;
    std::vector<BoundedPart> parts;
    std::unique_ptr<const SoftShape> shape{};
  };

  PlaneAxes axes_;
  GaussianCentres centres_;
  std::vector<Place> places_;
};

class MovingShape final : public UnsafeRegion {
 public:
  MovingShape(const PlanarShape& shape, const Growth& growth,
              std::shared_ptr<const ObstacleForecast> forecast, std::size_t index)
      : axes_{.x = growth.x, .y = growth.y},
        parts_(shape, growth.radius),
        centre_(shape_centre(shape)),
        outline_(shape_outline(shape)),
        forecast_(std::move(forecast)),
        index_(index) {
    for (const BoundedPart& one : parts_.all()) {
      radius_ = std::max(radius_, (one.circle.centre - centre_).norm() + one.circle.radius);
    }
  }

  [[nodiscard]] double signed_distance(
      Eigen::Index stage, const Eigen::Ref<const Eigen::VectorXd>& point) const override {
    double least = kInfinity;
    for (const ObstaclePlace& place : forecast_->at(index_, stage)) {
      if (place.weight < kImprobable) continue;
      least = std::min(least, Grown(*this, place)(plane_point(point, axes_), least).distance);
    }
    return least;
  }

  void lower_to_distances(Eigen::Index stage, const Points& points,
                          Eigen::ArrayXd& least) const override {
    for (const ObstaclePlace& place : forecast_->at(index_, stage)) {
      if (place.weight < kImprobable) continue;
      lower_distances(Grown(*this, place), axes_, points, least);
    }
  }

  void lower_to_faces(Eigen::Index stage, const Points& points,
                      NearestFaces& faces) const override {
    for (const ObstaclePlace& place : forecast_->at(index_, stage)) {
      if (place.weight < kImprobable) continue;
      lower_faces(Grown(*this, place), axes_, points, faces);
    }
  }

  double add_penalty(Eigen::Index stage, const PenaltyBatch& batch) const override {
    double value = 0.0;
    for (const ObstaclePlace& place : forecast_->at(index_, stage)) {
      value += add_penalty_of(Grown(*this, place), axes_, place.weight * batch.scale, batch);
    }
    return value;
  }

  void add_probability(Eigen::Index stage, const SurrogateLaw& state,
                       RegionProbability& sum) const override {
    for (const ObstaclePlace& place : forecast_->at(index_, stage)) {
      SurrogateLaw here = state;
      here.useful = std::min(1.0, state.useful / place.weight);
      const RegionProbability bound = parts_.probability(
          here, axes_, {.motion = motion(place), .covariance = place.covariance});
      sum.markov += place.weight * std::min(1.0, bound.markov);
      sum.smooth += place.weight * std::min(1.0, bound.smooth);
    }
  }

  void add_tail(Eigen::Index stage, const Gaussian& law, TailSum& sum) const override {
    const std::array<Eigen::Index, 2> plane = {axes_.x, axes_.y};
    const double largest = law.covariance.diagonal().maxCoeff();
    const double floor = least_variance(largest);
    const Eigen::Vector2d at = plane_point(law.mean, axes_);
    const Eigen::Matrix2d within = plane_covariance(law.covariance, axes_);
    for (const ObstaclePlace& place : forecast_->at(index_, stage)) {
      const Eigen::Matrix2d spread = within + place.covariance;
      // The trace, which is easier to compute, settles most places.
      if (is_far(place, at, spread.trace() + 2.0 * floor) ||
          is_far(place, at, largest_variance(spread) + floor)) {
        continue;
      }
      const PlaneMotion where = motion(place);
      const Eigen::Vector2d mean = where.back(at);
      const Eigen::Matrix2d covariance =
          uncertain(where.turn.transpose() * spread * where.turn, largest);
      const double reach = kNoMovingTail * largest_deviation(covariance);
      for (const BoundedPart& one : parts_.all()) {
        if (is_beyond(one.circle, mean, reach)) continue;
        const PlanarSeparation apart = separation(one.part, mean, covariance);
        const Eigen::Vector2d slope = where.turn * apart.slope;
        sum.add(apart.z, plane, std::array<double, 2>{slope.x(), slope.y()}, place.weight);
      }
    }
  }

  [[nodiscard]] double distance_without_tail(Eigen::Index stage,
                                             const Gaussian& law) const override {
    const double floor = least_variance(law.covariance.diagonal().maxCoeff());
    const Eigen::Matrix2d within = plane_covariance(law.covariance, axes_);
    const Eigen::Vector2d at = plane_point(law.mean, axes_);
    double least = kInfinity;
    for (const ObstaclePlace& place : forecast_->at(index_, stage)) {
      const double deviation = std::sqrt(largest_variance(within + place.covariance) + floor);
      const double distance = (at - centre_ - place.offset).norm();
      least = std::min(least, distance - radius_ - kNoMovingTail * deviation);
    }
    return std::max(0.0, least);
  }

  [[nodiscard]] double soft_probability(Eigen::Index stage,
                                        const Eigen::Ref<const Eigen::VectorXd>& mean,
                                        const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                        double t) const override {
    double sum = 0.0;
    for (const ObstaclePlace& place : forecast_->at(index_, stage)) {
      const PlaneMotion where = motion(place);
      const Eigen::Matrix2d spread = plane_covariance(covariance, axes_) + place.covariance;
      double here = 0.0;
      for (const BoundedPart& one : parts_.all()) {
        here += soft_probability_of(where.of(one).part, plane_point(mean, axes_), spread, t);
      }
      sum += place.weight * std::min(1.0, here);
    }
    return sum;
  }

  [[nodiscard]] std::unique_ptr<const SoftRegion> soften(
      Eigen::Index stage, const GaussianCentres& centres) const override {
    const std::span<const ObstaclePlace> places = forecast_->at(index_, stage);
    auto soft = std::make_unique<SoftPlaces>(axes_, centres, places.size());
    for (const ObstaclePlace& place : places) {
      const PlaneMotion where = motion(place);
      std::vector<BoundedPart> parts;
      for (const BoundedPart& one : parts_.all()) parts.push_back(where.of(one));
      soft->take(place.weight, std::move(parts), place.covariance);
    }
    return soft;
  }

  [[nodiscard]] std::vector<HalfSpace> half_space_cover(
      Eigen::Index stage, const Eigen::Ref<const Eigen::VectorXd>& towards) const override {
    // The dependence between uncertain places of two stages is unknown here.
    const std::span<const ObstaclePlace> places = forecast_->at(index_, stage);
    if (places.size() != 1 || !places[0].covariance.isZero(0.0)) return {};
    return parts_.half_space_cover(towards, axes_, motion(places[0]));
  }

  [[nodiscard]] Outline outline(Eigen::Index stage, Eigen::Index x, Eigen::Index y) const override {
    const PlaneMotion where = motion(forecast_->likeliest(index_, stage));
    Eigen::Matrix2Xd corners = outline_;
    for (auto corner : corners.colwise()) corner = where.of(corner);
    return outline_in(corners, axes_, x, y);
  }

 private:
  /// The shape at one of its places, grown by kKeptDeviations.
  class Grown {
   public:
    Grown(const MovingShape& shape, const ObstaclePlace& place)
        : parts_(shape.parts_),
          where_(shape.motion(place)),
          growth_(kKeptDeviations * largest_deviation(place.covariance)) {}

    /// As ShapeParts::nearest.
    [[nodiscard]] SurfacePoint operator()(const Eigen::Vector2d& point, double enough) const {
      SurfacePoint surface = parts_.nearest(where_.back(point), enough + growth_);
      surface.distance -= growth_;
      surface.outward = where_.turn * surface.outward;
      return surface;
    }

   private:
    const ShapeParts& parts_;
    PlaneMotion where_;
    double growth_;
  };

  /// Whether every part's tail is left out. variance: an upper bound in any direction.
  [[nodiscard]] bool is_far(const ObstaclePlace& place, const Eigen::Vector2d& mean,
                            double variance) const {
    return is_beyond({.centre = centre_ + place.offset, .radius = radius_}, mean,
                     kNoMovingTail * std::sqrt(std::max(0.0, variance)));
  }

  [[nodiscard]] PlaneMotion motion(const ObstaclePlace& place) const {
    PlaneMotion where{.centre = centre_, .shift = place.offset};
    if (place.turn != 0.0) where.turn = Eigen::Rotation2Dd(place.turn).toRotationMatrix();
    return where;
  }

  PlaneAxes axes_;
  ShapeParts parts_;
  Eigen::Vector2d centre_;
  double radius_ = 0.0;       ///< about the centre, of all parts, however they are turned
  Eigen::Matrix2Xd outline_;  ///< of the shape itself, as specified
  std::shared_ptr<const ObstacleForecast> forecast_;
  std::size_t index_;
};

}  // namespace

RegionPointer make_moving_shape(const PlanarShape& shape, const Growth& growth,
                                std::shared_ptr<const ObstacleForecast> forecast,
                                std::size_t index) {
  return std::make_shared<const MovingShape>(shape, growth, std::move(forecast), index);
}

}  // namespace qsmpc::controller
