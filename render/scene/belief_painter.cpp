#include "render/scene/belief_painter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "render/gl/gl_points.hpp"
#include "render/gl/gl_shapes.hpp"
#include "render/palette.hpp"

namespace qsmpc::render {
namespace {

constexpr double kNearScale = 150.0;      // pixels per metre, from which on marks have full size
constexpr double kLeastShrinking = 0.55;  // of full size
constexpr double kPlanWidth = 2.2;        // pixels
constexpr double kCasingWidth = 5.0;      // pixels
constexpr double kNodeSize = 8.5;         // pixels
constexpr double kWholeStageSize = 68.0;  // pixels across, for a particle with all the weight
constexpr double kLeastSize = 3.6;        // pixels
constexpr double kLargestSize = 18.0;     // pixels
constexpr double kRawSize = 1.9;          // pixels
constexpr double kEllipseWidth = 1.7;     // pixels
constexpr double kTubeEdgeWidth = 3.5;    // pixels
constexpr std::size_t kMostEllipses = 7;
constexpr int kEllipseSides = 48;
constexpr float kParticleOpacity = 0.82F;
constexpr float kNearOpacity = 0.22F;  // of a particle's opacity, at the vehicle
constexpr double kNearLengths = 1.5;   // vehicle lengths beyond which particles do not fade
constexpr float kRawOpacity = 0.42F;
constexpr float kHalfOpacity = 0.95F;
constexpr double kForecastWidth = 1.6;    // pixels
constexpr int kForecastSides = 32;        // of an ellipse
constexpr double kForecastOpacity = 0.9;  // of a certain way, now …
constexpr double kForecastEnd = 0.3;      // … and at the plan's end
constexpr double kLeastForecast = 0.12;   // fainter ones would be invisible
constexpr float kMostOpacity = 0.75F;

// Marks shrink with the vehicle, as they would cover it when seen from afar, but stay recognisable.
double mark_scale(const View& view) {
  const double metre =
      kReferenceHeight * view.near_plane / (2.0 * view.half_height * view.distance);  // pixels
  return view.height / kReferenceHeight * std::clamp(metre / kNearScale, kLeastShrinking, 1.0);
}

SpacePoint on_ground(const PlanarPoint& point) { return {point.x, point.y, kMarkHeight}; }

// With a stencil, so that the tube is not darker where it overlaps itself in a bend.
void paint_tube(const std::vector<TubeSection>& tube) {
  std::vector<ColouredPoint> band;
  for (const TubeSection& section : tube) {
    const Colour colour = risk_colour(section.bound).with_alpha(palette::kTubeOpacity);
    band.push_back({on_ground(section.left), colour});
    band.push_back({on_ground(section.right), colour});
  }
  begin_single_coverage();
  draw_band(band);
  end_single_coverage();
}

// Painted after the particles, which would hide them.
void paint_tube_edges(const std::vector<TubeSection>& tube, double scale) {
  std::vector<ColouredPoint> left;
  std::vector<ColouredPoint> right;
  for (const TubeSection& section : tube) {
    left.push_back({on_ground(section.left), risk_colour(section.bound)});
    right.push_back({on_ground(section.right), risk_colour(section.bound)});
  }
  draw_coloured_path(left, kTubeEdgeWidth * scale);
  draw_coloured_path(right, kTubeEdgeWidth * scale);
}

void paint_raw_points(const View& view, const std::vector<PlanarPoint>& raw) {
  const auto size = static_cast<float>(kRawSize * view.height / kReferenceHeight);
  std::vector<GlPoint> points;
  points.reserve(raw.size());
  for (const PlanarPoint& point : raw) {
    points.push_back(
        {on_ground(point), std::max(size, 1.0F), palette::kRawPoint.with_alpha(kRawOpacity)});
  }
  draw_points(view, points);
}

// A disc about the vehicle in which marks are fainter.
struct Clearing {
  PlanarPoint centre;
  double radius;  // m

