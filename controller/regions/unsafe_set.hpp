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
#include "controller/regions/safe_set.hpp"
#include "controller/regions/unsafe_region.hpp"

namespace qsmpc::controller {

using RegionPointer = std::shared_ptr<const UnsafeRegion>;

/// One shape; a new one is a file with a class, and a line in the table.
struct ShapeEntry {
  std::string name;
  std::string summary;
  /// The region of this shape that intervals of the coordinates say.
  RegionPointer (*make)(const Box& intervals) = nullptr;
};

/// The table of shapes.
[[nodiscard]] const std::vector<ShapeEntry>& region_shapes();

/// Throws std::invalid_argument on an unknown name, and on intervals that check_box refuses.
[[nodiscard]] RegionPointer make_region(std::string_view shape, const Box& intervals);

/// The complement of a safe set. Copies share their regions.
class UnsafeSet {
 public:
  /// Whoever asks often should keep one. Throws std::invalid_argument as check_safe_set.
  // NOLINTNEXTLINE(google-explicit-constructor): it is the same set, in the words of its regions
  UnsafeSet(const SafeSet& safe_set);

  [[nodiscard]] Eigen::Index dim() const { return bounds_.lower.size(); }
  /// The safe set's bounds.
  [[nodiscard]] const Box& bounds() const { return bounds_; }
  /// The region outside of them.
  [[nodiscard]] const UnsafeRegion& walls() const { return *regions_.front(); }
  /// All but the walls.
  [[nodiscard]] std::span<const RegionPointer> obstacles() const {
    return std::span(regions_).subspan(1);
  }
  /// All regions, the walls first.
  [[nodiscard]] const std::vector<RegionPointer>& regions() const { return regions_; }

 private:
  Box bounds_;
  std::vector<RegionPointer> regions_;
};

/// Distance to the unsafe set outside of it; inside it, minus the depth: the least distance that
/// leads out of the region it is in, or back into the bounds. Reports use it as the clearance.
[[nodiscard]] double clearance(const Eigen::Ref<const Eigen::VectorXd>& point,
                               const UnsafeSet& unsafe, Eigen::Index stage = 0);

/// Distance to the unsafe set: 0 in it (docs/theory/certificates.md; the thesis's Algorithm 3 takes
/// a norm over the dimensions instead, which overestimates, and leaves the obstacles out).
[[nodiscard]] double distance_to_unsafe(const Eigen::Ref<const Eigen::VectorXd>& point,
                                        const UnsafeSet& unsafe, Eigen::Index stage = 0);

/// The clearances of all points (dim x n); −infinity where a coordinate is not finite.
[[nodiscard]] Eigen::VectorXd clearances(const Points& points, const UnsafeSet& unsafe,
                                         Eigen::Index stage = 0);

}  // namespace qsmpc::controller
