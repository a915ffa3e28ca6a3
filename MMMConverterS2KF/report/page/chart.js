// SPDX-License-Identifier: MIT
// A plot over time with a cursor at the player's frame. Zooming one zooms all.

// One line of a plot: {name, colour, dash, width, values, band, says}. values(k) is a number, band(k) [low, high];
// says(k) is what the readout has in place of the number; a line without a name is not in it.

class Chart {
  // host: an empty element. unit: for the readout. shades: [first, last] frames of spans that are shaded.
  constructor(host, view, {lines, unit, digits, logarithmic, range, label, shades, hasNoScale}) {
    this.host = host;
    this.view = view;
    // The library wants a line.
    this.lines = lines.length ? lines : [{name: null, colour: "transparent", values: () => NaN}];
    this.unit = unit;
    this.digits = digits;
    this.hasBands = this.lines.some((line) => line.band);
    this.plot = element("div", {class: "plot-area", role: "img", "aria-label": this.describe(label)});
    this.cursor = element("div", {class: "cursor"});
    this.readout = element("p", {class: "readout", "aria-hidden": "true"});
    this.label = label;
    this.paper = element("div", {class: "paper"});
    replaceContent(host, this.plot, this.readout, makePlotButtons(() => this.plotted()), this.paper);
    this.shown = {isLogarithmic: logarithmic || false, hasNoScale: hasNoScale || false};
    this.graph = new Dygraph(this.plot, this.rows(), this.options(logarithmic, range, shades || [], hasNoScale));
    this.plot.append(this.cursor);
    this.setFrame(view.frame);
    this.write(null);
    Chart.all.add(this);
  }

  // In words, for who does not see it.
  describe(label) {
    const told = this.lines.filter((line) => line.name && !line.says).map((line) => {
      const [least, most] = extremes([line], this.view.trial.frames);
      return least <= most ? `${line.name} from ${formatNumber(least, this.digits)} to ${formatNumber(most, this.digits)}` : `${line.name} unknown`;
    });
    return told.length ? `${label}: ${told.join(", ")}` : label;
  }

  rows() {
    const trial = this.view.trial;
    const rows = new Array(trial.frames);
    for (let k = 0; k < trial.frames; ++k) {
      const row = [trial.time(k)];
      for (const line of this.lines) {
        const value = line.values(k);
        row.push(this.hasBands ? line.band ? [line.band(k)[0], value, line.band(k)[1]] : [value, value, value]
          : value);
      }
      rows[k] = row;
    }
    return rows;
  }

  // As it is saved.
  plotted() {
    const {trial} = this.view;
    return {...this.shown, title: this.label, unit: this.unit, xName: "time [s]", lines: this.lines,
      xs: Array.from({length: trial.frames}, (_, k) => trial.time(k)),
      window: this.graph.xAxisRange(), range: this.graph.yAxisRange()};
  }

  // In place of the canvas, which paper would have as it was on the screen, if at all.
  print() {
    if (this.host.offsetParent === null) return;
    const isLow = this.host.classList.contains("low");
    replaceContent(this.paper, svgChart(this.plotted(), {width: 700, height: isLow ? 150 : 200, hasLegend: true}));
  }

  options(logarithmic, range, shades, hasNoScale) {
    const series = {};
    // Names of users never reach the library, which would take them for markup.
    this.lines.forEach((line, i) => {
      series["line" + i] = {color: line.colour, strokePattern: line.dash, strokeWidth: line.width || 1.6};
    });
    return {
      labels: ["time", ...this.lines.map((_, i) => "line" + i)], series, customBars: this.hasBands,
      legend: "never", fillAlpha: Math.max(0.07, 0.3 / this.lines.length), xlabel: "time, s", logscale: logarithmic || false,
      valueRange: range || null, includeZero: !logarithmic && !range,
      gridLineColor: themeColour("grid"), axisLineColor: themeColour("line"), gridLineWidth: 1,
      axisLabelFontSize: 12, xRangePad: 0, animatedZooms: false, highlightCircleSize: 3,
      axes: {y: Object.assign({axisLabelWidth: 46, ticker: twoTicks}, hasNoScale ? {drawGrid: false, axisLabelFormatter: () => ""} : {})},
      underlayCallback: (canvas, area, graph) => this.shade(shades, canvas, area, graph),
      interactionModel: withoutTouch(Dygraph.defaultInteractionModel),
      clickCallback: (event, x) => this.view.seek(this.view.trial.frameAt(x)),
      highlightCallback: (event, x) => this.write(this.view.trial.frameAt(x)),
      unhighlightCallback: () => this.write(null),
      drawCallback: (graph, isInitial) => {
        if (isInitial) return;
        this.placeCursor();
        this.view.zoom(this, graph.xAxisRange());
      },
    };
  }

