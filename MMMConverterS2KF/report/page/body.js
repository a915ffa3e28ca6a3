// SPDX-License-Identifier: MIT
// A body in three.js' scene graph: an Object3D for each segment of the model, bones and markers as
// its children, so that a posture is the root's pose and an angle for each joint.

const kShortestBone = 0.012;  // [m]
const kShortestStroke = 0.04;  // [m], so that fingers are none
const kLargestHead = 0.14;  // [m], of markers around it from their middle

// A spindle along +y from 0 to 1.
function makeBoneGeometry() {
  const outline = [[0, 0], [0.75, 0.06], [1, 0.18], [0.7, 0.75], [0.45, 0.94], [0, 1]];
  return new THREE.LatheBufferGeometry(outline.map(([x, y]) => new THREE.Vector2(x, y)), 10);
}

// What a segment turns or shifts by where its joint has this angle: stages of polynomials, piece by
// piece, lowest power first; undefined: the angle itself.
function valueOf(stages, angle) {
  return (stages || []).reduce((x, {breaks, origins, order, coefficients}) => {
    let piece = breaks.findIndex((end) => x < end);
    if (piece < 0) piece = breaks.length;
    let value = 0;
    for (let power = order - 1; power >= 0; --power) {
      value = value * (x - origins[piece]) + coefficients[piece * order + power];
    }
    return value;
  }, angle);
}

// Segments whose place some marker tells: those with a marker, and what carries them. markers: indices.
function segmentsWithMarkers(model, markers) {
  const known = new Set();
  for (const index of markers) {
    for (let i = model.markers[index].segment; i >= 0 && !known.has(i); i = model.segments[i].parent) known.add(i);
  }
  return known;
}

// Of limbs and feet, where a model says which segments these are (`parts`).
const kPartColours = {"left leg": "#c8553d", "left foot": "#c8553d", "left arm": "#de9672",
  "right leg": "#2a7f9e", "right foot": "#2a7f9e", "right arm": "#6fb1c8"};

class Body {
  // markers: which model marker belongs to which label, as trial.markers. measured: those of them that are seen at
  // all; bones that none of them moves are drawn pale. Null: nothing is.
  constructor(model, markers, measured) {
    this.model = model;
    this.material = new THREE.MeshLambertMaterial({transparent: true});
    this.pale = new THREE.MeshLambertMaterial({transparent: true, depthWrite: false});
    this.known = measured ? segmentsWithMarkers(model, measured) : null;
    this.shell = new THREE.MeshLambertMaterial({transparent: true, depthWrite: false});
    this.parts = new Map();  // materials
    this.nodes = [];
    this.bones = [];
    this.root = new THREE.Group();
    this.addSegments(model.segments);
    this.markers = markers.map((index) => {
      const marker = model.markers[index];
      const node = new THREE.Object3D();
      node.position.fromArray(marker.position);
      this.nodes[marker.segment].add(node);
      return node;
    });
    this.addEnds(model, markers);
    for (const {segment, position} of model.ends || []) {
      this.addBone(this.nodes[segment], new THREE.Vector3().fromArray(position), Body.bone, this.materialOf(segment));
    }
    for (const shape of model.shapes || []) this.addShape(shape);
  }

  addSegments(segments) {
    const geometry = Body.bone = Body.bone || makeBoneGeometry();
    const joints = new THREE.SphereBufferGeometry(1, 12, 8);
    segments.forEach((segment, i) => {
      const node = i === 0 ? this.root : new THREE.Object3D();
      this.nodes.push(node);
      this.moveJoint(i, segment.rest || 0);
      if (i === 0) return;
      const parent = this.nodes[segment.parent];
      parent.add(node);
      this.addBone(parent, node.position, geometry, this.materialOf(segment.parent));
      if (segment.joint >= 0) this.addKnob(node, joints, this.materialOf(i));
    });
  }

  materialOf(segment) {
    const part = this.model.parts ? this.model.parts[segment] : "";
    if (part && !this.parts.has(part)) this.parts.set(part, new THREE.MeshLambertMaterial({transparent: true}));
    if (part) return this.parts.get(part);
    return !this.known || this.known.has(segment) ? this.material : this.pale;
  }

  // Whether a limb, not only fingers, is drawn as not measured.
  get hasPaleLimb() {
    return this.bones.some((bone) => bone.material === this.pale && bone.geometry === Body.bone && bone.scale.y > 0.15);
  }

