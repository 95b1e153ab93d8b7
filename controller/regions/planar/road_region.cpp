#include "controller/regions/planar/road_region.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "controller/regions/planar/convex_bound.hpp"
#include "controller/regions/planar/convex_surface.hpp"
#include "controller/regions/planar/polygon.hpp"
#include "controller/regions/planar/shape_parts.hpp"
#include "controller/regions/soft_part.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// Up to this many successive walls are also bounded by their hull: walls share ends, at which the
// error counts for each wall.
constexpr int kHullPieces = 4;
// Difference of squared deviations beyond which a tail is lost next to the largest one in double
// precision: a factor of e to the −37.
constexpr double kLostSquare = 2.0 * 37.0;

class RoadRegion;

/// A Gaussian in the plane about a centre.
struct PlaneLaw {
  Eigen::Matrix2d covariance;
  double deviation;  ///< upper bound of that in any direction

  explicit PlaneLaw(const Eigen::Matrix2d& plane)
      : covariance(plane), deviation(std::sqrt(std::max(0.0, plane.trace()))) {}
  /// Whether everything within t of a set at distance `gap` is in the tail.
  [[nodiscard]] bool is_far(double gap, double t) const { return gap - t > kTail * deviation; }
};

/// The walls, prepared for Gaussians of one covariance about many centres.
class SoftRoad final : public SoftRegion {
 public:
  SoftRoad(const RoadRegion& region, const GaussianCentres& centres);
  void add(double t, Eigen::Index begin, Eigen::Index count, double* totals) const override;

 private:
  /// Walls that are at least `gap` away from every centre.
  struct Group {
    int node;
    double gap;
  };

  void collect(int node, const Circle& about);

  const RoadRegion& region_;
  const Points& centres_;
  PlaneLaw law_;
  std::vector<Group> groups_;
  double hopeless_;  // from this reach on, 1 is as good a bound as any
};

