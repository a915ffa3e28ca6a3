// SPDX-License-Identifier: MIT
// A recording's points with sticks between neighbours, under the names before and after: where a name is on another
// point, sticks of those before go astray.

const kStickFrames = 60;     // that tell neighbours
const kStiffness = 5;        // a spread of a distance counts so many times the distance
const kMoved = 1e-4;         // [m] between the places of a name that is on another point

// The names' tracks, before and after; the chosen one is drawn as a ring.
class LabelTrial extends Trial {
  constructor(json, isRepair) {
    super({...json, name: "labels", labels: json.names.map((one) => one.name), markers: [], model: {segments: []},
      optimum_every: json.every});
    this.firstFrame = json.first_frame;
    this.chosen = null;
    this.names = json.names.map((one) => {
      const name = {name: one.name, hasBefore: one.before !== null};
      lazily(name, "before", one.before);
      lazily(name, "after", one.after);
      return name;
    });
    Object.defineProperty(this, "positions", {get: () => this.allPlaces()});
    const hasBefore = this.names.some((one) => one.hasBefore);
    const track = (name, which, contender) => ({name, which, contender, trial: this,
      makeFigure: (signs) => new StickFigure(this, which, contender, signs)});
    this.words = isRepair ? {before: "before the repair", after: "after it"} : {before: "as it was", after: "found"};
    this.tracks = [...(hasBefore ? [track(this.words.before, "before", 1)] : []), track(this.words.after, "after", 0)];
  }

  // As of any Trial: a frame's names beside each other.
  allPlaces() {
    if (this.places) return this.places;
    const {frames, names} = this;
    this.places = new Float32Array(3 * frames * names.length);
    names.forEach(({after}, label) => {
      for (let k = 0; k < frames; ++k) {
        for (let axis = 0; axis < 3; ++axis) this.places[3 * (k * names.length + label) + axis] = after[axis * frames + k];
      }
    });
    return this.places;
  }

  get hidesMarkers() {
    return false;
  }

  isHidden(label) {
    return this.names[label].name === this.chosen;
  }

  // Of a frame of the file.
  drawn(frame) {
    return Math.floor((frame - this.firstFrame) / this.every);
  }

  recorded(frame) {
    return this.firstFrame + frame * this.every;
  }

  // Where a name was ("before") or is ("after"); null: not seen.
  place(which, label, frame, target) {
    const track = this.names[label][which];
    if (!track || Number.isNaN(track[frame])) return null;
    return target.set(track[frame], track[this.frames + frame], track[2 * this.frames + frame]);
  }

  // Whether another point has the name now, or none, or one that had none.
  isChanged(label, frame) {
    const {before, after} = this.names[label];
    if (!before) return false;
    const isSeen = !Number.isNaN(after[frame]);
    if (isSeen === Number.isNaN(before[frame])) return true;
    return isSeen && [0, 1, 2].some((axis) =>
      Math.abs(before[axis * this.frames + frame] - after[axis * this.frames + frame]) > kMoved);
  }

  // Pairs of names: the tree over all that is shortest where distances that change count as long.
  get sticks() {
    if (!this.pairs) this.pairs = shortestTree(this.names.length, distancesBetween(this));
    return this.pairs;
  }
}

// Means of the distances between names, larger where they change; Infinity where two are never seen together.
function distancesBetween(trial) {
  const count = trial.names.length;
  const sums = new Float64Array(count * count * 3);  // how many, sum, sum of squares
  const step = Math.max(1, trial.frames / kStickFrames);
  const places = trial.names.map(() => new THREE.Vector3());
  for (let at = 0; at < trial.frames; at += step) {
    const seen = places.map((place, label) => trial.place("after", label, Math.floor(at), place));
    for (let a = 0; a < count; ++a) {
      for (let b = 0; seen[a] && b < a; ++b) {
        if (!seen[b]) continue;
        const distance = seen[a].distanceTo(seen[b]);
        const i = 3 * (a * count + b);
        sums[i] += 1;
        sums[i + 1] += distance;
        sums[i + 2] += distance * distance;
      }
    }
  }
  return (one, other) => {
    const i = 3 * (Math.max(one, other) * count + Math.min(one, other));
    if (sums[i] === 0) return Infinity;
    const mean = sums[i + 1] / sums[i];
    return mean + kStiffness * Math.sqrt(Math.max(0, sums[i + 2] / sums[i] - mean * mean));
  };
}

// Prim's algorithm; what is Infinity away from all others stays alone.
function shortestTree(count, distance) {
  const pairs = [];
  const nearest = Array.from({length: count}, () => 0);
  const way = Array.from({length: count}, (_, i) => (i === 0 ? Infinity : distance(0, i)));
  const left = new Set(Array.from({length: count}, (_, i) => i).slice(1));
  while (left.size > 0) {
    const next = Array.from(left).reduce((best, one) => (way[one] < way[best] ? one : best));
    left.delete(next);
    if (Number.isFinite(way[next])) pairs.push([nearest[next], next]);
    for (const one of left) {
      if (distance(next, one) >= way[one]) continue;
      way[one] = distance(next, one);
      nearest[one] = next;
    }
  }
  return pairs;
}

// Sticks, and crosses where a name was changed. What Scene asks of a Figure.
class StickFigure {
  constructor(trial, which, contender, signs) {
    this.trial = trial;
    this.which = which;
    this.track = {contender, name: trial.words[which], mean: []};
    this.crosses = Cloud.signs(trial.names.length, signs.cross, 1.2 * kMarkerSize);
    this.lines = Cloud.lines(trial.sticks.length);
    this.group = new THREE.Group();
    this.group.add(this.crosses.object, this.lines.object);
    this.body = {root: this.group, nodes: [], hasPaleLimb: false};
  }

  setFrame(k) {
    const {trial, which} = this;
    this.crosses.clear();
    this.lines.clear();
    const [from, to] = [new THREE.Vector3(), new THREE.Vector3()];
    for (const [one, other] of trial.sticks) {
      if (!trial.place(which, one, k, from) || !trial.place(which, other, k, to)) continue;
      this.lines.add(from);
      this.lines.add(to);
    }
    trial.names.forEach((_, label) => {
      if (trial.isChanged(label, k) && trial.place(which, label, k, from)) this.crosses.add(from);
    });
    this.crosses.finish();
    this.lines.finish();
  }

  setLook(options) {
    const colour = converterColour(this.track.contender);
    this.crosses.setColour(colour);
    this.lines.setColour(colour);
    this.lines.object.visible = options.body;
  }
}
