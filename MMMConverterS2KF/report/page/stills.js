// SPDX-License-Identifier: MIT
// A strip of small pictures of selected frames, as vectors: they need no WebGL and stand on paper.

const kNumStills = 6;
const kNear = 0.35;  // of the way from one to the next
const kLooks = 40;   // at frames near each
const kTravels = 1;  // [m] who goes further in a recording is seen from the side
const kSideTurn = 25 * Math.PI / 180;  // towards the front, so that both legs are seen
const kCameraLow = 8 * Math.PI / 180;

// How far one posture is from another: joint angles, and the root's turn.
function postureDistance(motion, frames, a, b) {
  let sum = 0;
  for (let column = 0; column < motion.joints.length; ++column) {
    sum += (motion.angles[column * frames + a] - motion.angles[column * frames + b]) ** 2;
  }
  let cosine = 0;
  for (let i = 0; i < 4; ++i) cosine += motion.orientation[4 * a + i] * motion.orientation[4 * b + i];
  return Math.sqrt(sum + 4 * Math.acos(Math.min(1, Math.abs(cosine))) ** 2);
}

// Frames between which the posture changes by much the same; half of it even in time, so that a
// calm part is not left out. Of those near each, the one least like the others: strides repeat.
function selectFrames(trial, motion) {
  const last = trial.frames - 1;
  const steps = new Float64Array(trial.frames);
  for (let k = 1; k <= last; ++k) steps[k] = postureDistance(motion, trial.frames, k, k - 1);
  const total = steps.reduce((sum, step) => sum + step, 0);
  const near = Array.from({length: kNumStills}, () => []);
  let way = 0;
  for (let k = 1; k <= last; ++k) {
    way += ((total > 0 ? 0.5 * steps[k] / total : 0.5 / last) + 0.5 / last) * (kNumStills - 1);
    if (Math.abs(way - Math.round(way)) < kNear) near[Math.round(way)].push(k);
  }
  const frames = [0];
  for (const candidates of near.slice(1)) {
    let best = -1, most = -1;
    const stride = 1 + Math.floor(candidates.length / kLooks);
    for (let i = 0; i < candidates.length; i += stride) {
      const least = Math.min(...frames.map((frame) => postureDistance(motion, trial.frames, candidates[i], frame)));
      if (least > most) [best, most] = [candidates[i], least];
    }
    if (best >= 0) frames.push(best);
  }
  return frames;
}

// The side of a segment of MMM's and of OpenSim's models of persons.
function sideOfSegment(name) {
  if (/^(L[A-Z]|Left)|_l$/.test(name)) return "left";
  return /^(R[A-Z]|Right)|_r$/.test(name) ? "right" : null;
}

// Where a picture looks: unit vectors to its right, up, and to who sees it.
function makeGaze(motion, frames) {
  const place = (k) => Array.from(motion.position.subarray(3 * k, 3 * k + 2));
  const [from, to] = [place(0), place(frames - 1)];
  const way = [to[0] - from[0], to[1] - from[1]];
  const length = Math.hypot(...way);
  // Seen from the right side of who walks, else as the player begins.
  const azimuth = length > kTravels ? Math.atan2(way[1], way[0]) - Math.PI / 2 + kSideTurn : Math.atan2(0.55, 0.8);
  const towards = [Math.cos(azimuth) * Math.cos(kCameraLow), Math.sin(azimuth) * Math.cos(kCameraLow), Math.sin(kCameraLow)];
  const right = [-Math.sin(azimuth), Math.cos(azimuth), 0];
  const up = [towards[1] * right[2] - towards[2] * right[1], towards[2] * right[0] - towards[0] * right[2],
    towards[0] * right[1] - towards[1] * right[0]];
  return {right, up, towards};
}

const along = (place, axis) => place[0] * axis[0] + place[1] * axis[1] + place[2] * axis[2];

class Stills {
  constructor(view) {
    this.view = view;
  }

