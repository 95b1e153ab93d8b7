// Where the reader looks from: turned and moved by pointers, wheel and keys.
import {Spherical, Vector3} from "three";
import {OrbitControls} from "three/addons/controls/OrbitControls.js";

const kTurn = Math.PI / 36;       // a key
const kNearer = 0.9;              // a key, of the distance
const kFirstElevation = 0.52;     // rad
const kFirstAside = 0.55;         // rad from behind the vehicle
const kWholeElevation = 0.85;     // rad
const kWholeMargin = 1.06;
const kLowest = 0.48 * Math.PI;   // from the vertical: never below the ground

export class View {
  constructor(camera, canvas, changed) {
    this.camera = camera;
    this.controls = new OrbitControls(camera, canvas);
    this.controls.maxPolarAngle = kLowest;
    this.controls.screenSpacePanning = false;
    this.controls.addEventListener("change", changed);
    this.changed = changed;
    // The wheel scrolls the page until the reader has taken hold of the view.
    this.controls.enableZoom = false;
    canvas.addEventListener("pointerdown", () => {
      canvas.focus({preventScroll: true});
      this.controls.enableZoom = true;
    });
    canvas.addEventListener("blur", () => { this.controls.enableZoom = false; });
    canvas.addEventListener("keydown", (event) => this.press(event));
  }

  press(event) {
    const turns = {ArrowLeft: [-kTurn, 0, 1], ArrowRight: [kTurn, 0, 1], ArrowUp: [0, -kTurn, 1],
                   ArrowDown: [0, kTurn, 1], "+": [0, 0, kNearer], "-": [0, 0, 1 / kNearer]};
    const turn = turns[event.key === "=" ? "+" : event.key];
    if (!turn || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    this.turn(...turn);
  }

  // By angles about the vertical and from it (rad), and to a multiple of the distance.
  turn(about, from, distance) {
    const {target, minDistance, maxDistance} = this.controls;
    // Spherical has its axis along y.
    const offset = this.camera.position.clone().sub(target);
    const place = new Spherical().setFromVector3(new Vector3(offset.y, offset.z, offset.x));
    place.theta += about;
    place.phi = Math.min(Math.max(place.phi + from, 0.02), kLowest);
    place.radius = Math.min(Math.max(place.radius * distance, minDistance), maxDistance);
    const turned = new Vector3().setFromSpherical(place);
    this.camera.position.copy(target).add(new Vector3(turned.z, turned.x, turned.y));
    this.controls.update();
    this.changed();
  }

  place(target, azimuth, elevation, distance) {
    this.controls.target.copy(target);
    this.camera.position.copy(target).add(new Vector3(
      distance * Math.cos(elevation) * Math.cos(azimuth),
      distance * Math.cos(elevation) * Math.sin(azimuth), distance * Math.sin(elevation)));
    this.controls.update();
  }

  // From behind a vehicle with that heading; without one, from the side.
  look(centre, heading, distance) {
    const azimuth = heading === null ? -Math.PI / 2 + kFirstAside : heading + Math.PI + kFirstAside;
    this.place(centre, azimuth, heading === null ? 0.3 : kFirstElevation, distance);
  }

  // All of a box, from above its side, as near as it fits.
  frame(box) {
    const centre = box.getCenter(new Vector3());
    const back = new Vector3(0, -Math.cos(kWholeElevation), Math.sin(kWholeElevation));
    const up = new Vector3(0, Math.sin(kWholeElevation), Math.cos(kWholeElevation));
    const high = Math.tan(this.camera.fov * Math.PI / 360);
    let distance = 0;
    for (let corner = 0; corner < 8; ++corner) {
      const at = new Vector3(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                             corner & 4 ? box.max.z : box.min.z).sub(centre);
      const needed = Math.max(Math.abs(at.x) / (high * this.camera.aspect), Math.abs(at.dot(up)) / high);
      distance = Math.max(distance, needed + at.dot(back));
    }
    this.place(centre, -Math.PI / 2, kWholeElevation, kWholeMargin * distance);
  }

  limit(least, box) {
    const size = box.getSize(new Vector3()).length();
    this.controls.minDistance = 0.7 * least;
    this.controls.maxDistance = 4 * Math.max(size, least);
    this.camera.near = 0.05 * least;
    this.camera.far = 10 * Math.max(size, least);
    this.camera.updateProjectionMatrix();
  }

  move(offset) {
    if (offset.lengthSq() === 0) return;
    this.controls.target.add(offset);
    this.camera.position.add(offset);
    this.controls.update();
  }
}
