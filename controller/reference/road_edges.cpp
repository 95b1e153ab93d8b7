#include "controller/reference/road_edges.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace qsmpc::controller {
namespace {

// The largest deviation of a chord from its curve, m.
constexpr double kChordError = 0.008;
// Number of intervals at whose ends a segment's curvature is sampled.
constexpr int kLooks = 8;

/// A place of the path with the widths there.
struct RoadSection {
  PathPlace place;
  double right;
  double left;
};

/// The stretch from point i to the next one.
class Segment {
 public:
  Segment(const ArcPath& path, const RoadWidths& widths, Eigen::Index i)
      : path_(path), widths_(widths), from_(i), to_((i + 1) % path.point_count()) {
    begin_ = path.arc_of(i);
    length_ = path.arc_of(i + 1) - begin_;
  }

  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] RoadSection at(double share) const {
    const auto mix = [&](const Eigen::VectorXd& widths) {
      return (1.0 - share) * widths[from_] + share * widths[to_];
    };
    return {.place = path_.at(begin_ + share * length_),
            .right = mix(widths_.right),
            .left = mix(widths_.left)};
  }

 private:
  const ArcPath& path_;
  const RoadWidths& widths_;
  Eigen::Index from_;
  Eigen::Index to_;
  double begin_;
  double length_;
};

Eigen::Index segments_of(const ArcPath& path) {
  return path.closed() ? path.point_count() : path.point_count() - 1;
}

/// The number of chords that approximate the edges along the segment.
int chords_of(const Segment& segment) {
  // For a centre line of curvature κ, a chord over arc length h deviates from the edge at distance
  // w on the outside of the bend by h² κ (1 + κ w) / 8.
  double most = 0.0;
  for (int k = 0; k <= kLooks; ++k) {
    const RoadSection section = segment.at(static_cast<double>(k) / kLooks);
    const double curvature = std::abs(section.place.curvature);
    const double width = std::max(section.right, section.left);
    most = std::max(most, curvature * (1.0 + curvature * width));
  }
  const double chords = segment.length() * std::sqrt(most / (8.0 * kChordError));
  return std::max(1, static_cast<int>(std::ceil(std::min(chords, 200.0))));
}

}  // namespace

RoadEdges edges_about(const ArcPath& path, const RoadWidths& widths, double thickness) {
  std::vector<RoadSection> sections;
  for (Eigen::Index i = 0; i < segments_of(path); ++i) {
    const Segment segment(path, widths, i);
    const int chords = chords_of(segment);
    for (int k = 0; k < chords; ++k)
      sections.push_back(segment.at(k / static_cast<double>(chords)));
    if (!path.closed() && i + 1 == segments_of(path)) sections.push_back(segment.at(1.0));
  }
  RoadEdges edges{.left = Eigen::Matrix2Xd(2, std::ssize(sections)),
                  .right = Eigen::Matrix2Xd(2, std::ssize(sections)),
                  .closed = path.closed(),
                  .thickness = thickness};
  for (Eigen::Index i = 0; i < edges.left.cols(); ++i) {
    const RoadSection& section = sections[i];
    const Eigen::Vector2d to_left(-std::sin(section.place.heading),
                                  std::cos(section.place.heading));
    edges.left.col(i) = section.place.position + section.left * to_left;
    edges.right.col(i) = section.place.position - section.right * to_left;
  }
  return edges;
}

std::optional<FoldedEdge> folded_edge(const ArcPath& path, const RoadWidths& widths) {
  for (Eigen::Index i = 0; i < segments_of(path); ++i) {
    const Segment segment(path, widths, i);
    for (int k = 0; k <= kLooks; ++k) {
      const RoadSection section = segment.at(static_cast<double>(k) / kLooks);
      const double curvature = section.place.curvature;
      const double width = curvature > 0.0 ? section.left : section.right;
      if (std::abs(curvature) * width < 1.0) continue;
      return FoldedEdge{.point = i, .radius = 1.0 / std::abs(curvature), .width = width};
    }
  }
  return std::nullopt;
}

}  // namespace qsmpc::controller
