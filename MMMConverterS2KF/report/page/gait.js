// SPDX-License-Identifier: MIT
// Strides: their figures, and angles, forces and moments over the gait cycle, left with right.

// Figures of strides by the names that files have for them: title, unit, decimals.
const kStrideFigures = {
  cadence_steps_per_min: ["Cadence", "steps/min", 1],
  speed_m_per_s: ["Speed", "m/s", 2],
  stride_length_m: ["Stride length", "m", 2],
  step_length_m: ["Step length", "m", 2],
  step_width_m: ["Step width", "m", 2],
  stride_time_s: ["Stride time", "s", 2],
  step_time_s: ["Step time", "s", 2],
  foot_off_percent: ["Stance, until foot off", "% of the cycle", 1],
  double_support_percent: ["Double support", "% of the cycle", 1],
};
const kCycleSamples = 101;
// [°] rms over the cycle: beyond, an angle misleads (McGinley et al. 2009, Gait & Posture 29), and the chart says so.
const kDoubtful = 5;
const kUntold = 20;  // [°] of trunk and arms: nothing in the recording tells them
const kLeastRange = {"°": 20, "N m/kg": 0.4, "W/kg": 0.4, "body weights": 0.4};  // of a chart: what hardly changes looks so
const kSides = ["left", "right"];
const kSideDashes = {left: null, right: [6, 2.5]};

// The grid that gait laboratories know: a row for each joint; sagittal, frontal, transverse.
const kGrid = [
  ["pelvis tilt", "pelvis obliquity", "pelvis rotation"],
  ["hip flexion", "hip adduction", "hip internal rotation"],
  ["knee flexion", "knee adduction", "knee internal rotation"],
  ["ankle dorsiflexion", "ankle inversion", "ankle internal rotation"],
  [null, null, "foot progression"],
];
const kForceGrid = [
  ["hip extension moment", "hip abduction moment", "hip external rotation moment"],
  ["knee extension moment", "knee abduction moment", "knee external rotation moment"],
  ["ankle plantar flexion moment", "ankle eversion moment", "ankle external rotation moment"],
  ["hip power", "knee power", "ankle power"],
  ["ground vertical force", "residual force", "residual moment"],
];
// What grows upwards, by title.
const kGrows = {
  "pelvis tilt": "forward", "pelvis obliquity": "own side up", "pelvis rotation": "own side forward",
  "trunk flexion": "forward", "trunk lateral bending": "to the own side", "trunk rotation": "own side forward",
  "neck flexion": "forward", "neck lateral bending": "to the own side", "neck rotation": "own side forward",
  "foot progression": "toes inwards",
};

// summaries: of each condition, with its name.
function makeStrideTable(summaries) {
  const head = (text, attributes) => element("th", {scope: "col", ...attributes}, text);
  const heads = summaries.flatMap(() => [head("left", {class: "left-side edge"}), head("sd"), head("n"), head("right", {class: "right-side"}),
    head("sd"), head("n"), head("right − left, %", {title: "Of their mean: the symmetry index (Robinson et al. 1987)"})]);
  const rows = Object.entries(kStrideFigures).map(([name, [title, unit, digits]]) => {
    const cells = summaries.flatMap(({summary}) => {
      const [left, right] = kSides.map((side) => summary[side][name] || {mean: null, sd: null, strides: 0});
      const apart = left.mean === null || right.mean === null ? NaN
        : 200 * (right.mean - left.mean) / (Math.abs(right.mean) + Math.abs(left.mean));
      return [...[left, right].flatMap(({mean, sd, strides}, i) => [
        element("td", {class: i === 0 ? "edge" : null}, formatNumber(knownNumber(mean), digits)),
        element("td", {class: "muted"}, sd === null ? "" : `± ${formatNumber(sd, digits)}`),
        element("td", {class: "muted"}, String(strides))]), element("td", {}, signed(apart, 1))];
    });
    return element("tr", {}, element("th", {scope: "row"}, title), ...cells, element("td", {class: "muted unit"}, unit));
  });
  return element("div", {class: "wide", tabindex: "0", role: "region", "aria-label": "Figures of strides"},
    element("table", {class: "figures strides"}, element("caption", {class: "unseen"}, "Figures of strides"),
      element("thead", {}, summaries.length < 2 ? null : element("tr", {}, element("td", {}), ...summaries.map(({name}) =>
        element("th", {scope: "colgroup", colspan: 7, class: "group"}, name)), element("td", {})),
      element("tr", {}, head(""), ...heads, head("unit"))),
      element("tbody", {}, ...rows)));
}

const knownNumber = (value) => value === null || value === undefined ? NaN : value;

