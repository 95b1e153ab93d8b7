// The vehicle's MuJoCo model, and its ghost: where the model without noise would have it.
import {Box3, BoxGeometry, BufferAttribute, BufferGeometry, CapsuleGeometry, CylinderGeometry,
        EqualStencilFunc, Euler, Group, IncrementStencilOp, Matrix4, Mesh, MeshLambertMaterial,
        Quaternion, ReplaceStencilOp, SphereGeometry, SRGBColorSpace, Vector3} from "three";

import {floatsOf, wordsOf} from "./scene_data.js";

const kPlaceSize = 7;
const kRoundSides = 28;
const kGhostOpacity = 0.4;
const kOfVehicle = 1;  // in the stencil

function meshGeometry(mesh) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(floatsOf(mesh.vertices), 3));
  geometry.setIndex(new BufferAttribute(wordsOf(mesh.triangles), 1));
  // Every triangle its own corners: edges stay sharp.
  const sharp = geometry.toNonIndexed();
  sharp.computeVertexNormals();
  return sharp;
}

// Along z, where three.js has it along y.
const upright = (geometry) => geometry.rotateX(Math.PI / 2);

function shapeGeometry({kind, size: [a, b, c], mesh}, meshes) {
  switch (kind) {
    case "box": return new BoxGeometry(2 * a, 2 * b, 2 * c);
    case "ellipsoid": return new SphereGeometry(1, kRoundSides, kRoundSides / 2).scale(a, b, c);
    case "capsule": return upright(new CapsuleGeometry(a, 2 * b, 8, kRoundSides));
    case "cylinder": return upright(new CylinderGeometry(a, a, 2 * b, kRoundSides));
    default: return meshes[mesh];
  }
}

function setPlace(object, place, at = 0) {
  object.position.fromArray(place, at);
  object.quaternion.fromArray(place, at + 3).normalize();
}

const turned = (angle) => new Quaternion().setFromEuler(new Euler(0, 0, angle));

function planarMatrix([x, y, heading]) {
  return new Matrix4().compose(new Vector3(x, y, 0), turned(Number.isFinite(heading) ? heading : 0),
                               new Vector3(1, 1, 1));
}

// A pose on the way from one to another one, turned the shorter way round.
function between(from, to, share) {
  const mix = (a, b) => Number.isFinite(b) ? a + share * (b - a) : a;
  const turn = Math.atan2(Math.sin(to[2] - from[2]), Math.cos(to[2] - from[2]));
  return [mix(from[0], to[0]), mix(from[1], to[1]), Number.isFinite(turn) ? from[2] + share * turn : from[2]];
}

export class Vehicle {
  constructor(data, map, colours) {
    this.data = data;
    this.map = map;
    this.times = floatsOf(data.times);
    this.places = floatsOf(data.places);
    this.meshes = data.meshes.map(meshGeometry);
    this.group = new Group();
    this.parts = this.addParts(this.material);
    // Only where the vehicle is not, and once: otherwise it would dye the vehicle and itself.
    const ghost = new MeshLambertMaterial({
      color: colours.of("var(--c0)"), transparent: true, opacity: kGhostOpacity, stencilWrite: true,
      stencilFunc: EqualStencilFunc, stencilRef: 0, stencilZPass: IncrementStencilOp});
    this.ghostParts = this.addParts(() => ghost);
    [this.body, this.ghost] = [this.parts, this.ghostParts].map((parts) => {
      const whole = new Group();
      whole.matrixAutoUpdate = false;
      whole.add(...parts);
      // Whether it is shown is the reader's choice for the group, and the data's for the whole.
      const chosen = new Group();
      chosen.add(whole);
      this.group.add(chosen);
      return chosen;
    });
    this.addStill();
  }

  material({rgba: [r, g, b, a]}) {
    const material = new MeshLambertMaterial({transparent: a < 1, opacity: a, stencilWrite: true,
                                              stencilRef: kOfVehicle, stencilZPass: ReplaceStencilOp});
    material.color.setRGB(r, g, b, SRGBColorSpace);
    return material;
  }

  addShape(shape, material, parent, shadow) {
    const mesh = new Mesh(shapeGeometry(shape, this.meshes), material);
    setPlace(mesh, shape.place);
    mesh.castShadow = shadow;
    parent.add(mesh);
  }

  addParts(materialOf) {
    return Array.from({length: this.data.parts}, (_, part) => {
      const group = new Group();
      for (const shape of this.data.shapes.filter((shape) => shape.part === part)) {
        const material = materialOf(shape);
        this.addShape(shape, material, group, !material.transparent);
      }
      return group;
    });
  }

  addStill() {
    for (const shape of this.data.shapes.filter((shape) => shape.part < 0)) {
      this.addShape(shape, this.material(shape), this.group, false);
    }
  }

  // The samples about a time, and the share of the way from one to the other.
  sampleAt(time) {
    const {times} = this;
    let low = 0;
    let high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= time) low = middle; else high = middle;
    }
    const span = times[high] - times[low];
    return [low, high, span > 0 ? Math.min(Math.max((time - times[low]) / span, 0), 1) : 0];
  }

  put(parts, time) {
    const size = kPlaceSize * parts.length;
    if (this.times.length === 0) {
      parts.forEach((part, i) => setPlace(part, this.places, kPlaceSize * i));
      return;
    }
    const [low, high, share] = this.sampleAt(time);
    const next = new Group();
    parts.forEach((part, i) => {
      setPlace(part, this.places, low * size + kPlaceSize * i);
      setPlace(next, this.places, high * size + kPlaceSize * i);
      part.position.lerp(next.position, share);
      part.quaternion.slerp(next.quaternion, share);
    });
  }

  show({period, share, time}) {
    this.put(this.parts, time);
    this.put(this.ghostParts, time);
    const [whole] = this.body.children;
    const [ghost] = this.ghost.children;
    ghost.visible = false;
    this.pose = null;
    if (!this.map) return;
    const {poses, predicted} = this.map;
    const from = poses.subarray(3 * period, 3 * period + 3);
    this.pose = between(from, poses.subarray(3 * period + 3, 3 * period + 6), share);
    const model = predicted.subarray(3 * period, 3 * period + 3);
    const foreseen = planarMatrix(between(from, model, share));
    if (this.times.length === 0) {
      whole.matrix.copy(planarMatrix(this.pose));
      ghost.matrix.copy(foreseen);
    } else {
      ghost.matrix.copy(foreseen.multiply(planarMatrix(this.pose).invert()));
    }
    whole.matrixWorldNeedsUpdate = true;
    ghost.matrixWorldNeedsUpdate = true;
    ghost.visible = Number.isFinite(model[0] + model[1]);
  }

  box() {
    this.body.updateMatrixWorld(true);
    return new Box3().setFromObject(this.body);
  }

  // m, the longest side of the box about all that moves.
  size() {
    const {x, y, z} = this.box().getSize(new Vector3());
    return Math.max(x, y, z, 1e-3);
  }

  height() { return Math.max(this.box().max.z, 0); }
  centre() { return this.box().getCenter(new Vector3()); }
  heading() { return Number.isFinite(this.pose?.[2]) ? this.pose[2] : null; }

  // The box about the way of all that moves, and about what stands still.
  extent() {
    const box = new Box3().setFromObject(this.group);
    const half = 0.5 * this.size();
    for (let i = 0; i < this.places.length && this.times.length > 0; i += kPlaceSize) {
      const at = new Vector3().fromArray(this.places, i);
      box.expandByPoint(at.clone().addScalar(half)).expandByPoint(at.addScalar(-half));
    }
    return box;
  }
}
