// SPDX-License-Identifier: MIT
// Strides: their figures, and angles, forces and moments over the gait cycle, left over right.

// Figures of strides by the names that files have for them: title, unit, decimals.
const kStrideFigures = {
  cadence_steps_per_min: ["Cadence", "steps/min", 1],
  speed_m_per_s: ["Speed", "m/s", 2],
  stride_time_s: ["Stride time", "s", 3],
  stride_length_m: ["Stride length", "m", 3],
  step_time_s: ["Step time", "s", 3],
  step_length_m: ["Step length", "m", 3],
  step_width_m: ["Step width", "m", 3],
  foot_off_percent: ["Foot off", "% of the cycle", 1],
};
const kLegJoints = ["ground", "pelvis", "hip", "knee", "ankle", "residual"];
const kCycleSamples = 101;

function makeStrideTable(summary) {
  const cell = ({mean, sd, strides}, digits) => element("td", {},
    mean === null ? "–" : formatNumber(mean, digits) + (sd === null ? "" : ` ± ${formatNumber(sd, digits)}`) + ` (${strides})`);
  const rows = Object.entries(kStrideFigures).map(([name, [title, unit, digits]]) => element("tr", {},
    element("th", {scope: "row"}, title), cell(summary.left[name], digits), cell(summary.right[name], digits),
    element("td", {class: "muted"}, unit)));
  return makePersonTable("Figures of strides", ["", "left", "right", ""], rows);
}

// Left and right of one angle, force or moment over the cycle.
class CycleChart {
  constructor(title, cycles, footOff) {
    this.title = title;
    this.cycles = cycles;
    this.footOff = footOff;
    this.unit = cycles[0].unit;
    this.area = element("div", {class: "cycle-area", role: "img",
      "aria-label": `${title} over the gait cycle, ${this.unit}`});
    this.host = element("figure", {class: "cycle"},
      element("figcaption", {}, element("b", {}, title), ` ${this.unit.replaceAll(" ", "\u00a0")}`), this.area,
      makePlotButtons(() => this.plotted()));
  }

  // As it is saved.
  plotted() {
    const number = (value) => value === null ? NaN : value;
    const lines = this.cycles.map(({side, mean, sd}) => ({name: side, colour: kSideColours[side],
      values: (i) => number(mean[i]), band: (i) => [mean[i] - number(sd[i]), mean[i] + number(sd[i])]}));
    return {graph: this.graph, title: `${this.title} over the gait cycle, ${this.unit}`, unit: this.unit,
      xName: "gait cycle [%]", xs: Array.from({length: kCycleSamples}, (_, i) => i), lines};
  }

  destroy() {
    if (this.graph) this.graph.destroy();
    this.graph = null;
  }

  // Once it is in the page.
  draw() {
    if (this.graph) this.graph.destroy();
    const rows = Array.from({length: kCycleSamples}, (_, i) => [i, ...this.cycles.map(({mean, sd}) => {
      const number = (value) => value === null ? NaN : value;
      const band = sd[i] === null ? 0 : sd[i];
      return [number(mean[i]) - band, number(mean[i]), number(mean[i]) + band];
    })]);
    const series = {};
    this.cycles.forEach((cycle, i) => { series["line" + i] = {color: kSideColours[cycle.side]}; });
    this.graph = new Dygraph(this.area, rows, {
      labels: ["percent", ...this.cycles.map((_, i) => "line" + i)], series, customBars: true, legend: "never",
      fillAlpha: 0.15, strokeWidth: 1.8, interactionModel: {}, highlightCircleSize: 0,
      gridLineColor: themeColour("grid"), axisLineColor: themeColour("line"), gridLineWidth: 1, axisLabelFontSize: 11,
      xRangePad: 0, valueRange: this.range(rows),
      axes: {x: {axisLabelFormatter: (percent) => `${percent} %`, pixelsPerLabel: 50},
        y: {axisLabelWidth: 34, pixelsPerLabel: 26, ticker: twoTicks}},
      underlayCallback: (canvas, area, graph) => this.drawFootOff(canvas, area, graph),
    });
  }

  range(rows) {
    const values = rows.flatMap((row) => row.slice(1).flat()).filter(Number.isFinite);
    return withMargin([values.reduce((a, b) => Math.min(a, b), Infinity), values.reduce((a, b) => Math.max(a, b), -Infinity)]);
  }

