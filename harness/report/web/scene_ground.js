// What stands still: the plane with its bounds, obstacles and target.
import {Box3, BoxGeometry, BufferGeometry, CircleGeometry, CylinderGeometry, EdgesGeometry,
        ExtrudeGeometry, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial,
        MeshLambertMaterial, PlaneGeometry, Ray, RingGeometry, Shape, ShapeGeometry, Vector2, Vector3}
  from "three";
import {toCreasedNormals} from "three/addons/utils/BufferGeometryUtils.js";

import {floatsOf} from "./scene_data.js";
import {cornersOf, cut, isBetween, pairsOf, within} from "./scene_polygon.js";

const kObstacleHeight = 0.4;   // m, at least; higher than the vehicle
const kWallHeight = 0.1;       // m
const kWallThickness = 0.06;   // m
const kPostHeight = 0.75;      // m, of the target's flag, at least
const kMargin = 0.12;          // of the area, that is shown about it
const kMostGridLines = 40;
const kSeenThrough = 0.35;     // opacity
const kLeastCorner = 15;       // degrees; less is part of an arc, and has no edge

const gridStep = (length) => {
  const least = length / kMostGridLines;
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((n) => n * power).find((step) => step >= least);
};

// Lines at round multiples within [xl, xh] × [yl, yh].
function grid([xl, xh, yl, yh], z, colour) {
  const step = Math.max(gridStep(Math.max(xh - xl, yh - yl)), 1e-3);
  const points = [];
  for (let x = Math.ceil(xl / step) * step; x <= xh; x += step) {
    points.push(new Vector3(x, yl, z), new Vector3(x, yh, z));
  }
  for (let y = Math.ceil(yl / step) * step; y <= yh; y += step) {
    points.push(new Vector3(xl, y, z), new Vector3(xh, y, z));
  }
  const lines = new LineSegments(new BufferGeometry().setFromPoints(points),
                                 new LineBasicMaterial({color: colour, depthWrite: false}));
  lines.renderOrder = -1;
  return lines;
}

// A floor below a model that has no place in a plane.
export function gridAbout(box, colours) {
  const size = box.getSize(new Vector3());
  const margin = 0.5 * Math.max(size.x, size.y);
  const area = [box.min.x - margin, box.max.x + margin, box.min.y - margin, box.max.y + margin];
  const group = new Group();
  const height = Math.min(box.min.z, 0);
  group.add(grid(area, height, colours.of("var(--edge)")));
  return {group, height, extent: () => box, clear: () => {}};
}

export class Ground {
  constructor(data, vehicleHeight, colours) {
    this.height = 0;
    this.group = new Group();
    this.obstacles = [];
    this.colours = colours;
    const [xl, xh, yl, yh] = data.area;
    const margin = kMargin * Math.max(xh - xl, yh - yl);
    this.area = data.area;
    this.shown = [xl - margin, xh + margin, yl - margin, yh + margin];
    this.obstacleHeight = Math.max(kObstacleHeight, 1.15 * vehicleHeight);
    const bounds = this.clipped(data.bounds);
    this.floor(this.shown, "var(--unsafe)", -3);
    this.floor(bounds, "var(--free)", -2);
    this.group.add(grid(bounds, 0, colours.of("var(--grid)")));
    this.walls(data.bounds, bounds);
    for (const box of data.obstacles) this.obstacle(this.clipped(box), false);
    for (const box of data.partial) this.obstacle(this.clipped(box), true);
    for (const polygon of data.polygons) this.prism(within(pairsOf(floatsOf(polygon)), this.shown));
    for (const halfPlane of data.halfPlanes) this.prism(cut(cornersOf(this.shown), halfPlane));
    for (const line of data.lines) this.line(pairsOf(floatsOf(line.points)), line.faint);
    for (const target of data.targets) this.target(...target);
  }

  // What is infinite ends at the edge of what is shown.
  clipped([xl, xh, yl, yh]) {
    const [left, right, near, far] = this.shown;
    const within = (value, missing, low, high) => Math.min(Math.max(value ?? missing, low), high);
    return [within(xl, left, left, right), within(xh, right, left, right),
            within(yl, near, near, far), within(yh, far, near, far)];
  }

  // Drawn before all that lies on it, which it therefore cannot hide.
  floor([xl, xh, yl, yh], colour, order) {
    const material = new MeshBasicMaterial({color: this.colours.of(colour), depthWrite: false});
    const floor = new Mesh(new PlaneGeometry(xh - xl, yh - yl), material);
    floor.position.set((xl + xh) / 2, (yl + yh) / 2, 0);
    floor.renderOrder = order;
    this.group.add(floor);
  }

