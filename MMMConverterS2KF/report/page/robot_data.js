// SPDX-License-Identifier: MIT
// A person's motion on a robot, as the page was given it. SI units.

// Of the trunks, unlike those of the limbs.
const kPersonColour = 7;
const kRobotColour = 4;

const kLimbEnds = ["heel", "toe"];

// Both bodies over time, and what is measured of them.
class RobotTrial extends Trial {
  constructor(json, bodies) {
    super(json);
    const track = (name, colour, part) => ({contender: colour, name: bodies[name].name, trial: this, body: bodies[name],
      motion: new Motion(part.motion), place: part.place, stands: (side, frame) => this.stands(side, frame)});
    this.person = track("person", kPersonColour, json.person);
    this.robot = track("robot", kRobotColour, json.robot);
    this.tracks = [this.person, this.robot];
    this.feet = json.feet.map((foot) => ({side: foot.side, heel: unpack(foot.heel), toe: unpack(foot.toe),
      height: unpack(foot.height), speed: unpack(foot.speed)}));
    this.limbs = json.limbs.map((limb) => ({name: limb.name, errors: unpack(limb.errors)}));
  }

  get hidesMarkers() {
    return false;
  }

  isOn(foot, end, frame) {
    return (foot[end][frame >> 3] >> (frame & 7) & 1) === 1;
  }

  stands(side, frame) {
    return this.feet.some((foot) => foot.side === side && kLimbEnds.some((end) => this.isOn(foot, end, frame)));
  }

  // Of a joint of the robot.
  angle(joint, frame) {
    const {joints, angles} = this.robot.motion;
    return angles[joints.indexOf(joint) * this.frames + frame];
  }
}

// [first, last] frames of the spans in which something holds, the longest first.
function spansWhere(frames, holds) {
  const spans = [];
  for (let k = 0; k < frames; ++k) {
    if (!holds(k)) continue;
    if (spans.length && spans[spans.length - 1][1] === k - 1) spans[spans.length - 1][1] = k;
    else spans.push([k, k]);
  }
  return spans.sort((a, b) => (b[1] - b[0]) - (a[1] - a[0]));
}

const kAtLimit = 2e-3;   // [rad], as angles are packed
const kAtSpeed = 0.97;   // of a limit
const kSlides = 0.01;    // [m/s]

// Frames in which a joint stands at a limit of position, or of velocity.
function spansAtLimit(trial, joint) {
  return spansWhere(trial.frames, (k) => {
    const angle = trial.angle(joint.index, k);
    if (angle < joint.lower + kAtLimit || angle > joint.upper - kAtLimit) return true;
    if (k === 0 || trial.every > 1 || joint.speed === null) return false;
    return Math.abs(angle - trial.angle(joint.index, k - 1)) * trial.rate > kAtSpeed * joint.speed;
  });
}

function readBodies(json) {
  const whole = (model) => ({...model, joints: model.joints.map((joint, index) =>
    ({...joint, index, lower: joint.lower === null ? -Infinity : joint.lower, upper: joint.upper === null ? Infinity : joint.upper}))});
  const body = ({name, model}, shows) => ({name, model: whole(model), markers: shows ? model.markers.map((_, i) => i) : []});
  return {person: body(json.person, true), robot: body(json.robot, false)};
}
