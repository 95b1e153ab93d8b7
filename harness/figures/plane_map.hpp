// A drawing of the plane: its safe set, paths, belief ellipses, weighted points and contours, with
// equal axes and a legend. Colours and line widths are classes of the page's style
// (harness/report/web/page.css).
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

// Colours are numbers of the page's palette, 0 … kPaletteSize - 1, or kInk or kGrey. Names appear
// in the legend, each entry once: many paths may share a name. Without a name there is no entry.
// Non-finite values are not drawn, and the note says so.

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
  int arrow_period = 0;  ///< points from one arrowhead to the next; 0: no arrowheads
};

/// The sets {(x − m)ᵀ S⁻¹ (x − m) ≤ −2 ln(1 − p)}, which have probability p under N(m, S). S may be
/// singular; negative eigenvalues count as 0.
struct MapEllipse {
  std::string name{};
  int colour = 0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  std::vector<double> levels{0.5, 0.95};  ///< each p in (0, 1)
  std::string label{};                    ///< a short text outside the outermost ellipse
};

/// A discrete measure, or a sample. The area of a dot is proportional to its share of the weight,
/// limited so that each stays visible and none hides the rest.
struct MapCloud {
  std::string name{};
  int colour = 0;
  Eigen::Matrix2Xd points{};
  Eigen::VectorXd weights{};  ///< as many as points, not negative; empty: equal weights
};

/// One level line of a density.
struct MapContour {
  double mass = 0.0;  ///< of the enclosed region; the larger, the fainter the line
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
  bool is_waypoint = false;  ///< on the way to the target; drawn fainter
};

/// The outline of a body, drawn thin, below the paths.
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
  std::optional<MapRectangle> area{};             ///< the part shown; map_area if absent or not
                                                  ///< finite
  MapRectangle bounds = unbounded_plane();        ///< the outside is shaded
  std::vector<MapRectangle> obstacles{};          ///< sides may be infinite
  std::vector<MapRectangle> partial_obstacles{};  ///< obstacles for some of the other states only
  std::vector<MapPolygon> polygons{};             ///< obstacles, as are the half-planes
  std::vector<MapHalfPlane> half_planes{};
  std::vector<MapMover> movers{};  ///< moving obstacles
  std::vector<MapPath> lines{};    ///< on the ground, below everything that moves: a road
  std::vector<MapCircle> targets{};
  std::vector<MapContours> contours{};
  std::vector<MapCloud> clouds{};
  std::vector<MapBody> bodies{};
  std::vector<MapPath> paths{};  ///< faint ones are drawn below the others
  std::vector<MapEllipse> ellipses{};
  std::vector<MapLabel> labels{};
};

/// The part of the plane around all content of `map` except for its `area` and its movers. If the
/// bounds are finite, content farther from them than their own length is left outside. Of a
/// half-plane, the nearest point of its edge is included, unless it is farther from the other
/// content than the length of that content.
[[nodiscard]] MapRectangle map_area(const PlaneMap& map);

/// The map as a <figure>. Its file size stops growing beyond some thousands of points: of long
/// paths every n-th point is drawn, of large clouds points picked by weight. Texts are escaped.
[[nodiscard]] std::string map_figure(const PlaneMap& map);

/// Only the drawing of `map_figure`, as an <svg> of size `map_size` placed at `x`, `y` of the
/// enclosing drawing: axes and content, without title and legend.
[[nodiscard]] std::string map_drawing(const PlaneMap& map, double x = 0.0, double y = 0.0);
[[nodiscard]] MapSize map_size(const PlaneMap& map);

/// How the plane maps to the drawing.
[[nodiscard]] MapView map_view(const PlaneMap& map);

/// Whether there is something finite to draw.
[[nodiscard]] bool has_content(const PlaneMap& map);

/// The legend of its signs.
[[nodiscard]] std::vector<LegendEntry> map_legend(const PlaneMap& map);

/// Its note, followed by a statement of what the drawing leaves out.
[[nodiscard]] std::string map_note(const PlaneMap& map);

}  // namespace qsmpc::harness
