// SPDX-License-Identifier: MIT
// What is plotted: marker distances, hidden markers, joint angles, times.

const kDegrees = 180 / Math.PI;
const kLeastDegrees = 30;  // of a chart: what hardly moves is not drawn as if it did

// Which way an angle grows, by the motion's name.
const kDirections = {
  "tilt": "Grows as the pelvis tilts forward.",
  "obliquity": "Positive where the left side is higher.",
  "rotation": "Positive to the left.",
  "flexion": "Grows with flexion; 0 where the model stands with hanging arms.",
  "lateral bending": "Positive to the right.",
  "adduction": "Positive towards the middle of the body; abduction is negative.",
  "internal rotation": "Positive inwards; external rotation is negative.",
  "dorsiflexion": "Grows as the toes rise; plantar flexion is negative.",
  "inversion": "Positive where the inner edge of the foot rises.",
  "pronation": "0 where the palm looks to the body; supination is negative.",
  "radial deviation": "Positive towards the thumb.",
};

class Plots {
  constructor(view) {
    this.view = view;
    this.charts = [];
    byId("joint").addEventListener("change", () => this.refreshJoint());
    this.angleCharts = [];
  }

  show(trial) {
    const runs = this.view.section.figures.options.runs;
    const caption = "Mean distance between measured and model markers in each frame" +
      (runs > 1 ? `, over ${runs} runs: the line is their mean, the band their 5th to 95th percentile, the thin line their largest.` : ".") +
      " ";
    replaceContent(byId("distance-caption"), caption,
      element("span", {class: "on-screen"}, "Click to jump, drag to zoom, double-click to zoom out."));
    byId("hidden-part").hidden = !trial.hidesMarkers;
    byId("time-part").hidden = !trial.tracks.some((track) => track.seconds.some((seconds) => seconds > 0));
    byId("nis-part").hidden = !trial.tracks.some((track) => track.nis.some((nis) => nis > 0));
    this.listJoints(trial);
  }

  // Joints by their anatomical names, and those of the model that some converter tracks, starting with the one that
  // moves most: of anatomical ones, the one whose first angle, flexion, does.
  listJoints(trial) {
    const joints = trial.model.joints.map((_, i) => i)
      .filter((joint) => trial.tracks.some((track) => track.motion.joints.includes(joint)));
    byId("joint-part").hidden = joints.length === 0;
    const group = (label, options) => {
      const made = document.createElement("optgroup");
      made.label = label;
      made.append(...options);
      return made;
    };
    const motion = trial.tracks[0].motion;
    const named = motion.anatomy ? motion.anatomy.joints : new Map();
    const ofModel = joints.map((joint) => option(joint, trial.model.joints[joint].name));
    replaceContent(byId("joint"), ...(named.size === 0 ? ofModel :
      [group("Anatomical angles", Array.from(named.keys(), (name) => option(name, name))),
        group("Joints of the model", ofModel)]));
    byId("joint-picker").hidden = named.size === 0;
    replaceContent(byId("joint-picker"), makeJointPicker(named, (name) => {
      byId("joint").value = name;
      this.refreshJoint();
    }));
    const widest = {range: -1};
    const consider = (value, numbers, column) => {
      const angles = numbers.subarray(column * trial.frames, (column + 1) * trial.frames);
      const range = angles.reduce((most, angle) => Math.max(most, angle), -Infinity) -
        angles.reduce((least, angle) => Math.min(least, angle), Infinity);
      if (range > widest.range) Object.assign(widest, {range, value});
    };
    if (named.size > 0) {
      for (const [name, titles] of named) {
        if (!kLimbJoints.includes(name)) continue;
        for (const {column} of motion.anatomy.columns.get(titles[0])) consider(name, motion.anatomy.values, column);
      }
    } else {
      motion.joints.forEach((joint, column) => consider(joint, motion.angles, column));
    }
    if ("value" in widest) byId("joint").value = widest.value;
  }

  refresh() {
    for (const chart of this.charts) chart.destroy();
    this.angleCharts = [];
    const tracks = this.view.shownTracks;
    this.charts = [this.distanceChart(tracks)];
    if (!byId("time-part").hidden) this.charts.push(this.timeChart(tracks));
    if (!byId("nis-part").hidden) this.charts.push(this.nisChart(tracks));
    if (this.view.trial.hidesMarkers) this.charts.push(this.hiddenChart());
    if (!byId("joint-part").hidden) this.showAngles(tracks);
  }

  refreshJoint() {
    for (const chart of this.angleCharts) chart.destroy();
    this.charts = this.charts.filter((chart) => !this.angleCharts.includes(chart));
    this.showAngles(this.view.shownTracks);
  }