  show(trial) {
    this.frames = selectFrames(trial, trial.truth || trial.tracks[0].motion);
    this.bodies = trial.tracks.map((track) => ({track, body: new Body(trial.model, trial.markers, trial.seenMarkers)}));
    this.gaze = makeGaze(trial.tracks[0].motion, trial.frames);
    this.buttons = this.frames.map((frame) => {
      const time = `${formatNumber(trial.time(frame), 2)} s`;
      const button = element("button", {type: "button", class: "still", "aria-label": `Go to ${time}, frame ${trial.recorded(frame)}`},
        element("div", {class: "still-picture"}), element("span", {}, time));
      button.addEventListener("click", () => {
        this.view.seek(frame);
        byId("player").scrollIntoView({block: "nearest"});
      });
      return button;
    });
    replaceContent(byId("stills"), ...this.buttons);
  }

  // Strokes of a frame's bodies: ends and width [m], colour, and how near.
  strokesAt(frame) {
    const {trial} = this.view;
    const strokes = [];
    for (const {track, body} of this.bodies.filter(({track: one}) => this.view.shown.has(one.contender))) {
      body.setPose(track.motion, trial.frames, frame);
      const own = `var(--converter-${track.contender % kNumConverterColours})`;
      for (const {from, to, width, segment, isPale} of body.strokes()) {
        const side = this.bodies.length === 1 ? kSideColours[sideOfSegment(trial.model.segments[segment].name)] : own;
        strokes.push({from, to, width, colour: side || (this.bodies.length === 1 ? "var(--limb)" : own), isPale,
          near: along(from, this.gaze.towards) + along(to, this.gaze.towards)});
      }
    }
    for (const {foot, force, pressure} of trial.ground && trial.ground.weight ? trial.ground.loadsAt(frame) : []) {
      strokes.push({from: pressure, to: pressure.map((value, axis) => value + force[axis] / trial.ground.weight), width: 0.012,
        colour: kSideColours[foot] || "var(--text)", isForce: true, near: Infinity});
    }
    return strokes.sort((a, b) => a.near - b.near);
  }

  refresh() {
    const {right, up} = this.gaze;
    const strokes = this.frames.map((frame) => this.strokesAt(frame));
    const flat = (place) => [along(place, right), -along(place, up)];
    // The body of each frame, and the largest of them.
    const boxes = strokes.map((of) => {
      const places = of.filter((one) => !one.isForce).flatMap(({from, to}) => [flat(from), flat(to)]);
      return [0, 1].map((axis) => places.reduce(([least, most], place) =>
        [Math.min(least, place[axis]), Math.max(most, place[axis])], [Infinity, -Infinity]));
    });
    const largest = (axis) => Math.max(0.5, ...boxes.map((box) => box[axis][1] - box[axis][0]).filter(Number.isFinite));
    const size = 1.1 * Math.max(largest(0), largest(1));
    const wide = Math.min(100, Math.max(55, 110 * largest(0) / size));
    this.buttons.forEach((button, i) => {
      const middle = boxes[i].map(([least, most]) => (Number.isFinite(least) ? (least + most) / 2 : 0));
      const scaled = (place) => flat(place).map((value, axis) => (100 * ((value - middle[axis]) / size + 0.5)).toFixed(1));
      const lines = strokes[i].map(({from, to, width, colour, isPale}) => {
        const [[x1, y1], [x2, y2]] = [scaled(from), scaled(to)];
        return drawn("line", {x1, y1, x2, y2, "stroke-linecap": "round"},
          `stroke:${colour};stroke-width:${(100 * width / size).toFixed(2)};stroke-opacity:${isPale ? 0.3 : 1}`);
      });
      replaceContent(button.firstChild, svgElement("svg", {viewBox: `${50 - wide / 2} 0 ${wide} 100`, "aria-hidden": "true"}, ...lines));
    });
  }

  setFrame(frame) {
    let nearest = 0;
    this.frames.forEach((other, i) => {
      if (other <= frame) nearest = i;
    });
    this.buttons.forEach((button, i) => button.classList.toggle("current", i === nearest));
  }
}
