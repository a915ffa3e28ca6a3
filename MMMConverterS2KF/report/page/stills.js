// SPDX-License-Identifier: MIT
// A strip of small pictures of selected frames.

const kNumStills = 6;

// How far a posture moves from frame to frame: joint angles, and the root's turn.
function postureSteps(motion, frames) {
  const steps = new Float64Array(frames);
  for (let k = 1; k < frames; ++k) {
    let sum = 0;
    for (let column = 0; column < motion.joints.length; ++column) {
      sum += (motion.angles[column * frames + k] - motion.angles[column * frames + k - 1]) ** 2;
    }
    let cosine = 0;
    for (let i = 0; i < 4; ++i) cosine += motion.orientation[4 * k + i] * motion.orientation[4 * k - 4 + i];
    steps[k] = Math.sqrt(sum + 4 * Math.acos(Math.min(1, Math.abs(cosine))) ** 2);
  }
  return steps;
}

// Frames between which the posture changes by as much each time; half of it even in time, so that
// a calm part is not left out.
function selectFrames(trial, motion) {
  const steps = postureSteps(motion, trial.frames);
  const total = steps.reduce((sum, step) => sum + step, 0);
  const frames = [0];
  let way = 0;
  for (let k = 1; k < trial.frames; ++k) {
    way += (total > 0 ? 0.5 * steps[k] / total : 0.5 / (trial.frames - 1)) + 0.5 / (trial.frames - 1);
    if (way >= frames.length / (kNumStills - 1) - 1e-9) frames.push(k);
  }
  return frames.slice(0, kNumStills);
}

class Stills {
  constructor(view, player) {
    this.view = view;
    this.player = player;
    this.redraw = oncePerPicture(() => this.draw());
  }

  show(trial) {
    this.frames = selectFrames(trial, trial.truth || trial.tracks[0].motion);
    this.buttons = this.frames.map((frame) => {
      const time = `${formatNumber(trial.time(frame), 2)} s`;
      const button = element("button", {type: "button", class: "still", "aria-label": `Go to ${time}, frame ${trial.recorded(frame)}`},
        this.player.scene ? element("canvas", {width: 300, height: 300}) : null,
        element("span", {}, time));
      button.addEventListener("click", () => this.view.seek(frame));
      return button;
    });
    replaceContent(byId("stills"), ...this.buttons);
  }

  refresh() {
    this.redraw();
  }

  draw() {
    if (!this.player.scene || !this.view.trial) return;
    this.buttons.forEach((button, i) =>
      this.player.scene.drawStill(this.frames[i], button.querySelector("canvas")));
    this.player.draw();
  }

  setFrame(frame) {
    let nearest = 0;
    this.frames.forEach((other, i) => {
      if (other <= frame) nearest = i;
    });
    this.buttons.forEach((button, i) => button.classList.toggle("current", i === nearest));
  }
}
