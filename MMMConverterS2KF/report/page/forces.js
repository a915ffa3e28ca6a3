// SPDX-License-Identifier: MIT
// What force plates measured: their outlines, and the ground's force on the person as an arrow.

const kSideColours = {left: "#c8553d", right: "#2a7f9e"};
const kSingleSamples = 51;  // of a stride over the cycle
const kNewtonAMetre = 1000;  // of arrows, where nobody knows the person's weight

// Single strides of each cycle, as lists.
function withSingles(gait) {
  for (const cycle of gait.cycles) {
    if (!cycle.singles) continue;
    const all = Array.from(unpack(cycle.singles));
    cycle.singles = Array.from({length: all.length / kSingleSamples}, (_, i) => all.slice(i * kSingleSamples, (i + 1) * kSingleSamples));
  }
  return gait;
}

// The ground of a trial. Arrows are a metre long for a body weight.
class Ground {
  constructor(json, trial) {
    this.trial = trial;
    this.mass = json.mass_kg || null;
    this.weight = json.body_weight_n || null;
    this.notes = json.notes;
    this.gait = json.gait ? withSingles(json.gait) : null;
    this.plates = json.plates.map((one) => {
      const plate = {number: one.number, corners: one.corners, loads: one.loads};
      lazily(plate, "force", one.force);
      lazily(plate, "pressure", one.pressure);
      return plate;
    });
  }

  // Plates that bear somebody in a frame: {plate, foot, force, pressure}, [N] and [m].
  loadsAt(frame) {
    const time = this.trial.time(frame);
    return this.plates.flatMap((plate) => {
      const [force, pressure] = [plate.force, plate.pressure]
        .map((numbers) => Array.from(numbers.subarray(3 * frame, 3 * frame + 3)));
      if ([...force, ...pressure].some(Number.isNaN)) return [];
      const load = plate.loads.find((one) => one.begin_s <= time && time <= one.end_s);
      return [{plate, foot: load ? load.foot : "unknown", isPart: Boolean(load && load.part_of_foot), force, pressure}];
    });
  }

  // Sentences of what there is to know of the forces.
  get noteText() {
    return this.notes.map((note) => `${note.slice(0, 1).toUpperCase()}${note.slice(1)}.`).join(" ");
  }

  get scale() {
    return this.weight ? "a body weight" : "1000 N";
  }

  describe(frame) {
    return this.loadsAt(frame).map(({plate, foot, isPart, force}) => {
      const share = this.weight ? ` (${formatNumber(force[2] / this.weight, 2)} body weights)` : "";
      const feet = {left: ", left foot", right: ", right foot", both: ", both feet"}[foot] || "";
      const part = isPart ? ", partly beside the plate" : "";
      return `plate ${plate.number}${feet}${part}: ${formatNumber(force[2], 0)} N${share}`;
    }).join(" · ");
  }
}

function footColour(foot) {
  return kSideColours[foot] || themeColour("text");
}

// An arrow that points along +y and is a metre long: a shaft that may be stretched, and a head.
class Arrow {
  constructor() {
    this.material = new THREE.MeshBasicMaterial({transparent: true, opacity: 0.9});
    this.shaft = new THREE.Mesh(new THREE.CylinderBufferGeometry(0.009, 0.009, 1, 12), this.material);
    this.head = new THREE.Mesh(new THREE.CylinderBufferGeometry(0, 0.028, 0.09, 16), this.material);
    this.foot = new THREE.Mesh(new THREE.SphereBufferGeometry(0.018, 12, 8), this.material);
    this.object = new THREE.Group();
    this.object.add(this.shaft, this.head, this.foot);
  }

  point(from, way, colour) {
    const length = way.length();
    this.material.color.set(colour);
    this.shaft.scale.set(1, Math.max(length - 0.09, 1e-3), 1);
    this.shaft.position.set(0, Math.max(length - 0.09, 0) / 2, 0);
    this.head.position.set(0, length - 0.045, 0);
    this.object.position.copy(from);
    this.object.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), way.clone().normalize());
    this.top = from.z + way.z;
  }

  said(isShown) {
    const {visible, position} = this.object;
    return {visible, shown: visible && isShown, position: position.toArray(), top: this.top};
  }
}

// Plates and arrows in the scene.
class GroundFigure {
  constructor(ground) {
    this.ground = ground;
    this.group = new THREE.Group();
    this.outlines = new THREE.LineBasicMaterial();
    this.faces = new THREE.MeshBasicMaterial({transparent: true, opacity: 0.18, side: THREE.DoubleSide, depthWrite: false});
    this.arrows = ground.plates.map(() => new Arrow());
    for (const {corners} of ground.plates) {
      if (!corners) continue;
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(corners), 3));
      this.group.add(new THREE.LineLoop(geometry, this.outlines));
      const face = geometry.clone();
      face.setIndex([0, 1, 2, 0, 2, 3]);
      this.group.add(new THREE.Mesh(face, this.faces));
    }
    this.group.add(...this.arrows.map((arrow) => arrow.object));
  }

  setFrame(frame) {
    for (const arrow of this.arrows) arrow.object.visible = false;
    const way = new THREE.Vector3();
    for (const {plate, foot, force, pressure} of this.ground.loadsAt(frame)) {
      const arrow = this.arrows[this.ground.plates.indexOf(plate)];
      way.fromArray(force).divideScalar(this.ground.weight || kNewtonAMetre);
      if (way.length() < 1e-3) continue;
      arrow.object.visible = true;
      arrow.point(new THREE.Vector3().fromArray(pressure), way, footColour(foot));
    }
  }

  setLook(isVisible) {
    this.group.visible = isVisible;
    this.outlines.color.set(themeColour("muted"));
    this.faces.color.set(themeColour("accent"));
  }
}

// What is said of the ground below the player.
function showGround(ground) {
  const hasPlates = Boolean(ground) && ground.plates.length > 0;
  byId("forces-option").hidden = byId("left-force-legend").hidden = byId("right-force-legend").hidden = !hasPlates;
  const hasNotes = Boolean(ground) && ground.notes.length > 0;
  byId("forces-caption").hidden = !hasPlates && !hasNotes;
  if (!ground) return;
  const said = hasPlates ? ["Arrows are the forces of the ground on the person, from the centre of pressure on the " +
    `force plate; 1 m is ${ground.weight ? `a body weight, ${formatNumber(ground.weight, 0)} N ` +
      `(${formatNumber(ground.mass, 1)} kg)` : ground.scale}. Who stands on the plate is told by the foot that is ` +
    "nearest to it: red the left, blue the right, else both or none."] : [];
  byId("forces-caption").textContent = [...said, ground.noteText].join(" ");
}