  shade(spans, canvas, area, graph) {
    canvas.fillStyle = themeColour("shade");
    for (const [first, last] of spans) {
      const left = graph.toDomXCoord(this.view.trial.time(first));
      canvas.fillRect(left, area.y, graph.toDomXCoord(this.view.trial.time(last)) - left, area.h);
    }
  }

  // The values at a frame, or at the player's.
  write(frame) {
    const k = frame === null ? this.view.frame : frame;
    this.pointed = frame;
    const parts = this.lines.filter((line) => line.name).flatMap((line) => [
      element("span", {class: "value"}, lineSwatch(line.colour, line.dash),
        `${line.name} `, element("b", {}, line.says ? line.says(k) : formatNumber(line.values(k), this.digits)))]);
    replaceContent(this.readout,
      element("span", {class: "value"}, `${formatNumber(this.view.trial.time(k), 2)} s`), ...parts,
      element("span", {}, this.unit));
  }

  setFrame() {
    this.placeCursor();
    if (this.pointed === null || this.pointed === undefined) this.write(null);
  }

  placeCursor() {
    if (!this.graph) return;
    const x = this.graph.toDomXCoord(this.view.trial.time(this.view.frame));
    const area = this.graph.getArea();
    this.cursor.hidden = x < area.x - 1 || x > area.x + area.w + 1;
    this.cursor.style.transform = `translateX(${x}px)`;
    this.cursor.style.height = `${area.h}px`;
  }

  zoom(range) {
    this.graph.updateOptions({dateWindow: range});
  }

  destroy() {
    Chart.all.delete(this);
    this.graph.destroy();
    this.graph = null;
  }
}

Chart.all = new Set();  // that are in the page

// Before the page is laid out on paper its charts get pictures for it, in the colours of paper. Nothing may wait for the
// next frame of the screen, as there is none.
function drawOnPaper(view) {
  const isDark = () => matchMedia("(prefers-color-scheme: dark)").matches;
  window.addEventListener("beforeprint", () => {
    document.documentElement.classList.add("on-paper");
    for (const details of document.querySelectorAll("details")) details.open = true;
    if (isDark()) view.refresh();
    for (const chart of Chart.all) chart.print();
    if (view.print) view.print();
  });
  window.addEventListener("afterprint", () => {
    document.documentElement.classList.remove("on-paper");
    if (isDark()) view.refresh();
  });
}

// On a phone a finger scrolls the page; a tap still jumps.
function withoutTouch(model) {
  const mouseOnly = Object.assign({}, model);
  for (const name of ["touchstart", "touchmove", "touchend"]) delete mouseOnly[name];
  return mouseOnly;
}

// Least and largest value of lines, their bands left out.
function extremes(lines, frames) {
  let least = Infinity;
  let most = -Infinity;
  for (const line of lines) {
    for (let k = 0; k < frames; ++k) {
      const value = line.values(k);
      if (value < least) least = value;
      if (value > most) most = value;
    }
  }
  return [least, most];
}

function withMargin([least, most]) {
  if (!(least <= most)) return [0, 1];
  const margin = 0.06 * (most - least) || 1;
  return [least - margin, most + margin];
}

function coloured(index, name, values) {
  return {name, colour: converterColour(index), dash: converterDash(index), values};
}

function level(value) {
  return {name: null, colour: themeColour("muted"), dash: [8, 4], width: 1, values: () => value};
}