  drawFootOff(canvas, area, graph) {
    if (graph.yAxisRange()[0] < 0 && graph.yAxisRange()[1] > 0) {
      canvas.fillStyle = themeColour("line");
      canvas.fillRect(area.x, graph.toDomYCoord(0) - 0.5, area.w, 1);
    }
    for (const {side} of this.cycles) {
      const percent = this.footOff[side];
      if (percent === null) continue;
      canvas.fillStyle = kSideColours[side];
      for (let y = area.y; y < area.y + area.h; y += 8) canvas.fillRect(graph.toDomXCoord(percent) - 0.5, y, 1, 4);
    }
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

// Strides of several recordings as if they were of one.
function poolGaits(gaits) {
  const summary = {};
  for (const side of ["left", "right"]) {
    summary[side] = {};
    for (const name of Object.keys(kStrideFigures)) {
      const {mean, sd, count} = poolGroups(gaits.map((gait) => gait.summary[side][name])
        .map((one) => ({mean: one.mean, sd: one.sd, count: one.strides})));
      summary[side][name] = {mean, sd, strides: count};
    }
  }
  const cycles = new Map();
  for (const cycle of gaits.flatMap((gait) => gait.cycles)) {
    const key = `${cycle.joint} ${cycle.what} ${cycle.side}`;
    if (!cycles.has(key)) cycles.set(key, []);
    cycles.get(key).push(cycle);
  }
  return {summary, left_out: gaits.reduce((sum, gait) => sum + gait.left_out, 0),
    cycles: Array.from(cycles.values(), (of) => {
      const samples = Array.from({length: kCycleSamples}, (_, i) =>
        poolGroups(of.map(({mean, sd, strides}) => ({mean: mean[i], sd: sd[i], count: strides}))));
      return Object.assign({}, of[0], {mean: samples.map((one) => one.mean), sd: samples.map((one) => one.sd),
        strides: of.reduce((sum, one) => sum + one.strides, 0)});
    })};
}

class GaitPart {
  constructor(view) {
    this.view = view;
    this.charts = [];
    byId("gait-more").addEventListener("toggle", () => this.refresh());
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
    }
    return this.found;
  }

  show(trial) {
    const {gaits} = this;
    const own = trial.ground ? trial.ground.gait : null;
    byId("gait-choice").hidden = gaits.length < 2;
    const isOfAll = gaits.length > 1 && (byId("gait-of").value === "all" || !own);
    const gait = isOfAll ? poolGaits(gaits) : own;
    byId("gait-part").hidden = !gait;
    for (const chart of this.charts) chart.destroy();
    this.charts = [];
    if (!gait) return;
    const footOff = {left: gait.summary.left.foot_off_percent.mean, right: gait.summary.right.foot_off_percent.mean};
    const count = (side) => gait.summary[side].stride_time_s.strides;
    byId("gait-caption").textContent = (isOfAll ? `Of ${gaits.length} recordings: ` : "") +
      `${plural(count("left"), "stride")} of the left foot and ${count("right")} of the right` +
      (gait.left_out > 0 ? `; ${gait.left_out} are left out, as a leg is hidden in them` : "") +
      ". Mean ± one standard deviation among the strides, and how many tell it.";
    replaceContent(byId("gait-table"), makeStrideTable(gait.summary));
    const titles = new Map();
    for (const cycle of gait.cycles) {
      const title = `${cycle.joint} ${cycle.what}`;
      if (!titles.has(title)) titles.set(title, []);
      titles.get(title).push(cycle);
    }
    for (const [title, cycles] of titles) {
      const chart = new CycleChart(title === "ground vertical force" ? "vertical force" : title, cycles, footOff);
      chart.kind = !kLegJoints.includes(cycles[0].joint) ? "more" : cycles[0].unit === "°" ? "angles" : "forces";
      this.charts.push(chart);
    }
    for (const kind of ["forces", "angles", "more"]) {
      const charts = this.charts.filter((chart) => chart.kind === kind);
      replaceContent(byId(`gait-${kind}-charts`), ...charts.map((chart) => chart.host));
      byId(`gait-${kind}`).hidden = charts.length === 0;
    }
  }

  refresh() {
    for (const chart of this.charts) {
      if (chart.kind !== "more" || byId("gait-more").open) chart.draw();
    }
  }

  setFrame() {}
}
