#include "controller/regions/planar/shape_region.hpp"

#include <algorithm>
#include <cmath>

#include "controller/regions/planar/shape_parts.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

class ShapeRegion final : public UnsafeRegion {
 public:
  ShapeRegion(const PlanarShape& shape, const Growth& growth)
      : axes_{.x = growth.x, .y = growth.y},
        parts_(shape, growth.radius),
        outline_(shape_outline(shape)) {}

  [[nodiscard]] double signed_distance(
      Eigen::Index /*stage*/, const Eigen::Ref<const Eigen::VectorXd>& point) const override {
    return parts_.nearest(plane_point(point, axes_), kInfinity).distance;
  }

  void lower_to_distances(Eigen::Index /*stage*/, const Points& points,
                          Eigen::ArrayXd& least) const override {
    lower_distances(nearest(), axes_, points, least);
  }

  void lower_to_faces(Eigen::Index /*stage*/, const Points& points,
                      NearestFaces& faces) const override {
    lower_faces(nearest(), axes_, points, faces);
  }

  double add_penalty(Eigen::Index /*stage*/, const PenaltyBatch& batch) const override {
    return add_penalty_of(nearest(), axes_, batch.scale, batch);
  }

  void add_probability(Eigen::Index /*stage*/, const SurrogateLaw& state,
                       RegionProbability& sum) const override {
    sum += parts_.probability(state, axes_);
  }

  void add_tail(Eigen::Index /*stage*/, const Gaussian& law, TailSum& sum) const override {
    add_planar_tail(law, parts_.all(), axes_, sum);
  }

  [[nodiscard]] double soft_probability(Eigen::Index /*stage*/,
                                        const Eigen::Ref<const Eigen::VectorXd>& mean,
                                        const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                        double t) const override {
    const Eigen::Vector2d centre = plane_point(mean, axes_);
    const Eigen::Matrix2d plane = plane_covariance(covariance, axes_);
    double sum = 0.0;
    for (const BoundedPart& one : parts_.all()) {
      sum += soft_probability_of(one.part, centre, plane, t);
    }
    return sum;
  }

  [[nodiscard]] std::unique_ptr<const SoftRegion> soften(
      Eigen::Index /*stage*/, const GaussianCentres& centres) const override {
    return std::make_unique<const SoftShape>(parts_.all(), axes_, centres,
                                             plane_covariance(centres.covariance, axes_));
  }

  [[nodiscard]] std::vector<HalfSpace> half_space_cover(
      Eigen::Index /*stage*/, const Eigen::Ref<const Eigen::VectorXd>& towards) const override {
    return parts_.half_space_cover(towards, axes_, {});
  }

  [[nodiscard]] Outline outline(Eigen::Index /*stage*/, Eigen::Index x,
                                Eigen::Index y) const override {
    return outline_in(outline_, axes_, x, y);
  }

 private:
  struct Nearest {
    const ShapeParts& parts;
    SurfacePoint operator()(const Eigen::Vector2d& point, double enough) const {
      return parts.nearest(point, enough);
    }
  };
  [[nodiscard]] Nearest nearest() const { return {parts_}; }

  PlaneAxes axes_;
  ShapeParts parts_;
  Eigen::Matrix2Xd outline_;  ///< of the shape itself
};

}  // namespace

RegionPointer make_shape(const PlanarShape& shape, const Growth& growth) {
  return std::make_shared<const ShapeRegion>(shape, growth);
}

}  // namespace qsmpc::controller