class RoadRegion final : public UnsafeRegion {
 public:
  RoadRegion(std::shared_ptr<const RoadWalls> walls, const Growth& growth)
      : axes_{.x = growth.x, .y = growth.y},
        walls_(std::move(walls)),
        nodes_(walls_->nodes()),
        pieces_(walls_->pieces()),
        hulls_(nodes_.size()) {
    for (ConvexPart& piece : pieces_) piece.radius += growth.radius;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      RoadWalls::Node& node = nodes_[i];
      node.circle.radius += growth.radius;
      if (node.is_leaf() || !node.of_one_edge || node.end - node.begin > kHullPieces) continue;
      hulls_[i] = hull_of(node);
      hulls_[i].radius = growth.radius;
    }
  }

  [[nodiscard]] PlaneAxes axes() const { return axes_; }

  [[nodiscard]] double signed_distance(
      Eigen::Index /*stage*/, const Eigen::Ref<const Eigen::VectorXd>& point) const override {
    return nearest(plane_point(point, axes_), kInfinity).surface.distance;
  }

  void lower_to_distances(Eigen::Index /*stage*/, const Points& points,
                          Eigen::ArrayXd& least) const override {
    lower_distances(nearest_wall(), axes_, points, least);
  }

  void lower_to_faces(Eigen::Index /*stage*/, const Points& points,
                      NearestFaces& faces) const override {
    lower_faces(nearest_wall(), axes_, points, faces);
  }

  double add_penalty(Eigen::Index /*stage*/, const PenaltyBatch& batch) const override {
    return add_penalty_of(nearest_wall(), axes_, batch.scale, batch);
  }

  void add_probability(Eigen::Index /*stage*/, const SurrogateLaw& state,
                       RegionProbability& sum) const override {
    sum += bound_of(0, state);
  }

  void add_tail(Eigen::Index /*stage*/, const Gaussian& law, TailSum& sum) const override {
    const Eigen::Vector2d mean = plane_point(law.mean, axes_);
    const Eigen::Matrix2d covariance =
        uncertain(plane_covariance(law.covariance, axes_), law.covariance.diagonal().maxCoeff());
    const Nearest closest = nearest(mean, kInfinity);
    if (closest.piece < 0) return;  // the mean is NaN
    const double z = separation(pieces_[closest.piece], mean, covariance).z;
    const double most =
        std::min(kNoTail, std::sqrt(std::max(0.0, z) * std::max(0.0, z) + kLostSquare));
    const double reach = most * std::sqrt(largest_variance(covariance));
    add_tails_of(0, {.mean = mean, .covariance = covariance, .reach = reach}, sum);
  }

  [[nodiscard]] double soft_probability(Eigen::Index /*stage*/,
                                        const Eigen::Ref<const Eigen::VectorXd>& mean,
                                        const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                        double t) const override {
    const Eigen::Vector2d centre = plane_point(mean, axes_);
    const PlaneLaw law(plane_covariance(covariance, axes_));
    if (t >= hopeless_reach({.centre = centre, .radius = 0.0}, law)) return 1.0;
    return soft_bound(0, centre, law, t);
  }

  [[nodiscard]] std::unique_ptr<const SoftRegion> soften(
      Eigen::Index /*stage*/, const GaussianCentres& centres) const override {
    return std::make_unique<const SoftRoad>(*this, centres);
  }

  /// Empty: no useful half-space contains curved walls.
  [[nodiscard]] std::vector<HalfSpace> half_space_cover(
      Eigen::Index /*stage*/, const Eigen::Ref<const Eigen::VectorXd>& /*towards*/) const override {
    return {};
  }

  [[nodiscard]] Outline outline(Eigen::Index /*stage*/, Eigen::Index x,
                                Eigen::Index y) const override {
    Outline road = outline_in(walls_->outline(), axes_, x, y);
    road.unsafe_inside = false;
    return road;
  }

  [[nodiscard]] const RoadWalls::Node& node(int index) const { return nodes_[index]; }
  [[nodiscard]] const ConvexPart& piece(int index) const { return pieces_[index]; }

  /// A reach t from which on E(1 − d(y, walls)²/t²)₊ is more than ½ for centres within `about`, so
  /// that 1 is as useful a bound as any.
  [[nodiscard]] double hopeless_reach(const Circle& about, const PlaneLaw& law) const {
    constexpr double kTimes = 1.5;
    const double distance = std::max(0.0, nearest(about.centre, kInfinity).surface.distance);
    return kTimes * (distance + about.radius + 2.0 * law.deviation);
  }

  /// An upper bound of E(1 − d(y, walls)²/t²)₊ for y of the law about a centre and the walls of a
  /// node.
  [[nodiscard]] double soft_bound(int index, const Eigen::Vector2d& centre, const PlaneLaw& law,
                                  double t) const {
    const RoadWalls::Node& node = nodes_[index];
    const double gap = (centre - node.circle.centre).norm() - node.circle.radius;
    // Both the inside and the surrounding within t are in the tail.
    if (law.is_far(gap, t)) return 2.0 * kTailAllowance;
    if (node.is_leaf()) {
      const ConvexPart& piece = pieces_[node.begin];
      if (law.is_far(nearest_surface(piece, centre).distance, t)) return 2.0 * kTailAllowance;
      return soft_part_probability(soft_convex(piece, centre, law.covariance), t);
    }
    const double sum =
        soft_bound(node.first, centre, law, t) + soft_bound(node.second, centre, law, t);
    const ConvexPart& hull = hulls_[index];
    if (hull.corners.cols() == 0 || sum <= kNegligiblePart) return sum;
    return std::min(sum, soft_part_probability(soft_convex(hull, centre, law.covariance), t));
  }

 private:
  struct Nearest {
    SurfacePoint surface{.distance = kInfinity};
    int piece = -1;
  };
  struct TailLaw {
    const Eigen::Vector2d& mean;
    const Eigen::Matrix2d& covariance;
    double reach;
  };

  struct NearestWall {
    const RoadRegion& road;
    SurfacePoint operator()(const Eigen::Vector2d& point, double enough) const {
      return road.nearest(point, enough).surface;
    }
  };
  [[nodiscard]] NearestWall nearest_wall() const { return {*this}; }

  [[nodiscard]] ConvexPart hull_of(const RoadWalls::Node& node) const {
    Eigen::Index count = 0;
    for (int i = node.begin; i < node.end; ++i) count += pieces_[i].corners.cols();
    Eigen::Matrix2Xd corners(2, count);
    Eigen::Index to = 0;
    for (int i = node.begin; i < node.end; ++i) {
      corners.middleCols(to, pieces_[i].corners.cols()) = pieces_[i].corners;
      to += pieces_[i].corners.cols();
    }
    return convex_hull(corners);
  }

  /// The surface of the nearest wall that is nearer than `enough`, if any.
  [[nodiscard]] Nearest nearest(const Eigen::Vector2d& point, double enough) const {
    Nearest least;
    look_into(0, point, enough, least);
    return least;
  }

  void look_into(int index, const Eigen::Vector2d& point, double enough, Nearest& least) const {
    const RoadWalls::Node& node = nodes_[index];
    if (is_beyond(node.circle, point, std::min(enough, least.surface.distance))) return;
    if (node.is_leaf()) {
      const SurfacePoint surface = nearest_surface(pieces_[node.begin], point);
      if (surface.distance < least.surface.distance) {
        least = {.surface = surface, .piece = node.begin};
      }
      return;
    }
    const auto gap = [&](int child) {
      const Circle& circle = nodes_[child].circle;
      return (point - circle.centre).norm() - circle.radius;
    };
    const bool first_is_nearer = gap(node.first) <= gap(node.second);
    look_into(first_is_nearer ? node.first : node.second, point, enough, least);
    look_into(first_is_nearer ? node.second : node.first, point, enough, least);
  }

  /// Bounds for the walls of a node: jointly if they are far away, otherwise by their hull or as
  /// the sum over the walls.
  [[nodiscard]] RegionProbability bound_of(int index, const SurrogateLaw& state) const {
    const RoadWalls::Node& node = nodes_[index];
    const double far = far_probability(state, node.circle, axes_);
    if (far <= kNegligiblePart) return {.markov = far, .smooth = far};
    if (node.is_leaf()) return piece_bound(pieces_[node.begin], state);
    RegionProbability together{.markov = 1.0, .smooth = 1.0};
    const ConvexPart& hull = hulls_[index];
    if (hull.corners.cols() > 0) {
      together = convex_probability(state, hull, axes_);
      if (together.smooth <= std::max(state.worthwhile, kNegligiblePart)) return together;
    }
    const RegionProbability one = bound_of(node.first, state);
    const RegionProbability other = bound_of(node.second, state);
    return {.markov = std::min(together.markov, one.markov + other.markov),
            .smooth = std::min(together.smooth, one.smooth + other.smooth)};
  }

  /// The bound of a distant circle also holds for a half-plane beside it, and hence for a wall
  /// inside that.
  [[nodiscard]] RegionProbability piece_bound(const ConvexPart& piece,
                                              const SurrogateLaw& state) const {
    const Eigen::Vector2d mean = plane_point(state.law.mean, axes_);
    const SurfacePoint surface = nearest_surface(piece, mean);
    const Circle beside{.centre = mean - 2.0 * surface.distance * surface.outward,
                        .radius = surface.distance};
    const double far = surface.distance > 0.0 ? far_probability(state, beside, axes_) : 1.0;
    if (far <= kNegligiblePart) return {.markov = far, .smooth = far};
    return convex_probability(state, piece, axes_);
  }

  void add_tails_of(int index, const TailLaw& law, TailSum& sum) const {
    const RoadWalls::Node& node = nodes_[index];
    if (is_beyond(node.circle, law.mean, law.reach)) return;
    if (!node.is_leaf()) {
      add_tails_of(node.first, law, sum);
      add_tails_of(node.second, law, sum);
      return;
    }
    const PlanarSeparation apart = separation(pieces_[node.begin], law.mean, law.covariance);
    sum.add(apart.z, std::array<Eigen::Index, 2>{axes_.x, axes_.y},
            std::array<double, 2>{apart.slope.x(), apart.slope.y()});
  }

  PlaneAxes axes_;
  std::shared_ptr<const RoadWalls> walls_;
  std::vector<RoadWalls::Node> nodes_;  // with grown circles
  std::vector<ConvexPart> pieces_;      // grown as well
  std::vector<ConvexPart> hulls_;       // of nodes; without corners if there is none
};

