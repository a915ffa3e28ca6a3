// SPDX-License-Identifier: MIT
// Angles of the last seconds, of the joint that is chosen on a small body.

const kShownSeconds = 10;
const kLongestLine = 0.3;  // [s] between two postures
const kSideLines = {left: "#c8553d", right: "#2a7f9e", "": "#6a56c8"};

class LiveAngles {
  constructor() {
    this.names = [];
    this.rows = [];
    this.charts = [];
  }

  // names: of the columns of postures' anatomy; none of an object.
  show(names) {
    this.names = names;
    this.rows = [];
    this.last = null;
    byId("angles-part").hidden = names.length === 0;
    const joints = new Map(names.map(({joint}) => [joint, joint]));
    replaceContent(byId("joint-picker"), makeJointPicker(joints, (joint) => this.choose(joint)));
    if (names.length > 0) this.choose(joints.has(this.joint) ? this.joint : "knee");
  }

  choose(joint) {
    this.joint = joint;
    for (const dot of byId("joint-picker").querySelectorAll("[data-joint]")) {
      dot.classList.toggle("chosen", dot.dataset.joint === joint);
    }
    for (const {graph} of this.charts) graph.destroy();
    const columns = this.names.map((name, column) => ({...name, column})).filter((name) => name.joint === joint);
    const motions = Array.from(new Set(columns.map(({motion}) => motion)));
    this.charts = motions.map((motion) => {
      const of = columns.filter((one) => one.motion === motion);
      const area = element("div", {class: "live-chart", role: "img", "aria-label": `${joint} ${motion}, degrees`});
      const value = element("span", {class: "muted"});
      return {of, area, value, heading: element("h3", {}, `${joint} ${motion} `, value)};
    });
    replaceContent(byId("angle-charts"), ...this.charts.flatMap(({heading, area}) => [heading, area]));
    for (const chart of this.charts) {
      chart.graph = new Dygraph(chart.area, this.rowsOf(chart), {
        labels: ["time", ...chart.of.map(({side}) => side || "middle")], colors: chart.of.map(({side}) => kSideLines[side]),
        legend: "never", strokeWidth: 1.8, interactionModel: {}, highlightCircleSize: 0, gridLineColor: themeColour("grid"),
        axisLineColor: themeColour("line"), gridLineWidth: 1, axisLabelFontSize: 11, xRangePad: 0,
        axes: {x: {axisLabelFormatter: (time) => `${time.toFixed(0)} s`}, y: {axisLabelWidth: 34, pixelsPerLabel: 24, ticker: twoTicks}},
      });
    }
  }

  // Without the jump by a turn where an angle passes half of one.
  take(posture) {
    if (!posture.tracking || !posture.anatomy) return;
    const {last} = this;
    if (last && posture.time < last.time) this.rows = [];
    // No line where nothing was known.
    else if (last && posture.time > last.time + kLongestLine) this.rows.push({time: last.time, values: last.values.map(() => NaN)});
    const turn = 2 * Math.PI;
    const values = posture.anatomy.map((value, i) =>
      last ? value - turn * Math.round((value - last.values[i]) / turn) : value);
    this.last = {time: posture.time, values};
    this.rows.push(this.last);
    let first = 0;
    while (this.rows[first].time < posture.time - kShownSeconds) ++first;
    if (first > 100) this.rows.splice(0, first);
  }

  rowsOf({of}) {
    if (this.rows.length === 0) return [[0, ...of.map(() => NaN)]];
    return this.rows.map(({time, values}) => [time, ...of.map(({column}) => values[column] * 180 / Math.PI)]);
  }

  refresh() {
    for (const chart of this.charts) {
      const rows = this.rowsOf(chart);
      const [end, ...now] = rows[rows.length - 1];
      chart.graph.updateOptions({file: rows, dateWindow: [end - kShownSeconds, end]});
      chart.value.textContent = chart.of.map(({side}, i) => `${side} ${formatNumber(now[i], 0)}°`).join(" · ");
    }
  }
}
