// The map at one moment: vehicle, prediction, plan, belief and its particles over the ground that is
// drawn already.

const kSvg = "http://www.w3.org/2000/svg";
const kDotSizes = [1.7, 2.7, 4.2];        // pixels, by weight
const kEllipseLevels = [0.5, 0.95];       // of the probability
const kPoint = "M-6 0a6 6 0 1 0 12 0a6 6 0 1 0-12 0z";  // of a system without a heading
const kVehicle = "M-9-5.5H4L9 0 4 5.5H-9z";  // view box units, heading right
const kNearView = 3.0;                    // how many times larger the near view shows
const kNearTicks = 6;                     // about so many along its width
const kCalmClearance = 1.0;               // m, from which on the way has its calm colour

function svgElement(name, attributes, parent) {
  const element = document.createElementNS(kSvg, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (parent) parent.append(element);
  return element;
}

// The video's palettes (render/colour.cpp): of the stages, from the present to the horizon's end, and
// of the clearance, from 0 to kCalmClearance.
const kStageColours = ["#0d0887", "#39049a", "#5f01a5", "#8008a5", "#9e1a9b", "#b93389", "#cf4c74",
  "#e16561", "#f0804e", "#f99d3b", "#fcbe2c"];
const kClearanceColours = ["#c21429", "#c7ad75", "#058078"];

// The colour at `share` (0 … 1) of a palette, as #rrggbb.
function paletteAt(colours, share) {
  const place = Math.min(Math.max(share, 0), 1) * (colours.length - 1);
  const index = Math.min(Math.floor(place), colours.length - 2);
  const channels = [1, 3, 5].map((at) => {
    const [from, to] = [colours[index], colours[index + 1]]
      .map((colour) => parseInt(colour.slice(at, at + 2), 16));
    return Math.round(from + (place - index) * (to - from)).toString(16).padStart(2, "0");
  });
  return `#${channels.join("")}`;
}

const stageColour = (stage, horizon) =>
  paletteAt(kStageColours, horizon > 0 ? stage / horizon : 0);

const clearanceColour = (clearance) => paletteAt(kClearanceColours, clearance / kCalmClearance);

// Lighter where the ground is dark.
const onGround = (colour) => `color-mix(in oklab, ${colour}, white var(--lift))`;

// Of the way driven, by the clearance (m) at the end of a period.
const wayColour = (clearance) =>
  Number.isFinite(clearance) ? onGround(clearanceColour(clearance)) : "var(--soft)";

// Half axes and direction of N(0, S)'s ellipses, for S given by three numbers.
function principalAxes(xx, xy, yy) {
  const middle = (xx + yy) / 2;
  const spread = Math.hypot((xx - yy) / 2, xy);
  return {
    major: Math.sqrt(Math.max(middle + spread, 0)),
    minor: Math.sqrt(Math.max(middle - spread, 0)),
    angle: 0.5 * Math.atan2(2 * xy, xx - yy),
  };
}

// 1, 2 or 5 times a power of ten, so that about `count` of them fill `span`.
function tickStep(span, count) {
  const power = 10 ** Math.floor(Math.log10(span / count));
  const digit = span / count / power;
  return power * (digit <= 1 ? 1 : digit <= 2 ? 2 : digit <= 5 ? 5 : 10);
}

// The multiples of `step` from `low` to `high`, with their labels.
function ticksEvery(low, high, step) {
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const ticks = [];
  for (let n = Math.ceil(low / step); n * step <= high; ++n) {
    ticks.push({value: n * step, label: (n * step).toFixed(decimals).replace(/^-(?=.*[1-9])/, "−").replace(/^-/, "")});
  }
  return ticks;
}

class LiveMap {
  constructor(figure, data) {
    this.data = data;
    this.map = data.map;
    this.stages = data.horizon + 1;
    figure.hidden = false;
    this.figure = figure;
    this.view = figure.querySelector("svg.clip");
    this.zoom = 1;
    this.nearAxes = svgElement("g", {class: "near-axes"}, this.view.parentNode);
    const root = svgElement("g", {id: "moment"}, this.view);
    this.way = svgElement("g", {class: "driven"}, root);
    this.addWay();
    if (this.map.particles.stride > 1) {
      const note = document.createElement("p");
      note.className = "note";
      note.textContent = `1 of ${this.map.particles.stride} particles is drawn.`;
      figure.append(note);
    }
    this.layers = {};
    for (const name of ["forecast", "particles", "ellipses", "plan", "ghost"]) {
      this.layers[name] = svgElement("g", {id: `layer-${name}`}, root);
    }
    this.addStages();
    this.planLine = svgElement("path", {class: "planned"}, this.layers.plan);
    this.nodes = this.range().map((stage) =>
      svgElement("circle", {class: "node", r: 3.2}, this.layers.plan));
    this.nodes.forEach((node, stage) => { node.style.fill = onGround(stageColour(stage, data.horizon)); });
    const shape = Number.isFinite(this.map.poses[2]) ? kVehicle : kPoint;
    this.ghost = svgElement("path", {class: "ghost", d: shape}, this.layers.ghost);
    const bodies = svgElement("g", {id: "others"}, root);
    this.others = this.map.others &&
      new LiveObstacles(this, this.map.others, bodies, this.layers.forecast);
    this.vehicle = svgElement("path", {id: "vehicle", class: "vehicle", d: shape}, root);
    document.getElementById("near-view").addEventListener("change", (event) =>
      this.setZoom(event.target.checked ? kNearView : 1));
    for (const box of figure.querySelectorAll("input[data-layer]")) {
      const layer = this.layers[box.dataset.layer];
      box.addEventListener("change", () => layer.toggleAttribute("hidden", !box.checked));
    }
  }

  // The near view follows the vehicle, and so do the numbers of its axes.
  setZoom(zoom) {
    this.zoom = zoom;
    this.figure.classList.toggle("near-view", zoom > 1);
    if (zoom === 1) {
      this.view.removeAttribute("viewBox");
      this.nearAxes.replaceChildren();
    }
    this.show(this.period, this.share);
  }

  range() { return Array.from({length: this.stages}, (_, stage) => stage); }

  // From the plane to the view box.
  x(value) { return (value - this.map.xLeft) * this.map.scale; }
  y(value) { return (this.map.yTop - value) * this.map.scale; }
  at(x, y) { return `${this.x(x).toFixed(1)} ${this.y(y).toFixed(1)}`; }

  // One line a period, by the clearance at its end.
  addWay() {
    const {poses} = this.map;
    this.lines = [];
    for (let k = 0; k < this.data.steps; ++k) {
      const ends = [poses[3 * k], poses[3 * k + 1], poses[3 * k + 3], poses[3 * k + 4]];
      const known = ends.every(Number.isFinite);
      const line = svgElement("path", {d: known ?
        `M${this.at(ends[0], ends[1])}L${this.at(ends[2], ends[3])}` : ""}, this.way);
      line.style.stroke = wayColour(this.data.clearance[k + 1]);
      this.lines.push(line);
    }
  }

  // The last stage first: it spreads widest.
  addStages() {
    this.dots = [];
    this.ellipses = [];
    for (const stage of this.range().reverse()) {
      const colour = onGround(stageColour(stage, this.data.horizon));
      this.dots[stage] = kDotSizes.map((size) => {
        const dots = svgElement("path", {class: "dots", "stroke-width": size},
                                this.layers.particles);
        dots.style.stroke = colour;
        return dots;
      });
      this.ellipses[stage] = kEllipseLevels.map((level) => {
        const ellipse = svgElement("ellipse", {class: level > 0.9 ? "belief wide" : "belief"},
                                   this.layers.ellipses);
        ellipse.style.stroke = colour;
        return ellipse;
      });
    }
  }

  // What is known at the beginning of period k.
  showPlan(k) {
    for (const stage of this.range()) {
      this.showDots(k, stage);
      this.showEllipses(k, stage);
    }
    const {plans} = this.map;
    const nodes = this.range().map((stage) => 2 * (k * this.stages + stage))
      .map((i) => [plans[i], plans[i + 1]]);
    const known = nodes.filter((node) => node.every(Number.isFinite));
    this.planLine.setAttribute("d",
      known.map(([x, y], i) => `${i === 0 ? "M" : "L"}${this.at(x, y)}`).join(""));
    this.nodes.forEach((node, stage) => {
      const [x, y] = nodes[stage];
      node.toggleAttribute("hidden", !Number.isFinite(x + y));
      if (!Number.isFinite(x + y)) return;
      node.setAttribute("cx", this.x(x).toFixed(1));
      node.setAttribute("cy", this.y(y).toFixed(1));
    });
  }

  showDots(k, stage) {
    const {starts, x, y, sizes} = this.map.particles;
    const paths = kDotSizes.map(() => "");
    const begin = starts[k * this.stages + stage];
    const end = starts[k * this.stages + stage + 1];
    for (let i = begin; i < end; ++i) {
      if (!Number.isFinite(x[i] + y[i])) continue;
      const bucket = Math.min(Math.floor(sizes[i] * kDotSizes.length / 256), kDotSizes.length - 1);
      paths[bucket] += `M${this.at(x[i], y[i])}h0`;
    }
    paths.forEach((path, bucket) => this.dots[stage][bucket].setAttribute("d", path));
  }

  showEllipses(k, stage) {
    const begin = 5 * (k * this.stages + stage);
    const [x, y, xx, xy, yy] = this.map.moments.subarray(begin, begin + 5);
    const axes = principalAxes(xx, xy, yy);
    this.ellipses[stage].forEach((ellipse, i) => {
      const known = Number.isFinite(x + y + xx + xy + yy);
      ellipse.toggleAttribute("hidden", !known);
      if (!known) return;
      const radius = Math.sqrt(-2 * Math.log(1 - kEllipseLevels[i])) * this.map.scale;
      ellipse.setAttribute("rx", (radius * axes.major).toFixed(2));
      ellipse.setAttribute("ry", (radius * axes.minor).toFixed(2));
      const turn = (-axes.angle * 180 / Math.PI).toFixed(1);
      ellipse.setAttribute("transform", `translate(${this.at(x, y)}) rotate(${turn})`);
    });
  }

  // A pose on the way from one to another one, turned the shorter way round.
  between(from, to, share) {
    const mix = (a, b) => Number.isFinite(b) ? a + share * (b - a) : a;
    const turn = Math.atan2(Math.sin(to[2] - from[2]), Math.cos(to[2] - from[2]));
    const heading = Number.isFinite(turn) ? from[2] + share * turn : from[2];
    return [mix(from[0], to[0]), mix(from[1], to[1]), heading];
  }

  put(element, [x, y, heading]) {
    const known = Number.isFinite(x + y);
    element.toggleAttribute("hidden", !known);
    if (!known) return;
    const turn = Number.isFinite(heading) ? (-heading * 180 / Math.PI).toFixed(1) : "0";
    const size = (1 / this.zoom).toFixed(3);
    element.setAttribute("transform", `translate(${this.at(x, y)}) rotate(${turn}) scale(${size})`);
  }

  lookAt([x, y]) {
    if (this.zoom === 1 || !Number.isFinite(x + y)) return;
    const width = this.view.width.baseVal.value / this.zoom;
    const height = this.view.height.baseVal.value / this.zoom;
    const corner = [this.x(x) - width / 2, this.y(y) - height / 2];
    this.view.setAttribute("viewBox",
      [...corner, width, height].map((value) => value.toFixed(1)).join(" "));
    this.drawAxes(corner, width, height);
  }

  // Ticks about the part of the plane that begins at `corner` (view box units).
  drawAxes([left, top], width, height) {
    const {scale, xLeft, yTop} = this.map;
    const [x, y] = [this.view.x.baseVal.value, this.view.y.baseVal.value];
    const foot = y + height * this.zoom;
    const step = tickStep(width / scale, kNearTicks);
    this.nearAxes.replaceChildren();
    const text = (attributes, label) => {
      svgElement("text", attributes, this.nearAxes).textContent = label;
    };
    for (const {value, label} of ticksEvery(xLeft + left / scale, xLeft + (left + width) / scale, step)) {
      const at = (x + (this.x(value) - left) * this.zoom).toFixed(1);
      svgElement("path", {class: "axis", d: `M${at} ${foot}v5`}, this.nearAxes);
      text({class: "middle", x: at, y: foot + 18}, label);
    }
    for (const {value, label} of ticksEvery(yTop - (top + height) / scale, yTop - top / scale, step)) {
      const at = y + (this.y(value) - top) * this.zoom;
      svgElement("path", {class: "axis", d: `M${x} ${at.toFixed(1)}h-5`}, this.nearAxes);
      text({class: "end", x: x - 8, y: (at + 4).toFixed(1)}, label);
    }
  }

  // The moment that is `share` of the way through period k; share 1 of the last one is the end.
  show(k, share) {
    const {poses, predicted} = this.map;
    this.share = share;
    if (this.period !== k) {
      this.period = k;
      this.showPlan(k);
      this.lines.forEach((line, i) => line.toggleAttribute("hidden", i >= k));
    }
    if (k === this.data.steps - 1) this.lines[k].toggleAttribute("hidden", share < 1);
    this.others?.show(k, share);
    const from = poses.subarray(3 * k, 3 * k + 3);
    const to = poses.subarray(3 * k + 3, 3 * k + 6);
    const pose = this.between(from, to, share);
    this.put(this.vehicle, pose);
    this.lookAt(pose);
    this.put(this.ghost, this.between(from, predicted.subarray(3 * k, 3 * k + 3), share));
  }
}