// Least and most of lists of numbers, at least so far apart.
function rangeOf(lists, width) {
  let [least, most] = [Infinity, -Infinity];
  for (const list of lists) {
    for (const value of list) {
      if (value < least) least = value;
      if (value > most) most = value;
    }
  }
  return atLeast(width, withMargin([least, most]));
}

// Of an angle its deviation, root mean square over the cycle [°]; NaN: not known.
function doubtOf({uncertainty}) {
  const known = (uncertainty || []).map(knownNumber).filter(Number.isFinite);
  return Math.sqrt(known.reduce((sum, value) => sum + value * value, 0) / known.length);
}

// Left and right of one angle, force or moment over the cycle, of one condition or of several.
class CycleChart {
  // cycles have, beyond what the page was given, name, colour and footOff. normals: bands of healthy gait for them.
  constructor(title, cycles, normals) {
    this.name = title;
    this.title = title === "ground vertical force" ? "vertical force" : title;
    this.cycles = cycles;
    this.normals = normals;
    this.unit = cycles[0].unit;
    this.area = element("div", {class: "cycle-area"});
    this.doubts = cycles.filter((cycle) => this.unit === "°" && doubtOf(cycle) > kDoubtful);
    this.host = element("figure", {class: "cycle"},
      element("figcaption", {}, element("b", {}, this.title), ` ${this.unit.replaceAll(" ", "\u00a0")}` +
        (kGrows[title] ? `, ${kGrows[title]} +` : "")), this.area,
      this.doubts.length ? element("p", {class: "doubtful"}, this.describeDoubt()) : null,
      makePlotButtons(() => this.plotted(true)));
  }

  describeDoubt() {
    const degrees = this.doubts.map((cycle) => `±${formatNumber(doubtOf(cycle), 0)}°`);
    const told = this.doubts.length > 2 ? Array.from(new Set(degrees)) : this.doubts.map(({name}, i) => `${name} ${degrees[i]}`);
    return `Badly known: ${told.join(", ")}`;
  }

  bandOf({mean, sd}) {
    return (i) => [mean[i] - knownNumber(sd[i]), mean[i] + knownNumber(sd[i])];
  }

  lines(hasSingles) {
    const singles = [];
    for (const {colour, singles: all} of hasSingles ? this.cycles : []) {
      for (const values of all || []) {
        singles.push({colour, width: 0.5, opacity: 0.45, kind: "single",
          values: (i) => i % 2 === 0 ? values[i / 2] : (values[(i - 1) / 2] + values[(i + 1) / 2]) / 2});
      }
    }
    const normals = this.normals.map((one) => ({colour: "var(--normal)", shade: 0.8, values: () => NaN, band: this.bandOf(one)}));
    const doubts = this.doubts.map(({colour, mean, uncertainty}) => ({colour, hasEdges: true,
      values: () => NaN, band: (i) => [mean[i] - knownNumber(uncertainty[i]), mean[i] + knownNumber(uncertainty[i])]}));
    const means = this.cycles.map((cycle) => ({name: cycle.name, colour: cycle.colour, width: 1.8,
      dash: kSideDashes[cycle.side], values: (i) => knownNumber(cycle.mean[i]), band: this.bandOf(cycle)}));
    return [...normals, ...doubts, ...singles, ...means];
  }

  // All that is drawn, without doubts that would press it flat.
  get range() {
    return rangeOf([...this.normals.flatMap(({mean, sd}) => [mean.map((value, i) => value - sd[i]), mean.map((value, i) => value + sd[i])]),
      ...this.cycles.flatMap((cycle) => [...(cycle.singles || []), cycle.mean.map(knownNumber),
        ...[0, 1].map((end) => cycle.mean.map((_, i) => this.bandOf(cycle)(i)[end]))])], kLeastRange[this.unit] || 0);
  }

  plotted(hasSingles) {
    return {title: `${this.title} over the gait cycle, ${this.unit}`, unit: this.unit, xName: "gait cycle [%]",
      xs: Array.from({length: kCycleSamples}, (_, i) => i), lines: this.lines(hasSingles), range: this.range,
      verticals: this.cycles.filter(({footOff}) => Number.isFinite(footOff))
        .map(({footOff, colour, side}) => ({x: footOff, colour, dash: side === "left" ? "none" : "4 2"}))};
  }

  // In words, for who does not see it.
  describe() {
    return `${this.title}, ${this.unit}: ` + this.cycles.map(({name, mean}) => {
      const known = mean.map((value, percent) => ({value, percent})).filter(({value}) => value !== null);
      const [least, most] = [1, -1].map((way) => known.reduce((best, one) => (way * one.value < way * best.value ? one : best), known[0]));
      const digits = this.unit === "°" ? 0 : 2;
      return known.length ? `${name} from ${formatNumber(least.value, digits)} at ${least.percent} % of the cycle to ` +
        `${formatNumber(most.value, digits)} at ${most.percent} %` : `${name} unknown`;
    }).join("; ");
  }

