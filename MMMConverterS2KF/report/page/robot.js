// SPDX-License-Identifier: MIT
// The page of a motion on a robot: verdict, player, what the robot could not do, charts with one cursor.

const kMostTimes = 5;  // that are listed of one thing

class RobotView {
  constructor(figures, json) {
    this.figures = figures;
    const bodies = readBodies(json);
    this.trials = json.trials.map((trial) => new RobotTrial(trial, bodies));
    this.joints = bodies.robot.model.joints;
    this.frame = 0;
    this.shown = new Set([kPersonColour, kRobotColour]);
    this.charts = [];
    this.player = new Player(this);
    byId("trial").addEventListener("change", (event) => this.showTrial(Number(event.target.value)));
    replaceContent(byId("trial"), ...this.trials.map((trial, i) => option(i, trial.name)));
    const groups = new Map(this.joints.map((joint) => [joint.group, joint.group]));
    replaceContent(byId("joint-picker"), makeJointPicker(groups, (group) => this.choose(group)));
    this.group = groups.has("knee") ? "knee" : this.joints.length ? this.joints[0].group : "";
    this.showTrial(0);
    this.listLimits();
  }

  get recordedFrames() {
    return this.trial === this.trials[0] ? this.figures.frames : this.trial.frames;
  }

  showTrial(index) {
    this.trial = this.trials[index];
    byId("trial").value = index;
    this.frame = 0;
    byId("feet-part").hidden = this.trial.feet.length === 0;
    byId("limb-part").hidden = this.trial.limbs.length === 0;
    this.player.show(this.trial);
    this.refresh();
  }

  // Colours have changed, or what is shown.
  refresh() {
    for (const chart of this.charts) chart.destroy();
    this.charts = [...describeFeet(this.trial), ...describeLimbs(this.trial)].map(([host, options]) =>
      new Chart(byId(host), this, options));
    this.player.refresh();
    this.choose(this.group);
    this.seek(this.frame);
  }

  choose(group) {
    this.group = group;
    for (const dot of byId("joint-picker").querySelectorAll("[data-joint]")) {
      dot.classList.toggle("chosen", dot.dataset.joint === group);
    }
    for (const chart of this.jointCharts || []) chart.destroy();
    const hosts = [];
    const made = describeJoints(this.trial, this.joints.filter((joint) => joint.group === group)).map((options) => {
      const host = element("div", {class: "plot low"});
      hosts.push(element("h3", {}, options.label), host);
      return [host, options];
    });
    replaceContent(byId("joint-charts"), ...hosts);
    this.jointCharts = made.map(([host, options]) => new Chart(host, this, options));
  }

  seek(frame) {
    this.frame = Math.min(Math.max(Math.round(frame), 0), this.trial.frames - 1);
    for (const part of [this.player, ...this.charts, ...this.jointCharts]) part.setFrame(this.frame);
  }

  // A chart was zoomed to a range of time; the others follow.
  zoom(source, range) {
    if (this.zooming) return;
    this.zooming = true;
    for (const chart of [...this.charts, ...this.jointCharts]) if (chart !== source) chart.zoom(range);
    this.zooming = false;
  }

  describe(frame) {
    return this.trial.feet.map((foot) => {
      const ends = kLimbEnds.filter((end) => this.trial.isOn(foot, end, frame));
      const slides = foot.speed[frame] > kSlides ? `, slides by ${formatNumber(1000 * foot.speed[frame], 0)} mm/s` : "";
      return `${foot.side} foot ${ends.length ? `on ${ends.join(" and ")}` : "in the air"}${slides}`;
    });
  }

  // Shows a time of the motion.
  timeButton(seconds) {
    const button = element("button", {type: "button", class: "plain"}, `${formatNumber(seconds, 2)} s`);
    button.addEventListener("click", () => {
      if (this.trial !== this.trials[0]) this.showTrial(0);
      this.seek(this.trial.frameAt(seconds));
      byId("player").scrollIntoView({block: "nearest"});
    });
    return button;
  }

  timesOf(spans) {
    const [trial] = this.trials;
    const more = spans.length - kMostTimes;
    return element("td", {class: "times"}, ...spans.slice(0, kMostTimes).flatMap(([first, last]) =>
      [this.timeButton(trial.time(first)), `(${formatNumber((last - first + 1) / trial.rate, 3)} s) `]),
    more > 0 ? `and ${more} more` : "");
  }

