// SPDX-License-Identifier: MIT
// What the page was given: parts of a comparison, unpacked when they are first looked at. SI units.

// Postures over time: position (x y z per frame), orientation (x y z w per frame), angles and
// deviations (frames of the first joint, of the second, ...).
class Motion {
  constructor(json) {
    this.joints = json.joints;  // of the model
    for (const name of ["position", "orientation", "angles", "angles_least", "angles_most", "deviations"]) {
      lazily(this, name, json[name]);
    }
    this.anatomy = json.anatomy ? new Anatomy(json.anatomy) : null;
  }
}

// Angles by the names that people have for them, with left and right of one joint together: titles
// ("knee flexion"), and where the numbers of a title are.
class Anatomy {
  constructor(json) {
    this.columns = new Map();
    json.names.forEach((name, column) => {
      const title = `${name.joint} ${name.motion}`;
      if (!this.columns.has(title)) this.columns.set(title, []);
      this.columns.get(title).push({side: name.side, column});
    });
    for (const name of ["values", "deviations"]) lazily(this, name, json[name]);
  }

  // Of each joint its titles.
  get joints() {
    const joints = new Map();
    for (const title of this.columns.keys()) {
      const joint = title.split(" ")[0];
      if (!joints.has(joint)) joints.set(joint, []);
      joints.get(joint).push(title);
    }
    return joints;
  }
}

// One converter on one recording.
class Track {
  constructor(json, contender, trial) {
    this.contender = json.contender;
    this.name = contender.name;
    this.trial = trial;
    this.failure = json.failure;
    this.warnings = json.warnings;
    this.ignored = json.ignored;
    this.absent = json.absent;
    this.incidents = json.incidents || [];
    if (this.failure) return;
    this.motion = new Motion(json.motion);
    this.labelMeans = json.label_means || null;
    for (const name of ["distances", "mean", "p05", "p95", "max", "seconds", "seconds_least", "seconds_most",
      "nis", "nis_least", "nis_most", "nis_low", "nis_high"]) {
      lazily(this, name, json[name]);
    }
  }

  distance(label, frame) {
    return this.distances[label * this.trial.frames + frame];
  }

  // Mean over the markers in a frame of the first run; NaN where none was measured.
  frameMean(frame) {
    let sum = 0;
    let count = 0;
    for (let label = 0; label < this.trial.labels.length; ++label) {
      const distance = this.distance(label, frame);
      if (Number.isNaN(distance)) continue;
      sum += distance;
      ++count;
    }
    return count ? sum / count : NaN;
  }
}

// One recording with the model of its person. Of a long one every n-th frame is drawn: frames are
// counted in these; what is called ..._least or ..._most is over the n frames from a drawn one on.
class Trial {
  constructor(json) {
    this.name = json.name;
    this.failure = json.failure;
    this.frames = json.frames || 0;
    this.labels = json.labels || [];
    this.tracks = [];  // of the converters that have a result
    this.failed = [];  // of the others
    if (!this.frames) return;
    this.every = json.every;  // frames of the recording for one that is drawn
    this.rate = json.rate / this.every;
    this.optimumEvery = json.optimum_every;
    this.firstTime = json.first_time;
    this.markers = json.markers;  // of the model, one for each label
    this.model = json.model;
    this.subject = json.subject || null;  // of the model, where the person is calibrated
    this.truth = json.truth ? new Motion(json.truth) : null;
    this.ground = json.ground ? new Ground(json.ground, this) : null;
    for (const name of ["positions", "hidden", "optimum", "mean_hidden", "most_hidden"]) {
      lazily(this, name, json[name]);
    }
  }

  time(frame) {
    return this.firstTime + frame / this.rate;
  }

  // The frame of the recording.
  recorded(frame) {
    return frame * this.every;
  }

  frameAt(time) {
    const frame = Math.round((time - this.firstTime) * this.rate);
    return Math.min(Math.max(frame, 0), this.frames - 1);
  }

  // Hidden from the converters in the first run.
  isHidden(label, frame) {
    const bit = label * this.frames + frame;
    return (this.hidden[bit >> 3] >> (bit & 7) & 1) === 1;
  }

  isMeasured(label, frame) {
    return !Number.isNaN(this.positions[3 * (frame * this.labels.length + label)]);
  }

  // Markers of the model whose labels are seen in some frame.
  get seenMarkers() {
    return this.markers.filter((_, label) => {
      for (let k = 0; k < this.frames; ++k) if (this.isMeasured(label, k)) return true;
      return false;
    });
  }

