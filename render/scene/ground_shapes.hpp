// Level ground, lines on it that fade into the horizon, and the sky above.
//
// The colour of fog is linear in the distance along the line of sight, as are the colours that
// OpenGL interpolates over a plane. Ground that is cut where the fog begins and ends is therefore
// drawn with fog in the colours of its corners, in a third of the time of OpenGL's own fog.
#pragma once

#include <vector>

#include "render/camera.hpp"
#include "render/colour.hpp"
#include "render/frame.hpp"

namespace qsmpc::render {

/// Between `begin` and `end` metres along the line of sight, colours fade into `colour`.
struct Fog {
  double begin = 0.0;
  double end = 1.0;
  Colour colour;
};

/// A rectangle lying on the ground; one of zero area is not drawn.
void draw_ground(const View& view, const PlanarRectangle& area, const Colour& colour,
                 const Fog& fog);

/// The ground between the rectangles `inner` and `outer`, which contains `inner`. Its edges meet
/// those of `inner` without gaps.
void draw_ground_around(const View& view, const PlanarRectangle& inner,
                        const PlanarRectangle& outer, const Colour& colour, const Fog& fog);

/// Separate lines, `width` pixels wide, between the points 0 and 1, 2 and 3, …
void draw_fading_segments(const View& view, const std::vector<SpacePoint>& ends, double width,
                          const Colour& colour, const Fog& fog);

/// A gradient between the picture's upper and lower edges. It is drawn only where nothing has been
/// drawn yet and where the ground, which extends `reach` metres from the camera in all directions,
/// will not be drawn.
void draw_sky(const View& view, double reach, const Colour& top, const Colour& bottom);

}  // namespace qsmpc::render