  [[nodiscard]] float opacity(const PlanarPoint& point) const {
    const double distance = std::hypot(point.x - centre.x, point.y - centre.y);
    const auto share = static_cast<float>(radius > 0.0 ? std::min(distance / radius, 1.0) : 1.0);
    return kNearOpacity + (1.0F - kNearOpacity) * share * share;
  }
};

void append_stage(const ParticleStage& stage, const Colour& colour, double scale,
                  const Clearing& clearing, std::vector<GlPoint>& points) {
  const std::size_t begin = points.size();
  for (std::size_t i = 0; i < stage.points.size() && i < stage.weights.size(); ++i) {
    // Area proportional to weight.
    const double size = kWholeStageSize * std::sqrt(std::max(stage.weights[i], 0.0));
    points.push_back({on_ground(stage.points[i]),
                      static_cast<float>(scale * std::clamp(size, kLeastSize, kLargestSize)),
                      colour.with_alpha(kParticleOpacity * clearing.opacity(stage.points[i]))});
  }
  std::stable_sort(points.begin() + static_cast<std::ptrdiff_t>(begin), points.end(),
                   [](const GlPoint& a, const GlPoint& b) { return a.size > b.size; });
}

// The last stage first: it spreads widest and would cover the others.
void paint_particles(const View& view, const std::vector<ParticleStage>& stages, double scale,
                     const Clearing& clearing) {
  std::vector<GlPoint> points;
  for (std::size_t i = stages.size(); i-- > 0;) {
    const Colour colour = stage_colour(static_cast<int>(i), static_cast<int>(stages.size()));
    append_stage(stages[i], colour, scale, clearing, points);
  }
  draw_points(view, points);
}

void paint_ellipse(const PlanarEllipse& ellipse, const Colour& colour, double width,
                   int sides = kEllipseSides) {
  std::vector<PlanarPoint> outline;
  for (int side = 0; side <= sides; ++side) {
    outline.push_back(on_ellipse(ellipse, 2.0 * std::numbers::pi * side / sides));
  }
  draw_path(outline, kMarkHeight, width, colour);
}

// Skips stages of a long horizon, as the lines would merge into a surface; always paints the last.
void paint_ellipses(const std::vector<BeliefEllipses>& ellipses, double scale) {
  const std::size_t every = (ellipses.size() + kMostEllipses - 1) / kMostEllipses;
  for (std::size_t i = ellipses.size(); i-- > 0;) {
    if ((ellipses.size() - 1 - i) % every != 0) continue;
    const Colour colour = stage_colour(static_cast<int>(i), static_cast<int>(ellipses.size()));
    paint_ellipse(ellipses[i].most, colour.with_alpha(kMostOpacity), kEllipseWidth * scale);
    paint_ellipse(ellipses[i].half, colour.with_alpha(kHalfOpacity), kEllipseWidth * scale);
  }
}

// Colour after the fraction `at` (0 … 1) of the time from now to the plan's end.
Colour forecast_colour(double weight, double at) {
  const double fading = kForecastOpacity + at * (kForecastEnd - kForecastOpacity);
  const double opacity = std::max(kLeastForecast, fading * std::sqrt(weight));
  return palette::kForecast.with_alpha(static_cast<float>(opacity));
}

double share_of(std::size_t index, std::size_t count) {
  return count > 1 ? static_cast<double>(index) / static_cast<double>(count - 1) : 0.0;
}

void paint_forecast(const ForecastWay& forecast, double width) {
  std::vector<ColouredPoint> way;
  for (std::size_t i = 0; i < forecast.way.size(); ++i) {
    const double share = share_of(i, forecast.way.size());
    way.push_back({on_ground(forecast.way[i]), forecast_colour(forecast.weight, share)});
  }
  draw_coloured_path(way, width);
  for (std::size_t i = 0; i < forecast.ellipses.size(); ++i) {
    const double share = share_of(i, forecast.ellipses.size());
    paint_ellipse(forecast.ellipses[i], forecast_colour(forecast.weight, share), width,
                  kForecastSides);
  }
}

void paint_plan(const View& view, const std::vector<PlanarPoint>& plan, double scale) {
  draw_path(plan, kMarkHeight, kCasingWidth * scale, palette::kPlannedCasing);
  draw_path(plan, kMarkHeight, kPlanWidth * scale, palette::kPlannedPath);
  std::vector<GlPoint> rims;
  std::vector<GlPoint> nodes;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const SpacePoint position = on_ground(plan[i]);
    const Colour colour = stage_colour(static_cast<int>(i), static_cast<int>(plan.size()));
    rims.push_back({position, static_cast<float>((kNodeSize + 3.0) * scale),
                    palette::kPlannedCasing.with_alpha(1.0F)});
    nodes.push_back({position, static_cast<float>(kNodeSize * scale), colour});
  }
  draw_points(view, rims);
  draw_points(view, nodes);
}

}  // namespace

PlanarPoint on_ellipse(const PlanarEllipse& ellipse, double angle) {
  const double first = std::cos(angle);
  const double second = std::sin(angle);
  return {ellipse.centre.x + first * ellipse.first_axis.x + second * ellipse.second_axis.x,
          ellipse.centre.y + first * ellipse.first_axis.y + second * ellipse.second_axis.y};
}

void paint_belief(const Frame& frame, const View& view, double vehicle_length) {
  const double scale = mark_scale(view);
  for (const ForecastWay& forecast : frame.forecasts) {
    paint_forecast(forecast, kForecastWidth * scale);
  }
  paint_tube(frame.tube);
  paint_raw_points(view, frame.raw_points);
  paint_particles(view, frame.particles, scale,
                  {{frame.pose.x, frame.pose.y}, kNearLengths * vehicle_length});
  paint_tube_edges(frame.tube, scale);
  paint_ellipses(frame.ellipses, scale);
  paint_plan(view, frame.planned_path, scale);
}

}  // namespace qsmpc::render
