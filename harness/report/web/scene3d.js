// The drive in three dimensions: a script apart from the page's, which a page without a MuJoCo model
// does not carry. The page's script sends it an event "qsmpc-moment" for every moment that is shown:
//
//   data        the page's data (data.js)
//   period      of the drive, from 0
//   share       of the way through that period
//   time        s
//   stageColour, wayColour   the page's colours, of a stage and of a clearance
//   forecastEllipses, obstaclePose   of the obstacles that move (map_obstacles.js)
//
// Its own data:
//
//   shapes      kind; size (half sides, half axes, or radius and half length along z); part: an
//               index, -1 for what stands still; place in the part; rgba; mesh: an index
//   meshes      vertices: packed floats; triangles: packed words
//   parts       how many parts move
//   times       packed floats, s: of the samples; none where the vehicle is moved as a whole
//   places      packed floats: of each sample and part; without samples of each part of a vehicle at
//               the origin
//   ground      area, bounds, obstacles, partial: x from, to, y from, to, null for no end;
//               polygons: obstacles as packed floats, x and y of the corners in turn; halfPlanes:
//               those of all (x, y) with a x + b y >= c, as a, b, c; lines: packed points, and
//               whether faint, of a road; targets: x, y, radius; no
//               ground for systems without a place in the plane
//
// A place has seven numbers: x, y, z in m, and the quaternion x, y, z, w.
import {Color, DirectionalLight, Group, HemisphereLight, Mesh, PerspectiveCamera, PlaneGeometry,
        Scene, ShadowMaterial, Vector3, WebGLRenderer} from "three";

import {Ground, gridAbout} from "./scene_ground.js";
import {Obstacles} from "./scene_obstacles.js";
import {Plan} from "./scene_plan.js";
import {Vehicle} from "./scene_vehicle.js";
import {View} from "./scene_view.js";

const kNoGraphics = "This browser has no WebGL, which the view in three dimensions needs. " +
  "Everything else on the page works without it.";
const kLostGraphics = "The browser has withdrawn the graphics from this page; reload it to restore the " +
  "view in three dimensions.";
const kMostPixels = 2;      // of the screen, per pixel of the page
const kSunTowards = new Vector3(-2, 2.4, 6).normalize();
const kShadowReach = 1.6;   // vehicle lengths about the vehicle

// The page's colours as three.js takes them: names of the style, or any CSS colour with such names.
class Colours {
  constructor() {
    this.style = getComputedStyle(document.documentElement);
    this.canvas = document.createElement("canvas").getContext("2d", {willReadFrequently: true});
    this.known = new Map();
  }

  of(text) {
    if (!this.known.has(text)) {
      const named = text.replace(/var\((--[\w-]+)\)/g, (_, name) => this.style.getPropertyValue(name));
      this.canvas.fillStyle = named;
      this.canvas.fillRect(0, 0, 1, 1);
      const [r, g, b] = this.canvas.getImageData(0, 0, 1, 1).data;
      this.known.set(text, new Color(`rgb(${r}, ${g}, ${b})`));
    }
    return this.known.get(text);
  }
}

class Panel {
  constructor(figure, data) {
    this.figure = figure;
    this.data = data;
    this.box = figure.querySelector(".scene");
    this.layers = {};
    figure.hidden = false;
    // Nothing is made before a reader comes near it.
    this.inView = false;
    new IntersectionObserver((entries) => {
      this.inView = entries[entries.length - 1].isIntersecting;
      this.request();
    }, {rootMargin: "200px"}).observe(this.box);
  }

  show(moment) {
    this.moment = moment;
    this.request();
  }

