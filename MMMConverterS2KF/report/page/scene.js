// SPDX-License-Identifier: MIT
// The three-dimensional picture: floor, measured markers, and a figure for each converter.

const kMarkerSize = 0.038;  // [m]
const kFieldOfView = 32;    // [degrees], vertical, in a picture as wide as high or wider

// A sign of a marker, white, so that it takes any colour.
function makeSign(draw) {
  const canvas = element("canvas", {width: 64, height: 64});
  const pen = canvas.getContext("2d");
  pen.fillStyle = pen.strokeStyle = "#fff";
  draw(pen);
  return new THREE.CanvasTexture(canvas);
}

function makeSigns() {
  const circle = (pen, radius) => {
    pen.beginPath();
    pen.arc(32, 32, radius, 0, 2 * Math.PI);
  };
  return {
    disc: makeSign((pen) => { circle(pen, 26); pen.fill(); }),
    ring: makeSign((pen) => { pen.lineWidth = 11; circle(pen, 24); pen.stroke(); }),
    cross: makeSign((pen) => {
      pen.lineWidth = 13;
      pen.moveTo(10, 10); pen.lineTo(54, 54); pen.moveTo(54, 10); pen.lineTo(10, 54);
      pen.stroke();
    }),
  };
}

// Up to `capacity` points or line ends whose places change from frame to frame.
class Cloud {
  // size: of a point [m].
  constructor(capacity, made, size) {
    this.size = size;
    this.places = new THREE.BufferAttribute(new Float32Array(3 * capacity), 3);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", this.places);
    this.object = made(geometry);
    this.object.frustumCulled = false;
    this.clear();
  }

  static signs(capacity, sign, size) {
    return new Cloud(capacity, (geometry) => new THREE.Points(geometry, new THREE.PointsMaterial(
      {map: sign, size, alphaTest: 0.35, transparent: true})), size);
  }

  static lines(capacity) {
    return new Cloud(2 * capacity,
      (geometry) => new THREE.LineSegments(geometry, new THREE.LineBasicMaterial()));
  }

  clear() {
    this.count = 0;
  }

  add(position) {
    position.toArray(this.places.array, 3 * this.count++);
  }

  finish() {
    this.object.geometry.setDrawRange(0, this.count);
    this.places.needsUpdate = true;
  }

  setColour(colour) {
    this.object.material.color.set(colour);
  }

  // three.js takes points to be seen at 90 degrees, in a picture that fills the canvas.
  setScale(scale) {
    this.object.material.size = scale * this.size;
  }
}

// What one converter says: body, model markers, residual lines. A track may have a body of its own ({model, markers}),
// a place of it ({position, yaw, scale}), and feet that stand at times (stands(side, frame)).
class Figure {
  constructor(track, signs) {
    this.track = track;
    const trial = track.trial;
    this.body = track.body ? new Body(track.body.model, track.body.markers, null)
      : new Body(trial.model, trial.markers, trial.seenMarkers);
    this.crosses = Cloud.signs(trial.labels.length, signs.cross, 0.8 * kMarkerSize);
    this.lines = Cloud.lines(trial.labels.length);
    this.group = new THREE.Group();
    this.group.add(this.body.root, this.crosses.object, this.lines.object);
    if (!track.place) return;
    this.group.position.fromArray(track.place.position);
    this.group.rotation.z = track.place.yaw;
    this.group.scale.setScalar(track.place.scale);
    this.group.updateMatrixWorld();
  }

  setFrame(k, measured) {
    const trial = this.track.trial;
    this.body.setPose(this.track.motion, trial.frames, k);
    if (this.track.stands) this.body.setStanding((side) => this.track.stands(side, k));
    this.crosses.clear();
    this.lines.clear();
    const place = new THREE.Vector3();
    for (let label = 0; label < trial.labels.length; ++label) {
      this.crosses.add(this.body.markerPosition(label, place));
      if (!trial.isMeasured(label, k)) continue;
      this.lines.add(place);
      this.lines.add(measured(label, k, place));
    }
    this.crosses.finish();
    this.lines.finish();
  }

  setLook(options, overlaid) {
    const colour = converterColour(this.track.contender);
    this.body.setLook(colour, overlaid ? 0.6 : 0.85, options.body);
    this.crosses.setColour(colour);
    this.lines.setColour(colour);
    this.lines.object.visible = options.residuals;
  }
}