SoftRoad::SoftRoad(const RoadRegion& region, const GaussianCentres& centres)
    : region_(region),
      centres_(centres.centres),
      law_(plane_covariance(centres.covariance, region.axes())) {
  const Eigen::Vector2d lowest = plane_point(centres.lowest, region.axes());
  const Eigen::Vector2d highest = plane_point(centres.highest, region.axes());
  const Circle about{.centre = 0.5 * (lowest + highest), .radius = 0.5 * (highest - lowest).norm()};
  hopeless_ = region.hopeless_reach(about, law_);
  collect(0, about);
}

/// `about`: a circle that contains all centres.
void SoftRoad::collect(int index, const Circle& about) {
  // Nodes this far away, relative to the size of `about` and the law, are not split.
  constexpr double kApart = 4.0;
  const RoadWalls::Node& node = region_.node(index);
  const double gap = (node.circle.centre - about.centre).norm() - node.circle.radius - about.radius;
  if (node.is_leaf()) {
    const double nearest = nearest_surface(region_.piece(node.begin), about.centre).distance;
    groups_.push_back({.node = index, .gap = nearest - about.radius});
  } else if (gap > kApart * (about.radius + kTail * law_.deviation)) {
    groups_.push_back({.node = index, .gap = gap});
  } else {
    collect(node.first, about);
    collect(node.second, about);
  }
}

void SoftRoad::add(double t, Eigen::Index begin, Eigen::Index count, double* totals) const {
  if (t >= hopeless_) {
    for (Eigen::Index i = 0; i < count; ++i) totals[i] += 1.0;
    return;
  }
  const PlaneAxes axes = region_.axes();
  for (const Group& group : groups_) {
    if (law_.is_far(group.gap, t)) {
      for (Eigen::Index i = 0; i < count; ++i) totals[i] += 2.0 * kTailAllowance;
      continue;
    }
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Vector2d centre(centres_(axes.x, begin + i), centres_(axes.y, begin + i));
      totals[i] += region_.soft_bound(group.node, centre, law_, t);
    }
  }
}

}  // namespace

RegionPointer make_road(std::shared_ptr<const RoadWalls> walls, const Growth& growth) {
  return std::make_shared<const RoadRegion>(std::move(walls), growth);
}

}  // namespace qsmpc::controller
