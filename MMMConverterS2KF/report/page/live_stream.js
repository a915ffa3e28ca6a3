// SPDX-License-Identifier: MIT
// What the program sends: a body, then postures; kept as the one frame of a trial that a scene draws.

const kStates = {hidden: 0, used: 1, wrong: 2, unused: 3};

class LiveTrial {
  constructor(body) {
    // Labels that the body has a marker for.
    this.columns = body.markers.map((marker, label) => [marker, label]).filter(([marker]) => marker >= 0);
    this.labels = this.columns.map(([, label]) => body.labels[label]);
    this.markers = this.columns.map(([marker]) => marker);
    this.model = body.model;
    this.frames = 1;
    this.truth = null;
    this.seenMarkers = this.markers;
    this.size = 1.9;
    this.positions = new Float32Array(3 * this.labels.length).fill(NaN);
    this.states = new Uint8Array(this.labels.length);
    this.distances = new Float32Array(this.labels.length).fill(NaN);
    this.motion = {
      joints: body.joints,
      position: new Float64Array(3),
      orientation: new Float64Array([0, 0, 0, 1]),
      angles: new Float64Array(body.joints.length),
    };
    // Of other objects, each with its own labels.
    this.objects = (body.objects || []).map((object) => new LiveTrial(object));
    this.name = body.body;
    this.isTracking = false;
    this.tracks = [{contender: 0, name: body.body, trial: this, motion: this.motion},
      ...this.objects.map((trial, i) => ({contender: i + 1, name: trial.name, trial, motion: trial.motion,
        makeFigure: (signs) => new ObjectFigure(trial.tracks[0], signs, i + 1)}))];
    this.smooth = null;
  }

  take(posture) {
    this.columns.forEach(([, label], i) => {
      const place = posture.markers[label] || [NaN, NaN, NaN];
      this.positions.set(place, 3 * i);
      this.states[i] = posture.states[label];
      const distance = posture.distances[label];
      this.distances[i] = distance === null ? NaN : distance;
    });
    this.isTracking = posture.tracking;
    for (const one of posture.objects || []) {
      const object = this.objects.find(({name}) => name === one.body);
      if (object) object.take(one);
    }
    if (!posture.tracking) return;
    this.motion.position.set(posture.root.slice(0, 3));
    this.motion.orientation.set(posture.root.slice(3));
    this.motion.angles.set(posture.angles);
    const share = this.smooth ? 0.08 : 1;
    this.smooth = this.motion.position.map((value, axis) =>
      share * value + (1 - share) * (this.smooth ? this.smooth[axis] : 0));
  }

  isMeasured(label) {
    return this.states[label] !== kStates.hidden;
  }

  isHidden(label) {
    return this.states[label] === kStates.wrong;
  }

  middle() {
    return this.smooth ? Array.from(this.smooth) : [0, 0, 0.9];
  }
}

// An object that is tracked beside the first body, with its measured markers.
class ObjectFigure extends Figure {
  constructor(track, signs, contender) {
    super({...track, contender}, signs);
    this.seen = Cloud.signs(track.trial.labels.length, signs.disc, kMarkerSize);
    this.group.add(this.seen.object);
  }

  setFrame(k) {
    const {trial} = this.track;
    const measured = (label, _, target) => target.fromArray(trial.positions, 3 * label);
    this.seen.clear();
    trial.labels.forEach((_, label) => {
      if (trial.isMeasured(label)) this.seen.add(measured(label, k, new THREE.Vector3()));
    });
    this.seen.finish();
    super.setFrame(k, measured);
  }

  setLook(options, overlaid) {
    super.setLook(options, overlaid);
    this.seen.setColour(themeColour("text"));
  }
}

// How often something happened in the last second.
class RateCounter {
  constructor() {
    this.times = [];
  }

  add(now) {
    this.times.push(now);
    while (this.times[0] < now - 1000) this.times.shift();
  }

  rate(now) {
    return this.times.filter((time) => time >= now - 1000).length;
  }
}
