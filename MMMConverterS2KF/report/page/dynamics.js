// SPDX-License-Identifier: MIT
// The page of a motion's dynamics: verdict, tables, charts with one cursor.

class DynamicsView {
  constructor(figures, series) {
    this.trial = series;
    this.flights = figures.flights.map((flight) => [flight.first_frame, flight.last_frame]);
    this.frame = 0;
    this.charts = [];
    byId("support-part").hidden = !series.outside_support.some((distance) => distance > 0);
    byId("joint-part").hidden = series.joints.length === 0;
    this.refresh();
  }

  // Colours have changed.
  refresh() {
    for (const chart of this.charts) chart.destroy();
    this.charts = describeCharts(this.trial).map(([host, options]) =>
      new Chart(byId(host), this, Object.assign({shades: this.flights}, options)));
  }

  seek(frame) {
    this.frame = Math.min(Math.max(Math.round(frame), 0), this.trial.frames - 1);
    for (const chart of this.charts) chart.setFrame(this.frame);
  }

  // A chart was zoomed to a range of time; the others follow.
  zoom(source, range) {
    if (this.zooming) return;
    this.zooming = true;
    for (const chart of this.charts) {
      if (chart !== source) chart.zoom(range);
    }
    this.zooming = false;
  }
}

function makeChecks(checks) {
  return makeTable("checks", "Checks", ["Check", "measured", "expected", "verdict"], checks.map((check) => [
    check.check, element("td", {}, check.measured), element("td", {}, check.expected),
    element("td", {}, element("span", {class: `judgement ${check.verdict.replace(" ", "-")}`}, check.verdict),
      check.reason ? element("span", {class: "reason"}, `: ${check.reason}`) : null)]));
}

function makeFlights(flights) {
  const sideways = ([x, y]) => Math.hypot(x, y);
  const number = (value, digits) => element("td", {}, formatNumber(value, digits));
  return makeTable("flights", "Flights",
    ["Flight", "falls, m/s²", "expected", "sideways, m/s²", "expected", "from a parabola, mm", "force, body weights",
      "expected", "angular momentum, kg m²/s", "varies by, %", "of all segments', %"],
    flights.map((flight) => [
      `${formatNumber(flight.first_s, 2)} to ${formatNumber(flight.last_s, 2)} s`,
      number(flight.acceleration_m_per_s2[2], 2), number(flight.expected_m_per_s2[2], 2),
      number(sideways(flight.acceleration_m_per_s2), 2), number(0, 0), number(1000 * flight.parabola_rms_m, 1),
      number(flight.mean_force_body_weights, 2), number(0, 0),
      number(Math.hypot(...flight.angular_momentum_kg_m2_per_s), 2),
      number(flight.angular_momentum_variation === null ? NaN : 100 * flight.angular_momentum_variation, 0),
      number(flight.angular_momentum_variation_of_segments === null ? NaN
        : 100 * flight.angular_momentum_variation_of_segments, 0)]));
}

function describeInput({input, mass_kg: mass, forces}) {
  const {person} = input;
  const who = person.height_m === null ? `Body (${person.height_source})`
    : `Person: ${formatNumber(person.height_m, 2)} m (${person.height_source})`;
  return `Motion “${input.motion}” of ${input.file}: ${plural(input.frames, "frame")} at ` +
    `${formatNumber(input.rate_hz, 0)} Hz. ${who}, ${formatNumber(mass, 1)} kg (${person.mass_source}), ` +
    `weight ${formatNumber(forces.body_weight_n, 0)} N. Model: ${input.model}.`;
}

function describeDerivatives(derivatives) {
  const made = `the force of the ground reaches ${formatNumber(derivatives.force_peak_body_weights, 1)} body weights`;
  if (derivatives.source === "motion") return `Velocities and accelerations are those of the motion: ${made}.`;
  if (derivatives.low_pass_hz === null) return `The motion is differentiated as it is: ${made}.`;
  return `The motion is differentiated after a low-pass at ${formatNumber(derivatives.low_pass_hz, 1)} Hz` +
    (derivatives.low_pass_lowered ? ", all that its rate allows" : "") + `: ${made}; without it, ` +
    `${formatNumber(derivatives.unfiltered_force_peak_body_weights, 1)}.`;
}

function start() {
  const figures = readBlock("figures");
  byId("program").textContent = figures.program;
  byId("sentence").textContent = figures.sentence;
  byId("about").textContent = describeInput(figures);
  byId("derivatives").textContent = describeDerivatives(figures.derivatives);
  replaceContent(byId("checks"), makeChecks(figures.checks));
  byId("flight-part").hidden = figures.flights.length === 0;
  replaceContent(byId("flights"), makeFlights(figures.flights));
  showNotes(figures.warnings);
  const view = new DynamicsView(figures, new Series(readBlock("series")));
  redrawWithColours(view);
  drawOnPaper(view);
  // For tests, and for who looks at the data in the browser's console.
  window.mmmReport = {
    figures,
    get frame() { return view.frame; },
    get frames() { return view.trial.frames; },
    seek: (frame) => view.seek(frame),
  };
  markReady();
}

start();
