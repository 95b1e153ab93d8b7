// A drawing of the plane: what is safe in it, and paths, belief ellipses, weighted points and
// contours, with equal axes and a legend. Colours and line widths are classes of the page's style
// (page_style.hpp).
//
//   map_figure({.title = "Corridor", .x_label = "x (m)", .y_label = "y (m)",
//               .obstacles = {{.x_lower = 2, .x_upper = 4, .y_lower = 3, .y_upper = 5}},
//               .targets = {{.centre = {9, 8}, .radius = 0.5}},
//               .paths = {{.name = "driven", .colour = kInk, .points = points}}});
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/body_outline.hpp"
#include "harness/figures/legend.hpp"
#include "harness/figures/map_canvas.hpp"
#include "harness/figures/map_movers.hpp"
#include "harness/figures/map_regions.hpp"

namespace qsmpc::harness {

// Colours are of the page's palette, 0 … kPaletteSize - 1, or kInk or kGrey. Names stand in the
// legend, where the same entry stands once: many paths may have one name. Without a name, there is
// no entry. What is not finite is not drawn, and said so.

enum class MapMark { kNone, kDot, kSquare };

/// A line through `points`, interrupted where one is not finite.
struct MapPath {
  std::string name{};
  int colour = 0;
  std::vector<MapPoint> points{};
  bool faint = false;  ///< one of many
  bool dashed = false;
  MapMark start_mark = MapMark::kNone;
  MapMark end_mark = MapMark::kNone;
  int arrow_period = 0;  ///< points from one arrowhead to the next; 0: none
};

/// The sets {(x − m)ᵀ S⁻¹ (x − m) ≤ −2 ln(1 − p)}, which hold the part p of N(m, S). S may be
/// singular; negative eigenvalues count as 0.
struct MapEllipse {
  std::string name{};
  int colour = 0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  std::vector<double> levels{0.5, 0.95};  ///< each p in (0, 1)
  std::string label{};                    ///< a short text outside of the outermost one
};

/// A discrete measure, or a sample. The area of a dot is proportional to its share of the weight,
/// within what can be seen and does not hide the rest.
struct MapCloud {
  std::string name{};
  int colour = 0;
  Eigen::Matrix2Xd points{};
  Eigen::VectorXd weights{};  ///< as many, not negative; none: all the same
};

/// One line of a density's level.
struct MapContour {
  double mass = 0.0;  ///< that the region holds; the more, the fainter the line
  Eigen::Matrix2Xd points{};
};

struct MapContours {
  std::string name{};
  int colour = 0;
  std::vector<MapContour> lines{};
};

struct MapCircle {
  MapPoint centre{};
  double radius = 0.0;
  bool is_waypoint = false;  ///< on the way to the target; fainter
};

/// The outline of a body, thin, below the paths.
struct MapBody {
  std::string name{};
  int colour = 0;
  std::vector<controller::Arc> arcs{};
};

/// A short text beside a point, such as "0.5 s".
struct MapLabel {
  std::string text{};
  MapPoint at{};
};

struct PlaneMap {
  std::string title{};
  std::string note{};  ///< below the title, in small print
  std::string x_label{};
  std::string y_label{};
  std::optional<MapRectangle> area{};             ///< what is shown; none, or not finite: map_area
  MapRectangle bounds = unbounded_plane();        ///< what is outside of them is shaded
  std::vector<MapRectangle> obstacles{};          ///< sides may be infinite
  std::vector<MapRectangle> partial_obstacles{};  ///< for some of the other states only
  std::vector<MapPolygon> polygons{};             ///< obstacles, as are the next
  std::vector<MapHalfPlane> half_planes{};
  std::vector<MapMover> movers{};  ///< obstacles that move
  std::vector<MapPath> lines{};    ///< on the ground, below all that moves: of a road
  std::vector<MapCircle> targets{};
  std::vector<MapContours> contours{};
  std::vector<MapCloud> clouds{};
  std::vector<MapBody> bodies{};
  std::vector<MapPath> paths{};  ///< faint ones are drawn below the others
  std::vector<MapEllipse> ellipses{};
  std::vector<MapLabel> labels{};
};

/// The part of the plane about all that `map` holds, its `area` and what moves aside. Where the
/// bounds are finite, what is farther away from them than their own length is left outside. Of a
/// half-plane it holds what of its edge is nearest, unless that is farther away than all else is
/// long.
[[nodiscard]] MapRectangle map_area(const PlaneMap& map);

/// The map as a <figure>. Its size does not grow with the number of points beyond some thousands:
/// of long paths every n-th point is drawn, of large clouds points picked by their weight. Texts
/// are escaped.
[[nodiscard]] std::string map_figure(const PlaneMap& map);

/// The drawing of `map_figure` alone, as an <svg>, `map_size` units large and placed at `x`, `y` of
/// what it is put into: axes and content, without title and legend.
[[nodiscard]] std::string map_drawing(const PlaneMap& map, double x = 0.0, double y = 0.0);
[[nodiscard]] MapSize map_size(const PlaneMap& map);

/// How the plane lies in the map of the drawing.
[[nodiscard]] MapView map_view(const PlaneMap& map);

/// Whether there is something finite to draw.
[[nodiscard]] bool has_content(const PlaneMap& map);

/// What its signs mean.
[[nodiscard]] std::vector<LegendEntry> map_legend(const PlaneMap& map);

/// Its note, and what the drawing leaves out, so that nothing is hidden.
[[nodiscard]] std::string map_note(const PlaneMap& map);

}  // namespace qsmpc::harness
