// What lies on the ground and changes: the way driven, the plan, and its particles by stage.
import {BufferAttribute, BufferGeometry, CanvasTexture, Group, Points, PointsMaterial} from "three";
import {Line2} from "three/addons/lines/Line2.js";
import {LineGeometry} from "three/addons/lines/LineGeometry.js";
import {LineMaterial} from "three/addons/lines/LineMaterial.js";
import {LineSegments2} from "three/addons/lines/LineSegments2.js";
import {LineSegmentsGeometry} from "three/addons/lines/LineSegmentsGeometry.js";

const kDotSizes = [2.2, 3.4, 5.2];  // pixels, by weight, as in the map
const kWayWidth = 3.5;              // pixels
const kPlanWidth = 2.5;
const kParticleOpacity = 0.6;

// A disc, which points are cut to.
function dotTexture() {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 32;
  const context = canvas.getContext("2d");
  context.fillStyle = "#fff";
  context.beginPath();
  context.arc(16, 16, 15, 0, 2 * Math.PI);
  context.fill();
  return new CanvasTexture(canvas);
}

const known = (...values) => values.every(Number.isFinite);

export class Plan {
  constructor({data, stageColour, wayColour}, colours) {
    this.data = data;
    this.map = data.map;
    this.stages = data.horizon + 1;
    this.ink = colours.of("var(--ink)");
    this.stageColours = Array.from({length: this.stages}, (_, stage) =>
      colours.of(stageColour(stage, data.horizon)));
    this.wayColours = Array.from({length: data.steps}, (_, k) =>
      colours.of(wayColour(data.clearance[k + 1])));
    this.group = new Group();
    this.particles = new Group();
    this.addWay();
    this.addLine();
    this.addDots();
    this.group.add(this.particles, this.way, this.line);
  }

  // Flat on the ground, in the order of drawing; hidden by what stands on it.
  lay(object, order) {
    object.renderOrder = order;
    object.material.depthWrite = false;
    object.frustumCulled = false;
  }

  // One segment a period, and one within the period of the moment.
  addWay() {
    const {poses} = this.map;
    const positions = [];
    const colours = [];
    for (let k = 0; k < this.data.steps; ++k) {
      const ends = [poses[3 * k], poses[3 * k + 1], poses[3 * k + 3], poses[3 * k + 4]];
      const [x, y, toX, toY] = known(...ends) ? ends : [0, 0, 0, 0];
      positions.push(x, y, 0, toX, toY, 0);
      const colour = this.wayColours[k].toArray();
      colours.push(...colour, ...colour);
    }
    const material = () => new LineMaterial({linewidth: kWayWidth, vertexColors: true, transparent: true});
    this.driven = new LineSegments2(new LineSegmentsGeometry().setPositions(positions).setColors(colours), material());
    this.newest = new LineSegments2(new LineSegmentsGeometry(), material());
    this.way = new Group();
    this.way.add(this.driven, this.newest);
    this.lay(this.driven, 1);
    this.lay(this.newest, 1);
  }

  addLine() {
    this.line = new Line2(new LineGeometry(), new LineMaterial({linewidth: kPlanWidth, vertexColors: true, transparent: true}));
    this.lay(this.line, 3);
  }

  addDots() {
    const {starts} = this.map.particles;
    let most = 0;
    for (let i = 0; i + this.stages < starts.length; i += this.stages) {
      most = Math.max(most, starts[i + this.stages] - starts[i]);
    }
    const texture = dotTexture();
    this.dots = kDotSizes.map((size) => {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(new Float32Array(3 * most), 3));
      geometry.setAttribute("color", new BufferAttribute(new Float32Array(3 * most), 3));
      geometry.setDrawRange(0, 0);
      const dots = new Points(geometry, new PointsMaterial({
        size, sizeAttenuation: false, vertexColors: true, map: texture, alphaTest: 0.4, transparent: true,
        opacity: kParticleOpacity}));
      this.lay(dots, 2);
      this.particles.add(dots);
      return dots;
    });
  }

  // m, of the plans: from the first stage to the last.
  longest() {
    const {plans} = this.map;
    let most = 0;
    for (let k = 0; k < this.data.steps; ++k) {
      const first = 2 * k * this.stages;
      const last = first + 2 * (this.stages - 1);
      const reach = Math.hypot(plans[last] - plans[first], plans[last + 1] - plans[first + 1]);
      if (Number.isFinite(reach)) most = Math.max(most, reach);
    }
    return most;
  }

  showLine(period) {
    const {plans} = this.map;
    const positions = [];
    const colours = [];
    for (let stage = 0; stage < this.stages; ++stage) {
      const at = 2 * (period * this.stages + stage);
      if (!known(plans[at], plans[at + 1])) continue;
      positions.push(plans[at], plans[at + 1], 0);
      colours.push(...this.stageColours[stage].toArray());
    }
    this.renew(this.line, positions, colours, new LineGeometry());
  }

  // The graphics' memory of what was shown before is given back.
  renew(line, positions, colours, geometry) {
    line.geometry.dispose();
    const some = positions.length >= 6;
    line.geometry = geometry;
    if (some) geometry.setPositions(positions).setColors(colours);
    line.material.visible = some;
  }

  // The last stage first, as in the map: it spreads widest.
  showDots(period) {
    const {starts, x, y, sizes} = this.map.particles;
    const counts = kDotSizes.map(() => 0);
    for (let stage = this.stages - 1; stage >= 0; --stage) {
      const colour = this.stageColours[stage];
      const index = period * this.stages + stage;
      for (let i = starts[index]; i < starts[index + 1]; ++i) {
        if (!known(x[i], y[i])) continue;
        const bucket = Math.min(Math.floor(sizes[i] * kDotSizes.length / 256), kDotSizes.length - 1);
        const {position, color} = this.dots[bucket].geometry.attributes;
        position.setXYZ(counts[bucket], x[i], y[i], 0);
        color.setXYZ(counts[bucket]++, colour.r, colour.g, colour.b);
      }
    }
    this.dots.forEach(({geometry}, bucket) => {
      geometry.setDrawRange(0, counts[bucket]);
      geometry.attributes.position.needsUpdate = true;
      geometry.attributes.color.needsUpdate = true;
    });
  }

  show({period}, pose) {
    if (period !== this.period) {
      this.period = period;
      this.showLine(period);
      this.showDots(period);
      this.driven.geometry.instanceCount = period;
      this.driven.material.visible = period > 0;
    }
    const [x, y] = this.map.poses.subarray(3 * period, 3 * period + 2);
    const colour = this.wayColours[period].toArray();
    this.renew(this.newest, known(x, y, pose[0], pose[1]) ? [x, y, 0, pose[0], pose[1], 0] : [],
               [...colour, ...colour], new LineSegmentsGeometry());
  }
}
