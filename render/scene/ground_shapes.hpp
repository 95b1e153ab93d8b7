// Level ground and lines on it that fade into the horizon, and the sky above it.
//
// The colour of fog is linear in the distance along the line of sight, as are the colours that
// OpenGL interpolates over a plane; so ground that is cut where the fog begins and ends is drawn
// with fog in its corners' colours, at a third of the time that OpenGL's own fog takes.
#pragma once

#include <vector>

#include "render/camera.hpp"
#include "render/colour.hpp"
#include "render/frame.hpp"

namespace qsmpc::render {

/// From `begin` to `end` metres along the line of sight, colours go over into `colour`.
struct Fog {
  double begin = 0.0;
  double end = 1.0;
  Colour colour;
};

/// A rectangle lying on the ground; of no area: nothing.
void draw_ground(const View& view, const PlanarRectangle& area, const Colour& colour,
                 const Fog& fog);

/// What lies between the rectangles `inner` and `outer`, which holds it, on the ground. Its edges
/// meet those of `inner` without a gap.
void draw_ground_around(const View& view, const PlanarRectangle& inner,
                        const PlanarRectangle& outer, const Colour& colour, const Fog& fog);

/// Separate lines, `width` pixels wide, between the points 0 and 1, 2 and 3, …
void draw_fading_segments(const View& view, const std::vector<SpacePoint>& ends, double width,
                          const Colour& colour, const Fog& fog);

/// A gradient between the picture's upper and lower edge, where nothing has been drawn and the
/// ground, which reaches `reach` metres from the camera in all directions, will not be.
void draw_sky(const View& view, double reach, const Colour& top, const Colour& bottom);

}  // namespace qsmpc::render
