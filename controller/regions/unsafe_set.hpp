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
/// plane of position. Coordinates that are no position are as they were.
struct Growth {
  double radius = 0.0;  ///< m
  // Indices of states; -1 where the system has none.
  int x = -1;
  int y = -1;

  [[nodiscard]] bool grows(Eigen::Index axis) const {
    return radius > 0.0 && axis >= 0 && (axis == x || axis == y);
  }
};

/// One shape; a new one is a file with a class, and a line in the table.
struct ShapeEntry {
  std::string name;
  std::string summary;
  /// The region of this shape that intervals of the coordinates say, grown.
  RegionPointer (*make)(const Box& intervals, const Growth& growth) = nullptr;
};

/// The table of shapes.
[[nodiscard]] const std::vector<ShapeEntry>& region_shapes();

/// Throws std::invalid_argument on an unknown name, and on intervals that check_box refuses.
[[nodiscard]] RegionPointer make_region(std::string_view shape, const Box& intervals,
                                        const Growth& growth = {});

/// The unsafe set as one disc of the body meets it: the body is unsafe where any disc's centre is
/// in one of its regions.
struct DiscView {
  DiscPlacement placement;
  /// Of the centre; the walls first, then what is outside of the road if there is one. What
  /// restricts no position belongs to the first disc alone, so that nothing is counted twice.
  std::vector<RegionPointer> regions;
  std::size_t limits = 1;  ///< how many of them bound the safe set: the walls, and the road's
  /// The bounds of the centre that the walls are made of; lower > upper where the disc has no room.
  Box bounds;

  /// The walls, and the road's.
  [[nodiscard]] std::span<const RegionPointer> borders() const {
    return std::span(regions).first(limits);
  }
  [[nodiscard]] std::span<const RegionPointer> obstacles() const {
    return std::span(regions).subspan(limits);
  }
  /// All but the walls.
  [[nodiscard]] std::span<const RegionPointer> within_walls() const {
    return std::span(regions).subspan(1);
  }
};

/// The complement of a safe set. Copies share their regions.
class UnsafeSet {
 public:
  /// Whoever asks often should keep one. Throws std::invalid_argument as check_safe_set.
  // NOLINTNEXTLINE(google-explicit-constructor): it is the same set, in the words of its regions
  UnsafeSet(const SafeSet& safe_set);

  [[nodiscard]] Eigen::Index dim() const { return bounds_.lower.size(); }
  /// The safe set's bounds.
  [[nodiscard]] const Box& bounds() const { return bounds_; }
  [[nodiscard]] const Body& body() const { return body_; }
  /// The body's discs; one of radius 0 at the position where it is a point.
  [[nodiscard]] const std::vector<DiscView>& discs() const { return discs_; }
  /// |o| of the disc that is farthest from the position, m.
  [[nodiscard]] double reach() const { return reach_; }
  /// Whether it is known for certain where everything is at a stage.
  [[nodiscard]] bool is_certain(Eigen::Index stage) const {
    return !forecast_ || forecast_->is_certain(stage);
  }
  /// How far a disc's centre moves at most for a unit of the state.
  [[nodiscard]] double lipschitz() const { return lipschitz_; }

  // What stands in the way, whatever the body is: for drawing.
  /// The region outside of the bounds.
  [[nodiscard]] const UnsafeRegion& walls() const { return *regions_.front(); }
  /// All but the walls and the road's.
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

/// Distance of the body to the unsafe set where it is safe; else minus the depth: the least
/// distance that leads a disc out of the region it is in, or back into the bounds. Reports use it
/// as the clearance. −infinity where a coordinate is not finite.
[[nodiscard]] double clearance(const Eigen::Ref<const Eigen::VectorXd>& state,
                               const UnsafeSet& unsafe, Eigen::Index stage = 0);

/// Distance of the body to the unsafe set: 0 in it (docs/theory/certificates.md; the thesis's
/// Algorithm 3 takes a norm over the dimensions instead, which overestimates, and leaves the
/// obstacles out).
[[nodiscard]] double distance_to_unsafe(const Eigen::Ref<const Eigen::VectorXd>& state,
                                        const UnsafeSet& unsafe, Eigen::Index stage = 0);

/// The clearances of all states (dim x n); −infinity where a coordinate is not finite.
[[nodiscard]] Eigen::VectorXd clearances(const Points& states, const UnsafeSet& unsafe,
                                         Eigen::Index stage = 0);

/// What `clearances_with_slopes` works on, so that the next call allocates nothing.
struct ClearanceScratch {
  NearestFaces of_disc;
  Points centres;
  Points slopes;
};

/// The clearances of all states (dim x n) with their derivatives by the states, written to `out`,
/// whose storage is reused; +infinity, and a slope of 0, where nothing is unsafe. What it writes
/// for states that are not finite is not specified.
void clearances_with_slopes(const Points& states, const UnsafeSet& unsafe, Eigen::Index stage,
                            ClearanceScratch& scratch, NearestFaces& out);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
