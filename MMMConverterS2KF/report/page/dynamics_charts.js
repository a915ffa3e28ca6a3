// SPDX-License-Identifier: MIT
// The dynamics of a motion over time: series, and the charts of them. SI units.

class Series {
  constructor(json) {
    this.frames = json.frames;
    this.rate = json.rate;
    this.firstTime = json.first_time;
    for (const name of ["vertical_force", "horizontal_force", "height", "acceleration", "angular_momentum",
      "outside_support"]) lazily(this, name, json[name]);
    this.contacts = json.contacts.map((body) => ({name: body.name, touches: unpack(body.touches)}));
    this.joints = json.joints.map((joint) =>
      ({name: joint.name, torque: unpack(joint.torque), power: unpack(joint.power)}));
  }

  time(frame) {
    return this.firstTime + frame / this.rate;
  }

  frameAt(time) {
    return Math.min(Math.max(Math.round((time - this.firstTime) * this.rate), 0), this.frames - 1);
  }

  // A component of a vector over time.
  component(name, axis) {
    return (k) => this[name][axis * this.frames + k];
  }
}

const kAxes = ["x", "y", "z"];

// [host, options of a chart] of each chart.
function describeCharts(series) {
  const charts = [
    ["force-plot", {lines: [level(1), coloured(0, "vertical", (k) => series.vertical_force[k]),
      coloured(1, "horizontal", (k) => series.horizontal_force[k])],
    unit: "body weights", digits: 2, label: "Force of the ground over time, body weights"}],
    ["contact-plot", contactChart(series)],
    ["height-plot", {lines: [coloured(0, "height", (k) => series.height[k])], unit: "m", digits: 3,
      range: withMargin(extremes([{values: (k) => series.height[k]}], series.frames)),
      label: "Height of the centre of mass over time, metres"}],
    ["acceleration-plot", {lines: [level(-9.81), ...kAxes.map((axis, i) =>
      coloured(i, axis, series.component("acceleration", i)))],
    unit: "m/s²", digits: 2, label: "Acceleration of the centre of mass over time, metres per second squared"}],
    ["momentum-plot", {lines: kAxes.map((axis, i) => coloured(i, axis, series.component("angular_momentum", i))),
      unit: "kg m²/s", digits: 2, label: "Angular momentum over time"}],
  ];
  if (series.outside_support.some((distance) => distance > 0)) {
    charts.push(["support-plot", {lines: [coloured(0, "outside", (k) => 1000 * series.outside_support[k])],
      unit: "mm", digits: 0, label: "Distance of the centre of pressure from the support over time, millimetres"}]);
  }
  if (series.joints.length > 0) {
    for (const [host, name, unit, digits] of [["torque-plot", "torque", "N m", 1], ["power-plot", "power", "W", 0]]) {
      charts.push([host, {lines: series.joints.map((joint, i) => coloured(i, joint.name, (k) => joint[name][k])),
        unit, digits, label: `Joint ${name} over time`}]);
    }
  }
  return charts;
}

// A broad line for each part of the body while it touches the ground.
function contactChart(series) {
  const count = series.contacts.length;
  return {lines: series.contacts.map((body, i) => ({name: body.name, colour: converterColour(i), width: 9,
    values: (k) => body.touches[k] ? count - i : NaN, says: (k) => body.touches[k] ? "touches" : "–"})),
  unit: "", digits: 0, range: [0.4, count + 0.6], hasNoScale: true, label: "What touches the ground over time"};
}