  listLimits() {
    const {figures} = this;
    const [trial] = this.trials;
    const reasons = figures.verdict.reasons.map((reason) => element("li", {}, reason));
    if (figures.penetration_m > 0 && trial.feet.length) {
      reasons.push(element("li", {}, `the deepest foot is ${formatMillimetres(figures.penetration_m)} below the floor at `,
        this.timeButton(figures.penetration_at_s)));
    }
    for (const foot of trial.feet) {
      const spans = spansWhere(trial.frames, (k) => foot.speed[k] > kSlides);
      if (spans.length) reasons.push(element("li", {}, `the ${foot.side} foot slides: `, ...this.timesOf(spans).childNodes));
    }
    replaceContent(byId("reasons"), ...(reasons.length ? reasons : [element("li", {}, "nothing that its verdict minds")]));
    byId("reasons").classList.add("reasons");
    const number = (radians) => element("td", {}, formatNumber(radians * 180 / Math.PI, 1));
    if (figures.limbs.length) {
      replaceContent(byId("limbs"), makeTable("limbs", "Directions of limbs",
        ["Limb", "from the person's, °", "95 % below, °", "most, °", "at"], figures.limbs.map((limb) =>
          [limb.name, number(limb.mean_rad), number(limb.p95_rad), number(limb.most_rad),
            element("td", {class: "times"}, this.timeButton(limb.most_at_s))])));
    }
    if (figures.joints_at_limits.length) {
      const share = (value) => element("td", {}, formatNumber(100 * value, 1));
      replaceContent(byId("joints-at-limits"), makeTable("joints-at-limits", "Joints at limits",
        ["Joint at its limits", "of position, % of frames", "of velocity, %", "longest from"], figures.joints_at_limits.map((one) =>
          [one.name, share(one.at_position_limit), share(one.at_velocity_limit),
            this.timesOf(spansAtLimit(trial, this.joints.find((joint) => joint.name === one.name)))])));
    }
  }
}

function ofSide(side, name, values, isSecond) {
  return {name, colour: kSideColours[side], dash: isSecond ? [6, 3] : null, values};
}

// [host, options of a chart] of each chart.
function describeFeet(trial) {
  if (!trial.feet.length) return [];
  const ends = trial.feet.flatMap((foot) => kLimbEnds.map((end) => ({foot, end})));
  const contacts = ends.map(({foot, end}, i) => ({name: `${foot.side} ${end}`, colour: kSideColours[foot.side], width: 9,
    values: (k) => trial.isOn(foot, end, k) ? ends.length - i : NaN,
    says: (k) => trial.isOn(foot, end, k) ? "on the ground" : "–"}));
  const lines = (name) => trial.feet.map((foot) => ofSide(foot.side, foot.side, (k) => 1000 * foot[name][k]));
  return [
    ["contact-plot", {lines: contacts, unit: "", digits: 0, range: [0.4, ends.length + 0.6], hasNoScale: true,
      label: "Contacts of the person's feet over time"}],
    ["height-plot", {lines: [level(0), ...lines("height")], unit: "mm", digits: 1, label: "Height of the robot's feet over time, millimetres"}],
    ["speed-plot", {lines: [level(1000 * kSlides), ...lines("speed")], unit: "mm/s", digits: 1,
      label: "Speed of the robot's feet in contact over time, millimetres per second"}],
  ];
}

function describeLimbs(trial) {
  if (!trial.limbs.length) return [];
  const chart = (names, label) => ({unit: "°", digits: 1, label,
    lines: trial.limbs.filter((limb) => names.test(limb.name)).map((limb) => ofSide(limb.name.split(" ")[0], limb.name,
      (k) => limb.errors[k] * 180 / Math.PI, /shank|forearm/.test(limb.name)))});
  return [["legs-plot", chart(/thigh|shank/, "Directions of the legs over time, degrees from the person's")],
    ["arms-plot", chart(/arm/, "Directions of the arms over time, degrees from the person's")]];
}