  setFrame(frame) {
    for (const chart of this.charts) chart.setFrame(frame);
  }

  zoom(source, range) {
    for (const chart of this.charts) {
      if (chart !== source) chart.zoom(range);
    }
  }

  lineOf(track, values) {
    return {name: track.name, colour: converterColour(track.contender), dash: converterDash(track.contender),
      values};
  }

  distanceChart(tracks) {
    const trial = this.view.trial;
    const hasRuns = this.view.section.figures.options.runs > 1;
    const hasBand = hasRuns || trial.every > 1;
    const lines = [];
    for (const track of tracks) {
      const line = this.lineOf(track, (k) => 1000 * track.mean[k]);
      if (hasBand) {
        line.band = (k) => [1000 * track.p05[k], 1000 * track.p95[k]];
        lines.push({name: null, colour: line.colour, width: 0.7, values: (k) => 1000 * track.max[k]});
      }
      lines.push(line);
    }
    lines.push({name: "optimum", colour: themeColour("muted"), dash: [1, 3], width: 1.6,
      values: (k) => 1000 * trial.optimum[k]});
    const {range, largest} = rangeWithoutPeaks(lines, trial.frames);
    byId("distance-peak").textContent = largest > range[1]
      ? `Peaks are cut off: the largest value is ${formatNumber(largest, 1)} mm.` : "";
    return new Chart(byId("distance-plot"), this.view,
      {lines, unit: "mm", digits: 1, range, label: "Marker distance over time, millimetres"});
  }

  hiddenChart() {
    const trial = this.view.trial;
    return new Chart(byId("hidden-plot"), this.view, {lines: [
      {name: "mean", colour: themeColour("text"), values: (k) => trial.mean_hidden[k]},
      {name: "most", colour: themeColour("muted"), width: 0.8, values: (k) => trial.most_hidden[k]},
    ], unit: "markers", digits: 1, label: "Number of hidden markers over time"});
  }

  timeChart(tracks) {
    // A logarithmic axis knows no 0.
    const lines = tracks.map((track) => Object.assign(
      this.lineOf(track, (k) => 1000 * track.seconds[k] || NaN), {dash: null, width: 1},
      bandOf(track.seconds_least, track.seconds_most, (seconds) => 1000 * seconds || NaN)));
    return new Chart(byId("time-plot"), this.view,
      {lines, unit: "ms", digits: 2, logarithmic: tracks.length > 0, label: "Time per frame, milliseconds, logarithmic"});
  }

  nisChart(tracks) {
    const stating = tracks.filter((track) => track.nis.some((nis) => nis > 0));
    const lines = stating.map((track) => Object.assign(this.lineOf(track, (k) => track.nis[k]),
      bandOf(track.nis_least, track.nis_most, (nis) => nis)));
    const grey = themeColour("muted");
    for (const track of stating.slice(0, 1)) {
      for (const bound of [track.nis_low, track.nis_high]) {
        lines.push({name: null, colour: grey, dash: [8, 4], width: 1, values: (k) => bound[k]});
      }
    }
    return new Chart(byId("nis-plot"), this.view, {lines, unit: "", digits: 2, logarithmic: stating.length > 0,
      label: "Normalised innovation squared over its degrees of freedom, logarithmic"});
  }

  // All angles of an anatomical joint, a chart each, or that of a joint of the model.
  showAngles(tracks) {
    const chosen = byId("joint").value;
    const {anatomy} = this.view.trial.tracks[0].motion;
    const titles = anatomy ? anatomy.joints.get(chosen) : undefined;
    for (const dot of byId("joint-picker").querySelectorAll("[data-joint]")) {
      dot.classList.toggle("chosen", dot.dataset.joint === chosen);
    }
    const host = (kind) => element("div", {class: kind});
    if (titles) {
      const hosts = titles.map(() => host("plot low"));
      replaceContent(byId("joint-plot"), ...titles.flatMap((title, i) => [element("h3", {}, title),
        element("p", {class: "caption"}, kDirections[title.split(" ").slice(1).join(" ")]), hosts[i]]));
      this.angleCharts = titles.map((title, i) => this.anatomyChart(title, tracks, hosts[i]));
    } else {
      const one = host("plot");
      replaceContent(byId("joint-plot"), one);
      this.angleCharts = [this.jointChart(tracks, one)];
    }
    this.charts.push(...this.angleCharts);
  }