function hasWebGl() {
  try {
    const canvas = document.createElement("canvas");
    return Boolean(canvas.getContext("webgl2") || canvas.getContext("webgl"));
  } catch (error) {
    return false;
  }
}

class Scene {
  constructor(canvas, onCameraMoved) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({canvas, alpha: true, antialias: true});
    this.renderer.setClearColor(0, 0);
    this.renderer.autoClear = false;
    this.renderer.setScissorTest(true);
    this.camera = new THREE.PerspectiveCamera(kFieldOfView, 1, 0.05, 100);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableKeys = false;
    this.controls.addEventListener("change", onCameraMoved);
    this.scene = new THREE.Scene();
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8a8f98, 0.85));
    const sun = new THREE.DirectionalLight(0xffffff, 0.4);
    sun.position.set(2, -1, 4);
    this.scene.add(sun);
    this.signs = makeSigns();
    this.options = {body: true, residuals: true, truth: false, beside: true, forces: true};
    this.measured = (label, k, target) =>
      target.fromArray(this.trial.positions, 3 * (k * this.trial.labels.length + label));
  }

  show(trial) {
    if (this.content) this.scene.remove(this.content);
    this.trial = trial;
    this.content = new THREE.Group();
    this.seen = Cloud.signs(trial.labels.length, this.signs.disc, kMarkerSize);
    this.unseen = Cloud.signs(trial.labels.length, this.signs.ring, kMarkerSize);
    this.figures = trial.tracks.map((track) =>
      (track.makeFigure ? track.makeFigure(this.signs) : new Figure(track, this.signs)));
    this.truth = trial.truth ? new Body(trial.model, [], null) : null;
    this.frameBodies();
    this.content.add(this.seen.object, this.unseen.object, ...this.figures.map((one) => one.group));
    if (this.truth) this.content.add(this.truth.root);
    this.ground = trial.ground ? new GroundFigure(trial.ground) : null;
    if (this.ground) this.content.add(this.ground.group);
    this.addFloor();
    this.scene.add(this.content);
    this.setLook();
  }

  // Of a recording the camera follows the body, also where few of its limbs have markers or a marker is far away: that
  // of the converter that is nearest to the markers.
  frameBodies() {
    const {trial} = this;
    if (trial.frames < 2 || trial.framing || this.figures[0].body.nodes.length < 2) return;
    const distance = (figure) => (figure.track.mean || []).reduce((sum, value) => sum + (value || 0), 0);
    const nearest = this.figures.reduce((best, one) => (distance(one) < distance(best) ? one : best));
    const step = Math.max(1, trial.frames / 200);
    const bounds = [];
    for (let at = 0; Math.round(at) < trial.frames; at += step) {
      nearest.body.setPose(nearest.track.motion, trial.frames, Math.round(at));
      const {min, max} = nearest.body.bounds;
      bounds.push([min.toArray(), max.toArray()]);
    }
    if (bounds.flat(2).every(Number.isFinite)) trial.framing = new Framing(step, bounds);
  }

  addFloor() {
    const middle = this.trial.middle(0);
    this.floor = new THREE.GridHelper(12, 24);
    this.floor.material.transparent = true;
    this.floor.material.depthWrite = false;
    this.floor.rotation.x = Math.PI / 2;
    this.floor.position.set(Math.round(middle[0]), Math.round(middle[1]), 0);
    this.content.add(this.floor);
  }

  // Colours and visibilities as they are asked for now.
  setLook() {
    const ink = themeColour("text");
    this.seen.setColour(ink);
    this.unseen.setColour(themeColour("muted"));
    const line = new THREE.Color(themeColour("floor"));
    this.floor.geometry.getAttribute("color").array.set(
      Array.from({length: 4 * 25}, () => line.toArray()).flat());
    this.floor.geometry.getAttribute("color").needsUpdate = true;
    const shown = this.figures.filter((one) => one.group.visible).length;
    for (const one of this.figures) one.setLook(this.options, shown > 1 && !this.options.beside);
    if (this.ground) this.ground.setLook(this.options.forces);
    if (this.truth) {
      this.truth.setLook(themeColour("muted"), 0.5, true);
      this.truth.root.visible = this.options.truth;
    }
  }

  setShown(isShown) {
    for (const one of this.figures) one.group.visible = isShown(one.track.contender);
    this.setLook();
  }

  setFrame(k) {
    this.seen.clear();
    this.unseen.clear();
    const place = new THREE.Vector3();
    for (let label = 0; label < this.trial.labels.length; ++label) {
      if (!this.trial.isMeasured(label, k)) continue;
      (this.trial.isHidden(label, k) ? this.unseen : this.seen).add(this.measured(label, k, place));
    }
    this.seen.finish();
    this.unseen.finish();
    for (const one of this.figures) one.setFrame(k, this.measured);
    if (this.truth) this.truth.setPose(this.trial.truth, this.trial.frames, k);
    if (this.ground) this.ground.setFrame(k);
  }

  // Looks at `middle` from the front right, a little from above, so that a body fits: `size` is that
  // of its joints, beyond which head and feet reach, and what is near looks larger.
  placeCamera(camera, middle, size) {
    const distance = 0.68 * size / Math.tan(kFieldOfView / 2 * Math.PI / 180);
    camera.position.set(middle[0] + 0.80 * distance, middle[1] + 0.55 * distance,
      middle[2] + 0.22 * distance);
    camera.lookAt(...middle);
  }

  resetCamera(middle) {
    this.placeCamera(this.camera, middle, this.trial.size);
    this.controls.target.set(...middle);
    this.controls.update();
  }

  // How far down and up the bodies shown reach in the picture: -1 and 1 are its edges.
  get reach() {
    const box = new THREE.Box3();
    for (const one of this.figures.filter((figure) => figure.group.visible)) box.expandByObject(one.body.root);
    this.camera.updateMatrixWorld();
    const heights = [box.min, box.max].flatMap(({z}) => [box.min, box.max].flatMap(({x}) =>
      [box.min, box.max].map(({y}) => new THREE.Vector3(x, y, z).project(this.camera).y)));
    return [Math.min(...heights), Math.max(...heights)];
  }

  moveCamera(way) {
    const step = new THREE.Vector3(...way);
    this.camera.position.add(step);
    this.controls.target.add(step);
    this.controls.update();
  }

  // The pictures side by side: which figures are in each, left to right, top to bottom.
  get pictures() {
    const shown = this.figures.filter((one) => one.group.visible);
    return this.options.beside && shown.length > 1 ? shown.map((one) => [one]) : [shown];
  }

  // Columns such that the pictures, as wide as high, are as large as they can be.
  get columns() {
    const count = this.pictures.length;
    const side = (columns) => Math.min(this.canvas.clientWidth / columns,
      this.canvas.clientHeight / Math.ceil(count / columns));
    let best = 1;
    for (let columns = 2; columns <= count; ++columns) {
      if (side(columns) > side(best)) best = columns;
    }
    return best;
  }

  draw() {
    const width = this.canvas.clientWidth;
    const height = this.canvas.clientHeight;
    const ratio = Math.min(window.devicePixelRatio, 2);
    const size = this.renderer.getSize(new THREE.Vector2());
    if (size.x !== width || size.y !== height || this.renderer.getPixelRatio() !== ratio) {
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
    }
    const pictures = this.pictures;
    const columns = this.columns;
    const rows = Math.ceil(pictures.length / columns);
    this.renderer.setScissor(0, 0, width, height);
    this.renderer.clear();
    pictures.forEach((figures, i) => {
      const x = i % columns;
      const y = rows - 1 - Math.floor(i / columns);
      this.drawPart(this.camera, figures, [x * width / columns, y * height / rows, width / columns,
        height / rows]);
    });
  }

  drawPart(camera, figures, [x, y, width, height]) {
    const visible = this.figures.map((one) => one.group.visible);
    for (const one of this.figures) one.group.visible = figures.includes(one);
    camera.aspect = width / height;
    const tangent = Math.tan(kFieldOfView / 2 * Math.PI / 180) / Math.min(1, camera.aspect);
    camera.fov = 2 * Math.atan(tangent) * 180 / Math.PI;
    camera.updateProjectionMatrix();
    for (const cloud of [this.seen, this.unseen, ...this.figures.map((one) => one.crosses)]) {
      cloud.setScale(height / this.canvas.clientHeight / tangent);
    }
    this.renderer.setViewport(x, y, width, height);
    this.renderer.setScissor(x, y, width, height);
    this.renderer.render(this.scene, camera);
    this.figures.forEach((one, i) => { one.group.visible = visible[i]; });
  }
}