// Options of a chart for each left joint with its right one, or one that has no side.
function describeJoints(trial, joints) {
  const rows = new Map();
  for (const joint of joints) {
    const key = joint.side ? `${joint.order}` : joint.name;
    if (!rows.has(key)) rows.set(key, []);
    rows.get(key).push(joint);
  }
  return Array.from(rows.values()).map((row) => {
    const turns = (joint) => joint.slides ? 1000 : 180 / Math.PI;
    const limits = row.flatMap((joint) => [joint.lower, joint.upper].filter(Number.isFinite).map((value) =>
      ({...level(value * turns(joint)), colour: joint.side ? kSideColours[joint.side] : themeColour("muted")})));
    const lines = row.map((joint) => ({name: joint.name, colour: kSideColours[joint.side] || themeColour("accent"),
      values: (k) => trial.angle(joint.index, k) * turns(joint)}));
    return {lines: [...limits, ...lines], unit: row[0].slides ? "mm" : "°", digits: 1, label: row.map((joint) => joint.name).join(", ")};
  });
}

function makeFigures(figures) {
  const percent = (value) => value === null ? "–" : `${formatNumber(100 * value, 1)} %`;
  const degrees = (value) => value === null ? "–" : `${formatNumber(value * 180 / Math.PI, 1)}°`;
  const rows = [
    ["Feet slide", percent(figures.slide), `of the frames in contact; ${percent(figures.toe_slide_30_hz)} by the toe's rule at 30 Hz`],
    ["Deepest in the floor", figures.sole === null ? "–" : formatMillimetres(figures.penetration_m), "any point of the feet, in any frame"],
    ["Above the floor in contact", figures.floating_m === null ? "–" : formatMillimetres(Math.round(1e4 * figures.floating_m) / 1e4 + 0), "on average"],
    ["Limbs point elsewhere by", degrees(figures.direction_rad), `on average; 95 % below ${degrees(figures.direction_p95_rad)}`],
    ["Limits broken", `${figures.position_limits_broken}, ${figures.velocity_limits_broken}`, "times, of position and of velocity"],
    ["Accelerations", `${formatNumber(figures.acceleration_rad_s2, 1)} rad/s²`, `rms of the joints that move; jerk ${formatNumber(figures.jerk_rad_s3, 0)} rad/s³`],
    ["Path", figures.path === null ? "–" : formatNumber(figures.path, 3), "of what the legs allow"],
  ];
  return makeTable("checks", "Figures", ["Figure", "measured", ""],
    rows.map(([name, value, says]) => [name, element("td", {}, value), element("td", {class: "muted"}, says)]));
}

function start() {
  const figures = readBlock("figures");
  byId("program").textContent = figures.program;
  byId("sentence").textContent = figures.sentence;
  byId("about").textContent = figures.about;
  byId("map").textContent = figures.map;
  byId("size").textContent = `The person is drawn ${formatNumber(figures.scale, 3)} times as large, as tall as the robot.`;
  byId("scene").setAttribute("aria-label", "The person and the robot, in three dimensions");
  showNotes(figures.warnings);
  replaceContent(byId("figures"), makeFigures(figures));
  const view = new RobotView(figures, readBlock("bodies"));
  redrawWithColours(view);
  drawOnPaper(view);
  // For tests, and for who looks at the data in the browser's console.
  window.mmmReport = {
    figures,
    get frame() { return view.frame; },
    get frames() { return view.trial.frames; },
    get reach() { return view.player.scene ? view.player.scene.reach : null; },
    // Where the segments of the person (0) or the robot (1) are, as they are drawn.
    places: (body) => {
      view.player.scene.setFrame(view.frame);
      const {nodes, model} = view.player.scene.figures[body].body;
      return nodes.map((node, i) => ({name: model.segments[i].name, part: model.parts[i],
        place: new THREE.Vector3().setFromMatrixPosition(node.matrixWorld).toArray()}));
    },
    // Of the parts of a body, as they are drawn now.
    colours: (body) => {
      view.player.scene.setFrame(view.frame);
      return Object.fromEntries(Array.from(view.player.scene.figures[body].body.parts, ([part, {color}]) => [part, color.getHexString()]));
    },
    stands: (side) => view.trial.stands(side, view.frame),
    seek: (frame) => view.seek(frame),
    showTrial: (index) => view.showTrial(index),
  };
  markReady();
}

start();
