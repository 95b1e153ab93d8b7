// The unsafe set as a union of regions, and the table of their shapes.
//
//   const UnsafeSet unsafe(safe_set);
//   const double distance = clearance(state, unsafe);
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"
#include "controller/regions/disc_placement.hpp"
#include "controller/regions/safe_set.hpp"
#include "controller/regions/unsafe_region.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

using RegionPointer = std::shared_ptr<const UnsafeRegion>;

/// A disc that must not touch a region: its centre must not come nearer than the radius, in the
/// plane of position. Other coordinates do not grow.
struct Growth {
  double radius = 0.0;  ///< m
  // State indices; -1 if the system has no such state.
  int x = -1;
  int y = -1;

  [[nodiscard]] bool grows(Eigen::Index axis) const {
    return radius > 0.0 && axis >= 0 && (axis == x || axis == y);
  }
};

/// An entry of the table of shapes. A new shape takes a file with its class and a line in the
/// table.
struct ShapeEntry {
  std::string name;
  std::string summary;
  /// Makes the region of this shape for the given intervals of the coordinates, grown by `growth`.
  RegionPointer (*make)(const Box& intervals, const Growth& growth) = nullptr;
};

/// The table of shapes.
[[nodiscard]] const std::vector<ShapeEntry>& region_shapes();

/// Throws std::invalid_argument on an unknown name, and on intervals that check_box refuses.
[[nodiscard]] RegionPointer make_region(std::string_view shape, const Box& intervals,
                                        const Growth& growth = {});

/// The unsafe set as seen by one disc of the body: the body is unsafe if the centre of any disc is
/// in one of that disc's regions.
struct DiscView {
  DiscPlacement placement;
  /// Unsafe regions for the disc's centre: the walls, then the outside of the road if there is one,
  /// then the obstacles. Regions that do not restrict position belong to the first disc only, so
  /// that nothing is counted twice.
  std::vector<RegionPointer> regions;
  std::size_t limits = 1;  ///< how many of them bound the safe set: the walls and any road
  /// Bounds on the centre from which the walls are made; lower > upper where the disc does not fit.
  Box bounds;

  /// The walls and the region outside the road, if there is one.
  [[nodiscard]] std::span<const RegionPointer> borders() const {
    return std::span(regions).first(limits);
  }
  [[nodiscard]] std::span<const RegionPointer> obstacles() const {
    return std::span(regions).subspan(limits);
  }
  /// All regions except the walls.
  [[nodiscard]] std::span<const RegionPointer> within_walls() const {
    return std::span(regions).subspan(1);
  }
};

/// The complement of a safe set. Copies share their regions.
class UnsafeSet {
 public:
  /// Keep the object if it is queried often. Throws std::invalid_argument as check_safe_set does.
  // NOLINTNEXTLINE(google-explicit-constructor): it is the same set, in the words of its regions
  UnsafeSet(const SafeSet& safe_set);

  [[nodiscard]] Eigen::Index dim() const { return bounds_.lower.size(); }
  /// The safe set's bounds.
  [[nodiscard]] const Box& bounds() const { return bounds_; }
  [[nodiscard]] const Body& body() const { return body_; }
  /// The body's discs; a single one of radius 0 at the position if the body is a point.
  [[nodiscard]] const std::vector<DiscView>& discs() const { return discs_; }
  /// Largest offset |o| of a disc from the position, m.
  [[nodiscard]] double reach() const { return reach_; }
  /// Whether the places of all obstacles at a stage are known with certainty.
  [[nodiscard]] bool is_certain(Eigen::Index stage) const {
    return !forecast_ || forecast_->is_certain(stage);
  }
  /// Lipschitz constant of the map from the state to a disc's centre, the largest of all discs.
  [[nodiscard]] double lipschitz() const { return lipschitz_; }

  // For drawing: the regions themselves, independent of the body.
  /// The region outside the bounds.
  [[nodiscard]] const UnsafeRegion& walls() const { return *regions_.front(); }
  /// All regions except the walls and the outside of the road.
  [[nodiscard]] std::span<const RegionPointer> obstacles() const {
    return std::span(regions_).subspan(limits_);
  }
  /// All regions, in the order of DiscView.
  [[nodiscard]] const std::vector<RegionPointer>& regions() const { return regions_; }

 private:
  Box bounds_;
  Body body_;
  std::vector<RegionPointer> regions_;
  std::size_t limits_ = 1;
  std::vector<DiscView> discs_;
  std::shared_ptr<const ObstacleForecast> forecast_;
  double reach_ = 0.0;
  double lipschitz_ = 1.0;
};

/// Distance from the body to the unsafe set if the body is safe; otherwise minus the depth, the
/// least distance that takes a disc out of the region it is in, or back into the bounds. Reports
/// use it as the clearance. −infinity where a coordinate is not finite.
[[nodiscard]] double clearance(const Eigen::Ref<const Eigen::VectorXd>& state,
                               const UnsafeSet& unsafe, Eigen::Index stage = 0);

/// Distance from the body to the unsafe set: 0 inside it (docs/theory/certificates.md; the thesis's
/// Algorithm 3 takes a norm over the dimensions instead, which overestimates, and leaves the
/// obstacles out).
[[nodiscard]] double distance_to_unsafe(const Eigen::Ref<const Eigen::VectorXd>& state,
                                        const UnsafeSet& unsafe, Eigen::Index stage = 0);

/// The clearances of all states (dim x n); −infinity where a coordinate is not finite.
[[nodiscard]] Eigen::VectorXd clearances(const Points& states, const UnsafeSet& unsafe,
                                         Eigen::Index stage = 0);

/// Scratch of `clearances_with_slopes`; reused, it makes the next call allocation-free.
struct ClearanceScratch {
  NearestFaces of_disc;
  Points centres;
  Points slopes;
};

/// Writes the clearances of all states (dim x n) and their derivatives by the states to `out`,
/// whose storage is reused; +infinity with a slope of 0 where nothing is unsafe. The results for
/// states that are not finite are unspecified.
void clearances_with_slopes(const Points& states, const UnsafeSet& unsafe, Eigen::Index stage,
                            ClearanceScratch& scratch, NearestFaces& out);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