  addBone(parent, tip, geometry, material) {
    const length = tip.length();
    if (length < kShortestBone) return;
    const bone = new THREE.Mesh(geometry, material);
    const width = Math.min(0.11 * length, 0.03);
    bone.scale.set(width, length, width);
    bone.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), tip.clone().normalize());
    bone.userData = {tip: tip.clone(), segment: this.nodes.indexOf(parent)};
    parent.add(bone);
    this.bones.push(bone);
  }

  addKnob(node, geometry, material) {
    const knob = new THREE.Mesh(geometry, material);
    knob.scale.setScalar(node.position.length() < 0.06 ? 0.008 : 0.018);
    node.add(knob);
    this.bones.push(knob);
  }

  // Segments without a child end in the middle of their markers: toes in a bone, the head, which
  // markers surround, in an ellipsoid.
  addEnds(model, markers) {
    const places = new Map();
    for (const index of markers) {
      const {segment, position} = model.markers[index];
      if (model.segments.some((other) => other.parent === segment)) continue;
      if (!places.has(segment)) places.set(segment, []);
      places.get(segment).push(new THREE.Vector3().fromArray(position));
    }
    for (const [segment, points] of places) {
      const middle = points.reduce((sum, point) => sum.add(point), new THREE.Vector3())
        .divideScalar(points.length);
      const spread = points.reduce((sum, point) => sum + point.distanceTo(middle), 0) / points.length;
      if (points.length < 3 || spread > kLargestHead) {
        this.addBone(this.nodes[segment], middle, Body.bone, this.model.parts ? this.materialOf(segment) : this.material);
      } else {
        this.addBall(this.nodes[segment], middle, spread);
      }
    }
  }

  addBall(node, middle, radius) {
    const ball = new THREE.Mesh(new THREE.SphereBufferGeometry(1, 20, 14), this.material);
    ball.position.copy(middle);
    ball.scale.set(0.72 * radius, 1.15 * radius, 0.85 * radius);
    ball.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), node.position.clone().normalize());
    ball.userData = {tip: middle.clone(), segment: this.nodes.indexOf(node), radius};
    node.add(ball);
    this.bones.push(ball);
  }

  // A shape with which a robot touches; its axis is z.
  addShape({kind, segment, position, orientation, half, radius, half_length: length}) {
    const group = new THREE.Group();
    group.position.fromArray(position);
    group.quaternion.fromArray(orientation);
    this.nodes[segment].add(group);
    const part = this.model.parts ? this.model.parts[segment] : "";
    const material = /foot/.test(part) ? this.materialOf(segment) : this.shell;
    const add = (geometry, place) => {
      const mesh = new THREE.Mesh(geometry, material);
      place(mesh);
      group.add(mesh);
      this.bones.push(mesh);
    };
    const ball = (size, z) => add(new THREE.SphereBufferGeometry(1, 16, 10), (mesh) => {
      mesh.scale.fromArray(size);
      mesh.position.z = z;
    });
    if (kind === "box") add(new THREE.BoxBufferGeometry(...half.map((size) => 2 * size)), () => {});
    if (kind === "sphere") ball([radius, radius, radius], 0);
    if (kind === "ellipsoid") ball(half, 0);
    if (kind === "capsule") for (const z of [-length, length]) ball([radius, radius, radius], z);
    if (kind === "capsule" || kind === "cylinder") {
      add(new THREE.CylinderBufferGeometry(radius, radius, 2 * length, 16), (mesh) => { mesh.rotation.x = Math.PI / 2; });
    }
  }

  // Whether a foot ("left") is on the ground: its colour.
  setStanding(stands) {
    for (const side of ["left", "right"]) {
      const material = this.parts.get(`${side} foot`);
      if (material) material.color.set(stands(side) ? themeColour("best") : kPartColours[`${side} foot`]);
    }
  }

  // angle: of the joint, or the shift of one that slides.
  moveJoint(i, angle) {
    const segment = this.model.segments[i];
    const node = this.nodes[i];
    node.position.fromArray(segment.position);
    node.quaternion.fromArray(segment.orientation);
    if (segment.joint < 0) return;
    const value = valueOf(segment.function, angle);
    const axis = new THREE.Vector3().fromArray(segment.axis);
    if (segment.slides) {
      node.position.addScaledVector(axis.applyQuaternion(node.quaternion), value);
    } else {
      node.quaternion.multiply(new THREE.Quaternion().setFromAxisAngle(axis, value));
    }
  }

  // The posture of frame k.
  setPose(motion, frames, k) {
    this.root.position.fromArray(motion.position, 3 * k);
    this.root.quaternion.fromArray(motion.orientation, 4 * k).normalize();
    this.model.segments.forEach((segment, i) => {
      const column = motion.joints.indexOf(segment.joint);
      if (segment.joint >= 0 && column >= 0) this.moveJoint(i, motion.angles[column * frames + k]);
    });
    this.root.updateMatrixWorld(true);
  }

  // Least and most of all segments, as the posture is set.
  get bounds() {
    const box = new THREE.Box3();
    const place = new THREE.Vector3();
    for (const node of [...this.nodes, ...this.bones]) box.expandByPoint(place.setFromMatrixPosition(node.matrixWorld));
    return box;
  }

  // Bones and head as lines, as the posture is set: ends and width [m].
  strokes() {
    const isDrawn = ({tip}) => tip && tip.length() > kShortestStroke;
    return this.bones.filter((bone) => isDrawn(bone.userData)).map((bone) => {
      const {tip, segment, radius} = bone.userData;
      const to = this.nodes[segment].localToWorld(tip.clone());
      const from = radius ? to : new THREE.Vector3().setFromMatrixPosition(this.nodes[segment].matrixWorld);
      return {from: from.toArray(), to: to.toArray(), segment, isPale: bone.material === this.pale,
        width: radius ? 1.9 * radius : Math.min(0.05, 0.012 + 0.14 * tip.length())};
    });
  }

  markerPosition(label, target) {
    return target.setFromMatrixPosition(this.markers[label].matrixWorld);
  }

  setLook(colour, opacity, showBones) {
    this.material.color.set(colour);
    this.material.opacity = opacity;
    this.pale.color.set(themeColour("muted"));
    this.pale.opacity = 0.28;
    this.shell.color.set(themeColour("muted"));
    this.shell.opacity = 0.2;
    for (const [part, material] of this.parts) {
      material.color.set(kPartColours[part]);
      material.opacity = opacity;
    }
    for (const bone of this.bones) bone.visible = showBones;
  }
}
