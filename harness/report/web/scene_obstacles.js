// The obstacles that move: upright where they truly are, and on the ground where the plan has them
// going.
import {BufferGeometry, EdgesGeometry, ExtrudeGeometry, Group, LineBasicMaterial, LineLoop,
        LineSegments, Mesh, MeshLambertMaterial, Shape, Vector2, Vector3} from "three";
import {toCreasedNormals} from "three/addons/utils/BufferGeometryUtils.js";

import {isBetween, pairsOf} from "./scene_polygon.js";

const kSeenThrough = 0.35;   // opacity, of what stands before the vehicle
const kLeastCorner = 15;     // degrees; less is part of an arc, and has no edge
const kEllipseSides = 48;
const kLeastAxis = 0.005;    // m, so that what is known for certain is a dot

function circle() {
  const points = Array.from({length: kEllipseSides}, (_, i) => {
    const angle = 2 * Math.PI * i / kEllipseSides;
    return new Vector3(Math.cos(angle), Math.sin(angle), 0);
  });
  return new BufferGeometry().setFromPoints(points);
}

export class Obstacles {
  // Of a moment of the page (scene3d.js); they are as high as `height` m.
  constructor({data, forecastEllipses, obstaclePose}, height, colours) {
    this.others = data.map.others;
    this.height = height;
    this.forecastEllipses = forecastEllipses;
    this.obstaclePose = obstaclePose;
    this.group = new Group();
    this.forecasts = new Group();
    const edge = colours.of("var(--soft)");
    this.bodies = this.others.outlines.map((outline) => this.body(outline, colours.of("var(--c0)"), edge));
    this.ellipses = Array.from({length: this.others.ways * this.others.stages.length}, () =>
      this.ellipse(colours.of("var(--c0)")));
    this.group.add(this.forecasts);
  }

  body(numbers, colour, edge) {
    const corners = pairsOf(numbers);
    const outline = new Shape(corners.map(([x, y]) => new Vector2(x, y)));
    const geometry = new ExtrudeGeometry(outline, {depth: this.height, bevelEnabled: false, steps: 1});
    const material = new MeshLambertMaterial({color: colour});
    const mesh = new Mesh(toCreasedNormals(geometry, kLeastCorner * Math.PI / 180), material);
    mesh.add(new LineSegments(new EdgesGeometry(geometry, kLeastCorner), new LineBasicMaterial({color: edge})));
    this.group.add(mesh);
    return {corners, mesh, material};
  }

  ellipse(colour) {
    const line = new LineLoop(circle(), new LineBasicMaterial({color: colour, transparent: true, depthWrite: false}));
    line.renderOrder = 1;
    line.frustumCulled = false;
    this.forecasts.add(line);
    return line;
  }

  show({period, share}) {
    this.bodies.forEach(({mesh}, n) => {
      const [x, y, turn] = this.obstaclePose(this.others, period, n, share);
      mesh.position.set(x, y, 0);
      mesh.rotation.z = turn;
    });
    if (period === this.period || this.ellipses.length === 0) return;
    this.period = period;
    this.forecastEllipses(this.others, period).forEach((ellipse, i) => {
      const line = this.ellipses[i];
      line.visible = ellipse !== null;
      if (!ellipse) return;
      line.position.set(ellipse.x, ellipse.y, 0);
      line.rotation.z = ellipse.angle;
      line.scale.set(Math.max(ellipse.major, kLeastAxis), Math.max(ellipse.minor, kLeastAxis), 1);
      line.material.opacity = ellipse.opacity;
    });
  }

  // Makes translucent what stands between two places: the eye and the vehicle.
  clear(from, to) {
    for (const {corners, mesh, material} of this.bodies) {
      const hides = isBetween(corners, this.height, mesh.worldToLocal(from.clone()), mesh.worldToLocal(to.clone()));
      if (material.transparent === hides) continue;
      material.transparent = hides;
      material.opacity = hides ? kSeenThrough : 1;
      material.depthWrite = !hides;
      material.needsUpdate = true;
    }
  }
}