  request() {
    if (this.pending || !this.inView || !this.moment || this.failed) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = 0;
      if (!this.renderer) this.start();
      if (this.renderer) this.draw();
    });
  }

  say(words) {
    this.failed = true;
    const note = document.createElement("p");
    note.className = "empty";
    note.textContent = words;
    this.box.replaceChildren(note);
    this.box.classList.add("without");
    for (const useless of this.figure.querySelectorAll(".layers, .how")) useless.hidden = true;
  }

  start() {
    const canvas = document.createElement("canvas");
    const context = canvas.getContext("webgl2", {antialias: true, stencil: true});
    if (!context) {
      this.say(kNoGraphics);
      return;
    }
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", "The drive in three dimensions. Arrow keys rotate it, plus and " +
      "minus zoom.");
    canvas.addEventListener("webglcontextlost", () => this.say(kLostGraphics));
    this.box.append(canvas);
    this.renderer = new WebGLRenderer({canvas, context});
    this.renderer.shadowMap.enabled = true;
    this.camera = new PerspectiveCamera(40, 1, 0.1, 100);
    this.camera.up.set(0, 0, 1);
    this.build();
    this.view = new View(this.camera, canvas, () => this.request());
    this.lookFirst();
    this.listen();
    this.resize();
  }

  listen() {
    new ResizeObserver(() => this.resize()).observe(this.box);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      this.build();
      this.request();
    });
    for (const input of this.figure.querySelectorAll("input[data-scene]")) {
      input.addEventListener("change", () => this.request());
    }
    this.figure.querySelector(".whole").addEventListener("click", () => {
      this.figure.querySelector('[data-scene="follow"]').checked = false;
      this.view.frame(this.extent());
      this.request();
    });
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.box;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, kMostPixels));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.request();
  }

  // All that is shown, in the colours of the moment.
  build() {
    const {data} = this;
    this.scene?.traverse((object) => {
      object.geometry?.dispose();
      object.material?.dispose();
    });
    const colours = new Colours();
    this.scene = new Scene();
    this.scene.background = colours.of("var(--ground)").clone();
    this.vehicle = new Vehicle(data, this.moment.data.map, colours);
    this.vehicle.show(this.moment);
    const size = this.vehicle.size();
    this.ground = data.ground
      ? new Ground(data.ground, this.vehicle.height(), colours)
      : gridAbout(this.vehicle.extent(), colours);
    // Without a ground, the page's map is of two states that have no place in this view.
    this.plan = data.ground && this.moment.data.map && new Plan(this.moment, colours);
    this.others = this.plan && this.moment.data.map.others &&
      new Obstacles(this.moment, this.ground.obstacleHeight, colours);
    this.layers = {forecast: this.others?.forecasts, particles: this.plan?.particles, plan: this.plan?.line, way: this.plan?.way,
                   ghost: this.vehicle.ghost};
    this.scene.add(this.ground.group, this.vehicle.group, ...this.lights(size));
    if (this.plan) this.scene.add(this.plan.group);
    if (this.others) this.scene.add(this.others.group);
  }

  // The sun goes with the vehicle, so that its shadow is sharp; the ground takes nothing but that.
  lights(size) {
    this.sun = new DirectionalLight(0xffffff, 2.2);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    const reach = kShadowReach * size;
    Object.assign(this.sun.shadow.camera,
      {left: -reach, right: reach, top: reach, bottom: -reach, near: 0.1 * size, far: 12 * size});
    this.shade = new Mesh(new PlaneGeometry(4 * reach, 4 * reach), new ShadowMaterial({opacity: 0.3}));
    this.shade.receiveShadow = true;
    this.shade.material.depthWrite = false;
    this.sunDistance = 6 * size;
    const group = new Group();
    group.add(this.sun, this.sun.target, this.shade, new HemisphereLight(0xffffff, 0xb0b0b0, 2.3));
    return [group];
  }

  extent() { return this.data.ground ? this.ground.extent() : this.vehicle.extent(); }

  lookFirst() {
    const reach = Math.max(4.5 * this.vehicle.size(), 1.3 * (this.plan?.longest() ?? 0));
    this.centre = this.vehicle.centre();
    this.view.look(this.centre, this.vehicle.heading(), reach);
    this.view.limit(this.vehicle.size(), this.extent());
  }

  draw() {
    for (const input of this.figure.querySelectorAll("input[data-scene]")) {
      const layer = this.layers[input.dataset.scene];
      if (layer) layer.visible = input.checked;
    }
    this.vehicle.show(this.moment);
    this.plan?.show(this.moment, this.vehicle.pose);
    this.others?.show(this.moment);
    const centre = this.vehicle.centre();
    const follow = this.figure.querySelector('[data-scene="follow"]');
    if (follow.checked) this.view.move(centre.clone().sub(this.centre));
    this.centre = centre;
    this.sun.target.position.copy(centre);
    this.sun.position.copy(centre).addScaledVector(kSunTowards, this.sunDistance);
    this.shade.position.set(centre.x, centre.y, this.ground.height);
    this.ground.clear(this.camera.position, centre);
    this.others?.clear(this.camera.position, centre);
    this.renderer.render(this.scene, this.camera);
  }
}

const figure = document.getElementById("scene");
const source = document.getElementById("scene-data");
if (figure && source) {
  const panel = new Panel(figure, JSON.parse(source.textContent));
  document.addEventListener("qsmpc-moment", (event) => panel.show(event.detail));
}