  // Of a road: its edges, and more faintly its middle.
  line(points, faint) {
    const ends = [];
    for (let i = 1; i < points.length; i++) {
      for (const [x, y] of [points[i - 1], points[i]]) ends.push(new Vector3(x, y, 0));
    }
    const colour = this.colours.of(faint ? "var(--edge)" : "var(--obstacle)");
    const lines = new LineSegments(new BufferGeometry().setFromPoints(ends),
                                   new LineBasicMaterial({color: colour, depthWrite: false}));
    lines.renderOrder = -1;
    this.group.add(lines);
  }

  box([xl, xh, yl, yh], height, material) {
    const box = new Mesh(new BoxGeometry(xh - xl, yh - yl, height), material);
    box.position.set((xl + xh) / 2, (yl + yh) / 2, height / 2);
    this.group.add(box);
    return box;
  }

  walls(given, [xl, xh, yl, yh]) {
    const material = new MeshLambertMaterial({color: this.colours.of("var(--soft)")});
    const t = kWallThickness;
    const sides = [[xl - t, xl, yl, yh], [xh, xh + t, yl, yh], [xl, xh, yl - t, yl], [xl, xh, yh, yh + t]];
    sides.forEach((side, i) => {
      if (given[i] !== null) this.box(side, kWallHeight, material);
    });
  }

  obstacleMaterial(partial) {
    return new MeshLambertMaterial({color: this.colours.of("var(--obstacle)"), transparent: partial,
                                    opacity: partial ? kSeenThrough : 1, depthWrite: !partial});
  }

  edges(geometry, position) {
    const edges = new LineSegments(geometry, new LineBasicMaterial({color: this.colours.of("var(--soft)")}));
    edges.position.copy(position);
    this.group.add(edges);
  }

  // `partial`: one that is there for some of the other states only.
  obstacle(sides, partial) {
    if (sides[1] <= sides[0] || sides[3] <= sides[2]) return;
    const material = this.obstacleMaterial(partial);
    const box = this.box(sides, this.obstacleHeight, material);
    const outer = new Box3().setFromObject(box);
    const met = new Vector3();
    const hides = (from, to) => {
      const way = to.clone().sub(from);
      const ray = new Ray(from, way.clone().normalize());
      return ray.intersectBox(outer, met) !== null && met.distanceTo(from) < way.length();
    };
    if (!partial) this.obstacles.push({material, hides});
    this.edges(new EdgesGeometry(box.geometry), box.position);
  }

  // An obstacle of any outline.
  prism(corners) {
    if (corners.length < 3) return;
    const height = this.obstacleHeight;
    const outline = new Shape(corners.map(([x, y]) => new Vector2(x, y)));
    const geometry = new ExtrudeGeometry(outline, {depth: height, bevelEnabled: false, steps: 1});
    const material = this.obstacleMaterial(false);
    // Some stand where the vehicle's file has a shape of its own, which is in front.
    Object.assign(material, {polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1});
    const mesh = new Mesh(toCreasedNormals(geometry, kLeastCorner * Math.PI / 180), material);
    this.group.add(mesh);
    this.obstacles.push({material, hides: (from, to) => isBetween(corners, height, from, to)});
    this.edges(new EdgesGeometry(geometry, kLeastCorner), mesh.position);
  }

  // Makes translucent what stands between two places: the eye and the vehicle.
  clear(from, to) {
    for (const {material, hides: hidesBetween} of this.obstacles) {
      const hides = hidesBetween(from, to);
      if (material.transparent === hides) continue;
      material.transparent = hides;
      material.opacity = hides ? kSeenThrough : 1;
      material.depthWrite = !hides;
      material.needsUpdate = true;
    }
  }

  target(x, y, radius) {
    const colour = this.colours.of("var(--c2)");
    const flat = (geometry, opacity) => {
      const material = new MeshBasicMaterial({color: colour, transparent: true, opacity, depthWrite: false});
      const mesh = new Mesh(geometry, material);
      mesh.position.set(x, y, 0);
      this.group.add(mesh);
    };
    flat(new CircleGeometry(radius, 64), 0.25);
    flat(new RingGeometry(0.93 * radius, radius, 64), 0.9);
    const height = Math.max(kPostHeight, 1.3 * this.obstacleHeight);
    const post = new Mesh(new CylinderGeometry(0.02 * height, 0.02 * height, height, 12).rotateX(Math.PI / 2),
                          new MeshLambertMaterial({color: this.colours.of("var(--soft)")}));
    post.position.set(x, y, height / 2);
    const cloth = new Shape([[0, 1], [0.45, 0.86], [0, 0.72]].map(([a, b]) => ({x: a * height, y: b * height})));
    const flag = new Mesh(new ShapeGeometry(cloth).rotateX(Math.PI / 2), new MeshBasicMaterial({color: colour, side: 2}));
    flag.position.set(x, y, 0);
    this.group.add(post, flag);
  }

  extent() {
    const [xl, xh, yl, yh] = this.area;
    return new Box3(new Vector3(xl, yl, 0), new Vector3(xh, yh, 0));
  }
}
