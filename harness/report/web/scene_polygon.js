// Polygons of the plane, as lists of corners [x, y] in turn. Sides are [x from, x to, y from, y to].

export const pairsOf = (numbers) =>
  Array.from({length: numbers.length / 2}, (_, i) => [numbers[2 * i], numbers[2 * i + 1]]);

export const cornersOf = ([xl, xh, yl, yh]) => [[xl, yl], [xh, yl], [xh, yh], [xl, yh]];

// The part of a polygon with a x + b y >= c (Sutherland and Hodgman 1974).
export function cut(corners, [a, b, c]) {
  const depth = ([x, y]) => a * x + b * y - c;
  return corners.flatMap((from, i) => {
    const to = corners[(i + 1) % corners.length];
    const [here, next] = [depth(from), depth(to)];
    const kept = here >= 0 ? [from] : [];
    if (here * next < 0) {
      const share = here / (here - next);
      kept.push([from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])]);
    }
    return kept;
  });
}

// The part of a polygon within sides.
export const within = (corners, [xl, xh, yl, yh]) =>
  [[1, 0, xl], [-1, 0, -xh], [0, 1, yl], [0, -1, -yh]].reduce(cut, corners);

// Whether a point is in a polygon.
function holds(corners, [x, y]) {
  let inside = false;
  corners.forEach(([ax, ay], i) => {
    const [bx, by] = corners[(i + 1) % corners.length];
    if ((ay > y) !== (by > y) && x < ax + (bx - ax) * (y - ay) / (by - ay)) inside = !inside;
  });
  return inside;
}

// Whether the ways from a to b and from c to d cross.
function cross(a, b, c, d) {
  const side = (p, q, [x, y]) => Math.sign((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]));
  return side(a, b, c) !== side(a, b, d) && side(c, d, a) !== side(c, d, b);
}

// Whether the way from one place {x, y, z} to another one leads through the upright prism of this
// outline and height.
export function isBetween(corners, height, from, to) {
  if (Math.min(from.z, to.z) > height) return false;
  // Only what is below its top.
  const below = (high, low) => {
    const share = high.z > height ? (high.z - height) / (high.z - low.z) : 0;
    return [high.x + share * (low.x - high.x), high.y + share * (low.y - high.y)];
  };
  const [begin, end] = [below(from, to), below(to, from)];
  return holds(corners, begin) || holds(corners, end) ||
    corners.some((corner, i) => cross(begin, end, corner, corners[(i + 1) % corners.length]));
}