  // The first frame that shows at least half of the most labels that a frame shows.
  get firstSeen() {
    const counts = new Uint16Array(this.frames);
    let most = 0;
    for (let k = 0; k < this.frames; ++k) {
      for (let label = 0; label < this.labels.length; ++label) counts[k] += this.isMeasured(label, k);
      most = Math.max(most, counts[k]);
    }
    return counts.findIndex((count) => 2 * count >= most);
  }

  // What a camera looks at, three numbers: the body where it is drawn (Scene.frameBodies), else the middle of the
  // measured markers, smoothed.
  middle(frame) {
    if (this.framing) return this.framing.middle(frame);
    if (!this.middles) this.middles = smoothedMiddles(this);
    return Array.from(this.middles.subarray(3 * frame, 3 * frame + 3));
  }

  // The largest extent of the body, or of the measured markers, of a frame, over some frames [m].
  get size() {
    if (this.framing) return this.framing.size;
    if (!this.extent) {
      this.extent = 0.5;
      const step = Math.max(1, Math.floor(this.frames / 50));
      for (let k = 0; k < this.frames; k += step) {
        for (let axis = 0; axis < 3; ++axis) {
          const [least, most] = boundsOfFrame(this, k, axis);
          this.extent = Math.max(this.extent, most - least);
        }
      }
    }
    return this.extent;
  }

  get hidesMarkers() {
    return this.most_hidden.some((count) => count > 0);
  }
}

// Least and most of the measured markers of a frame along an axis; infinite where there is none.
function boundsOfFrame(trial, frame, axis) {
  let least = Infinity;
  let most = -Infinity;
  for (let label = 0; label < trial.labels.length; ++label) {
    const value = trial.positions[3 * (frame * trial.labels.length + label) + axis];
    if (value < least) least = value;
    if (value > most) most = value;
  }
  return [least, most];
}

// Of the first frame in which something is measured; 0 where nothing ever is.
function firstMiddle(trial, axis) {
  for (let frame = 0; frame < trial.frames; ++frame) {
    const [least, most] = boundsOfFrame(trial, frame, axis);
    if (least <= most) return (least + most) / 2;
  }
  return 0;
}

// Middles of the bounds, running over a third of a second; where nothing is measured, the last, and
// before that the first.
function smoothedMiddles(trial) {
  const middles = new Float32Array(3 * trial.frames);
  const share = Math.min(1, 6 / trial.rate);
  for (let axis = 0; axis < 3; ++axis) {
    let smooth = firstMiddle(trial, axis);
    for (let frame = 0; frame < trial.frames; ++frame) {
      const [least, most] = boundsOfFrame(trial, frame, axis);
      const middle = (least + most) / 2;
      if (least <= most) smooth += share * (middle - smooth);
      middles[3 * frame + axis] = smooth;
    }
  }
  return middles;
}

// Where a body is, of some frames evenly spread: bounds are [least, most], of three numbers each.
class Framing {
  constructor(step, bounds) {
    this.step = step;
    this.middles = bounds.map(([least, most]) => least.map((value, axis) => (value + most[axis]) / 2));
    this.size = Math.max(0.5, ...bounds.map(([least, most]) => Math.max(...most.map((value, axis) => value - least[axis]))));
  }

  middle(frame) {
    const at = Math.min(frame / this.step, this.middles.length - 1);
    const before = this.middles[Math.floor(at)];
    const after = this.middles[Math.ceil(at)];
    return before.map((value, axis) => value + (at - Math.floor(at)) * (after[axis] - value));
  }
}

// A part of the report: one comparison.
class Section {
  constructor(heading, figures, tracks) {
    Object.assign(this, heading);  // title, text, verdict
    this.figures = figures;        // as --json says it
    this.tracksText = tracks;
  }

  // The data that are drawn, read at first use as they are large.
  load() {
    if (this.trials) return;
    const tracks = JSON.parse(this.tracksText);
    this.tracksText = null;
    this.contenders = tracks.contenders;
    this.trials = tracks.trials.map((trial) => new Trial(trial));
    for (const row of tracks.rows) {
      const trial = this.trials[row.trial];
      const track = new Track(row, this.contenders[row.contender], trial);
      (track.failure ? trial.failed : trial.tracks).push(track);
    }
  }
}

function readSections() {
  const texts = (name) =>
    Array.from(document.querySelectorAll(`script.${name}`), (block) => block.textContent);
  const figures = texts("figures");
  const tracks = texts("tracks");
  return texts("heading").map((heading, i) =>
    new Section(JSON.parse(heading), JSON.parse(figures[i]), tracks[i]));
}