  draw(hasSingles) {
    const chart = {...this.plotted(hasSingles), xName: "", xLabel: (label) => `${label} %`};
    const svg = svgChart(chart, {width: 280, height: 150});
    svg.setAttribute("aria-label", this.describe());
    svg.querySelector("title").textContent = this.describe();
    replaceContent(this.area, svg);
  }
}

// Mean and standard deviation of all members of groups: {mean, sd, count}; null where nothing is known.
function poolGroups(groups) {
  const known = groups.filter(({mean, count}) => mean !== null && count > 0);
  const count = known.reduce((sum, one) => sum + one.count, 0);
  if (count === 0) return {mean: null, sd: null, count};
  const mean = known.reduce((sum, one) => sum + one.count * one.mean, 0) / count;
  const squares = known.reduce((sum, one) =>
    sum + (one.count - 1) * (one.sd || 0) ** 2 + one.count * (one.mean - mean) ** 2, 0);
  return {mean, sd: count > 1 ? Math.sqrt(squares / (count - 1)) : null, count};
}

// Figures of several recordings, each {mean, sd, strides}.
function poolFigures(figures) {
  const {mean, sd, count} = poolGroups(figures.filter(Boolean).map((one) => ({mean: one.mean, sd: one.sd, count: one.strides})));
  return {mean, sd, strides: count};
}

// Strides of several recordings as if they were of one.
function poolGaits(gaits) {
  const summary = {};
  for (const side of kSides) {
    summary[side] = {};
    for (const name of Object.keys(kStrideFigures)) summary[side][name] = poolFigures(gaits.map((gait) => gait.summary[side][name]));
  }
  const cycles = new Map();
  for (const cycle of gaits.flatMap((gait) => gait.cycles)) {
    const key = `${cycle.joint} ${cycle.what} ${cycle.side}`;
    if (!cycles.has(key)) cycles.set(key, []);
    cycles.get(key).push(cycle);
  }
  return {summary, left_out: gaits.reduce((sum, gait) => sum + gait.left_out, 0),
    cycles: Array.from(cycles.values(), (of) => {
      const count = of.reduce((sum, one) => sum + one.strides, 0);
      const samples = Array.from({length: kCycleSamples}, (_, i) =>
        poolGroups(of.map(({mean, sd, strides}) => ({mean: mean[i], sd: sd[i], count: strides}))));
      const squares = (i) => of.reduce((sum, one) => sum + one.strides * knownNumber((one.uncertainty || [])[i]) ** 2, 0);
      return Object.assign({}, of[0], {mean: samples.map((one) => one.mean), sd: samples.map((one) => one.sd),
        uncertainty: Array.from({length: kCycleSamples}, (_, i) => Math.sqrt(squares(i) / count)),
        singles: of.flatMap((one) => one.singles || []), strides: count});
    })};
}

// Which colours and lines the charts have.
function makeGaitLegend(names) {
  const item = (colour, dash, text) => element("li", {}, lineSwatch(colour, dash), text);
  if (names.length < 2) return kSides.map((side) => item(kSideColours[side], kSideDashes[side], side));
  return [...kSides.map((side) => item("var(--text)", kSideDashes[side], side)),
    ...names.map((name, i) => item(`var(--converter-${i % kNumConverterColours})`, null, name))];
}

class GaitPart {
  constructor(view) {
    this.view = view;
    this.charts = [];
    byId("gait-singles").addEventListener("change", () => this.refresh());
    byId("gait-of").addEventListener("change", () => {
      this.show(this.view.trial);
      this.refresh();
    });
  }

  // Of every recording of the page that has strides.
  get gaits() {
    if (!this.found) {
      for (const section of this.view.sections) section.load();
      this.found = this.view.sections.flatMap((section) => section.trials)
        .flatMap((trial) => trial.ground && trial.ground.gait ? [trial.ground.gait] : []);
      const conditions = new Set(this.found.map((gait) => gait.condition));
      byId("gait-compared").hidden = conditions.size < 2;
      if (conditions.size > 1) byId("gait-of").value = "conditions";
    }
    return this.found;
  }