  // Left and right in colours of their own where there is one converter, else the right dashed.
  anatomyChart(title, tracks, host) {
    const trial = this.view.trial;
    const lines = [];
    let hasBand = false;
    const add = (anatomy, line, name) => {
      for (const {side, column} of anatomy ? anatomy.columns.get(title) || [] : []) {
        const of = (numbers) => (k) => kDegrees * numbers[column * trial.frames + k];
        const value = of(anatomy.values);
        const one = Object.assign({}, line(side), {name: [name, side].filter(Boolean).join(", ") || title, values: value});
        if (anatomy.deviations && !name.startsWith("truth")) {
          const deviation = of(anatomy.deviations);
          one.band = (k) => [value(k) - 2 * deviation(k), value(k) + 2 * deviation(k)];
          hasBand = true;
        }
        lines.push(one);
      }
    };
    const truth = trial.truth && trial.truth.anatomy;
    if (truth) add(truth, (side) => ({colour: themeColour("text"), width: 3, dash: side === "right" ? [6, 3] : null}), "truth");
    for (const track of tracks) {
      const own = this.lineOf(track);
      if (tracks.length === 1) add(track.motion.anatomy, (side) => ({colour: kSideColours[side] || own.colour}), "");
      else add(track.motion.anatomy, (side) => ({colour: own.colour, dash: side === "right" ? [6, 3] : own.dash}), track.name);
    }
    byId("joint-caption").textContent = hasBand ? "Bands are ±2 standard deviations, as the converter states them." : "";
    return new Chart(host, this.view, {lines, unit: "°", digits: 1,
      range: atLeast(kLeastDegrees, withMargin(extremes(lines, trial.frames))), label: `${title} over time, degrees`});
  }

  jointChart(tracks, host) {
    const trial = this.view.trial;
    const index = Number(byId("joint").value);
    const joint = trial.model.joints[index];
    const series = (motion, name) => {
      const column = motion.joints.indexOf(index);
      const numbers = motion[name];
      if (column < 0 || !numbers) return null;
      return (k) => kDegrees * numbers[column * trial.frames + k];
    };
    const lines = [];
    const grey = themeColour("muted");
    const limits = [joint.lower, joint.upper].filter((limit) => limit !== null);
    for (const limit of limits) {
      lines.push({name: null, colour: grey, dash: [8, 4], width: 1, values: () => kDegrees * limit});
    }
    const truth = trial.truth ? series(trial.truth, "angles") : null;
    if (truth) lines.push({name: "truth", colour: themeColour("text"), width: 3, values: truth});
    let hasBand = false;
    const reach = [];  // of what is not drawn
    for (const track of tracks) {
      const angle = series(track.motion, "angles");
      if (!angle) continue;
      const line = this.lineOf(track, angle);
      const deviation = series(track.motion, "deviations");
      const least = series(track.motion, "angles_least") || angle;
      const most = series(track.motion, "angles_most") || angle;
      if (least !== angle) reach.push({values: least}, {values: most});
      if (deviation) line.band = (k) => [least(k) - 2 * deviation(k), most(k) + 2 * deviation(k)];
      else if (least !== angle) line.band = (k) => [least(k), most(k)];
      hasBand = hasBand || Boolean(deviation);
      lines.push(line);
    }
    const degrees = limits.map((limit) => `${formatNumber(kDegrees * limit, 0)}°`);
    byId("joint-caption").textContent =
      (degrees.length > 0 ? `Limits ${degrees.join(" and ")} (dashed)` : "Turns without limits") +
      (hasBand ? "; the band is ±2 standard deviations, as the converter states them" : "") +
      (truth ? "; the broad line is the true angle" : "") + ".";
    return new Chart(host, this.view, {lines, unit: "°", digits: 1,
      range: withMargin(extremes([...lines, ...reach], trial.frames)), label: `Angle of ${joint.name} over time, degrees`});
  }
}

// A range as wide as this, about the same middle.
function atLeast(width, [least, most]) {
  const more = Math.max(0, width - (most - least)) / 2;
  return [least - more, most + more];
}

// The band of a line of which not all frames are drawn; none where all are.
function bandOf(least, most, scaled) {
  return least && most ? {band: (k) => [scaled(least[k]), scaled(most[k])]} : {};
}

// The range that is shown, so that rare peaks, such as a slow start, do not press all else flat.
function rangeWithoutPeaks(lines, frames) {
  const values = [];
  for (const line of lines) {
    for (let k = 0; k < frames; ++k) {
      const value = line.band ? line.band(k)[1] : line.values(k);
      if (!Number.isNaN(value)) values.push(value);
    }
  }
  values.sort((a, b) => a - b);
  if (values.length === 0) return {range: [0, 1], largest: 0};
  const largest = values[values.length - 1];
  const usual = values[Math.floor(0.98 * (values.length - 1))];
  const least = extremes(lines, frames)[0];
  return {range: withMargin([least, largest > 1.6 * usual ? 1.2 * usual : largest]), largest};
}