  // What is drawn: {name, gait, profile} of one condition, or of each.
  groups(trial) {
    const {gaits} = this;
    const own = trial.ground ? trial.ground.gait : null;
    const pool = (name, of) => ({name, gait: of.length > 1 ? poolGaits(of) : of[0], profile: poolProfiles(of.map((one) => one.profile))});
    const chosen = byId("gait-of").value;
    if (gaits.length === 0) return [];
    if (chosen === "conditions") {
      return Array.from(new Set(gaits.map((gait) => gait.condition)), (condition) =>
        pool(condition || "no condition", gaits.filter((gait) => gait.condition === condition)));
    }
    return [pool("", chosen === "own" && own ? [own] : gaits)];
  }

  show(trial) {
    const groups = this.groups(trial);
    byId("gait-choice").hidden = this.gaits.length < 2;
    byId("gait-part").hidden = byId("cycles-part").hidden = groups.length === 0;
    this.charts = [];
    if (groups.length === 0) return;
    const number = byId("gait-of").value === "own" ? 1 : this.gaits.length;
    byId("gait-caption").textContent = (number > 1 ? `Of ${number} recordings: ` : "") + groups.map(({name, gait}) =>
      (groups.length > 1 ? `${name}, ` : "") +
      `${plural(gait.summary.left.stride_time_s.strides, "stride")} of the left foot and ${gait.summary.right.stride_time_s.strides} of the right` +
      (gait.left_out > 0 ? `; ${gait.left_out} are left out, as a leg is hidden in them` : "")).join(". ") +
      ". Mean and one standard deviation (sd) among n strides.";
    replaceContent(byId("gait-table"), makeStrideTable(groups.map(({name, gait}) => ({name, summary: gait.summary}))));
    byId("gait-forces-notes").textContent = trial.ground ? trial.ground.noteText : "";
    const normal = this.gaits.map((one) => one.normal).find(Boolean) || null;
    showNormal(normal, groups);
    replaceContent(byId("gait-sides"), ...makeGaitLegend(groups.map(({name}) => name)));
    this.makeCharts(groups, normal);
  }

  // Cycles of a title from all groups, with their looks.
  cyclesOf(groups) {
    const titles = new Map();
    groups.forEach(({name, gait}, i) => {
      for (const cycle of gait.cycles) {
        const title = `${cycle.joint} ${cycle.what}`;
        if (!titles.has(title)) titles.set(title, []);
        const isAlone = groups.length === 1;
        titles.get(title).push({...cycle, name: isAlone ? cycle.side : `${cycle.side}, ${name}`,
          colour: isAlone ? kSideColours[cycle.side] : `var(--converter-${i % kNumConverterColours})`,
          footOff: knownNumber(gait.summary[cycle.side].foot_off_percent.mean)});
      }
    });
    return titles;
  }

  makeCharts(groups, normal) {
    const charts = new Map(Array.from(this.cyclesOf(groups), ([title, cycles]) => [title, new CycleChart(title, cycles,
      (normal ? normal.bands : []).filter((one) => `${one.joint} ${one.what}` === title))]));
    this.charts = Array.from(charts.values());
    const placed = new Set();
    const muscles = Array.from(charts.keys()).filter((title) => title.endsWith(" EMG"));
    const muscleGrid = Array.from({length: Math.ceil(muscles.length / 3)}, (_, i) => muscles.slice(3 * i, 3 * i + 3));
    for (const [kind, grid] of [["angles", kGrid], ["forces", kForceGrid], ["emg", muscleGrid]]) {
      const hosts = [];
      let row = 0;
      for (const titles of grid.filter((names) => names.some((title) => charts.has(title)))) {
        ++row;
        titles.forEach((title, column) => {
          if (!charts.has(title)) return;
          const {host} = charts.get(title);
          host.style.setProperty("--row", row);
          host.style.setProperty("--column", column + 1);
          placed.add(title);
          hosts.push(host);
        });
      }
      replaceContent(byId(`gait-${kind}-charts`), ...hosts);
      byId(`gait-${kind}`).hidden = hosts.length === 0;
    }
    this.showMore(this.charts.filter((chart) => !placed.has(chart.name)));
    byId("doubt-legend").hidden = !this.charts.some((chart) => chart.doubts.length);
  }

  showMore(charts) {
    const isTold = (chart) => !(chart.doubts.length && chart.doubts.every((cycle) => doubtOf(cycle) > kUntold));
    const untold = charts.filter((chart) => !isTold(chart)).map((chart) => chart.title);
    replaceContent(byId("gait-more-charts"), ...charts.filter(isTold).map((chart) => chart.host));
    byId("gait-untold").textContent = untold.length ? `Not drawn, as nothing in the recording tells them: ${untold.join(", ")}.` : "";
    byId("gait-more").hidden = charts.length === 0;
  }

  refresh() {
    const hasSingles = byId("gait-singles").checked;
    for (const chart of this.charts) chart.draw(hasSingles);
  }

  setFrame() {}
}
