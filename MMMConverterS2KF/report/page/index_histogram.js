// SPDX-License-Identifier: MIT
// How a figure is distributed over the entries, as bars that filter the table.

const kDistributions = [
  {key: "mean", title: "Mean marker distance", unit: "mm", digits: 2, values: (entries) => entries.numbers("distance_mm.mean")},
  {key: "p95", title: "95 % marker distance", unit: "mm", digits: 1, values: (entries) => entries.numbers("distance_mm.p95")},
  {key: "not-converged", title: "Frames not converged", unit: "%", digits: 1, values: shareNotConverged},
  {key: "time", title: "Median time of a frame", unit: "ms", digits: 3, values: (entries) => entries.numbers("ms_per_frame.median")},
];
const kBars = 25;  // at most; as many as suit a step of 1, 2 or 5

// The least of 1, 2, 5, 10, ... that is not less.
function niceStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= least * (1 - 1e-9)) || 10 * power;
}

// Value at a share of sorted numbers.
function quantileOf(sorted, share) {
  return sorted[Math.floor(share * (sorted.length - 1))];
}

// Bars of equal width; where a few values lie far out, the last bar is open.
class Bins {
  constructor(sorted) {
    const low = sorted[0];
    const high = sorted[sorted.length - 1];
    const most = quantileOf(sorted, 0.99);
    const isOpen = most > low && high - low > 2 * (most - low);
    const end = isOpen ? most : high;
    // Of halves, as the difference may not be finite.
    const span = 2 * (end / 2 - low / 2);
    this.step = niceStep(Math.min(1e300, span > 0 ? span / kBars : Math.abs(low) / kBars || 1));
    this.first = Math.floor(low / this.step + 1e-9);
    this.count = Math.max(1, Math.min(2 * kBars, this.place(end) - this.first + 1)) + (isOpen ? 1 : 0);
    this.isOpen = isOpen;
    this.digits = Math.min(12, Math.max(0, -Math.floor(Math.log10(this.step) + 1e-9)));
  }

  place(value) {
    return Math.floor(value / this.step + 1e-9);
  }

  // The bar of a value; -1 for NaN.
  of(value) {
    if (!Number.isFinite(value)) return -1;
    return Math.max(0, Math.min(this.count - 1, this.place(value) - this.first));
  }

  edge(bar) {
    const value = (this.first + bar) * this.step;
    return Math.abs(value) < 1e6 ? formatNumber(value, this.digits) : value.toPrecision(3);
  }

  describe(bar, unit) {
    return this.isOpen && bar === this.count - 1 ? `${this.edge(bar)} ${unit} or more`
      : `${this.edge(bar)} to ${this.edge(bar + 1)} ${unit}`;
  }
}

// Of the picture, in its own units.
const kWidth = 250;
const kHeight = 160;
const kPlot = {left: 40, right: 240, top: 8, bottom: 120};

// onChosen(distribution, bar or null): whose entries are to be shown.
class Histogram {
  constructor(distribution, values, onChosen) {
    this.distribution = distribution;
    this.values = values;
    this.onChosen = onChosen;
    this.chosen = null;
    const sorted = values.filter(Number.isFinite).sort();
    this.bins = new Bins(sorted);
    this.counts = new Array(this.bins.count).fill(0);
    for (const value of sorted) ++this.counts[this.bins.of(value)];
    const atMost = (share) => sorted[Math.max(0, Math.ceil(share * sorted.length) - 1)];
    const shown = (share) => `${formatNumber(atMost(share), distribution.digits)}\u00a0${distribution.unit}`;
    this.about = `Median ${shown(0.5)}, 95 of 100 at most ${shown(0.95)}`;
  }

  make() {
    const {title, unit} = this.distribution;
    this.top = Math.max(2, 2 * niceStep(Math.max(...this.counts) / 2));
    this.readout = element("figcaption", {class: "readout"}, this.about);
    this.bars = this.counts.map((count, bar) => this.bar(bar, count));
    this.bars[0].setAttribute("tabindex", "0");
    const group = svgElement("g", {role: "toolbar", "aria-label": `${title}: bars`}, ...this.bars);
    group.addEventListener("keydown", (event) => this.onKey(event));
    for (const type of ["mouseleave", "focusout"]) group.addEventListener(type, () => this.tell(null));
    const svg = svgElement("svg", {viewBox: `0 0 ${kWidth} ${kHeight}`, role: "group", "aria-label": title},
      ...this.heights(), ...this.edges(), group, svgElement("text", {class: "axis", x: (kPlot.left + kPlot.right) / 2,
        y: kHeight - 6, "text-anchor": "middle"}, `${title.toLowerCase()}, ${unit}`),
      svgElement("text", {class: "axis", "text-anchor": "middle",
        transform: `translate(9 ${(kPlot.top + kPlot.bottom) / 2}) rotate(-90)`}, "entries"));
    return element("figure", {class: "distribution", "data-key": this.distribution.key},
      element("h3", {}, title), svg, this.readout);
  }

  x(bar) {
    return kPlot.left + bar * (kPlot.right - kPlot.left) / this.bins.count;
  }

  y(count) {
    return kPlot.bottom - count / this.top * (kPlot.bottom - kPlot.top);
  }

  heights() {
    return [0, this.top / 2, this.top].flatMap((count) => [
      svgElement("line", {class: "line", x1: kPlot.left, x2: kPlot.right, y1: this.y(count), y2: this.y(count)}),
      svgElement("text", {x: kPlot.left - 4, y: this.y(count) + 3.5, "text-anchor": "end"},
        count < 1e4 ? String(count) : `${count / 1000}k`)]);
  }

  // Numbers under some edges of bars, as many as have room, and where the open bar begins.
  edges() {
    const {count, isOpen} = this.bins;
    const last = isOpen ? count - 1 : count;
    const edges = Array.from({length: last + 1}, (_, bar) => this.bins.edge(bar));
    const every = Math.ceil(Math.max(...edges.map((edge) => edge.length + 2)) * 6 * count / (kPlot.right - kPlot.left));
    return edges
      .map((edge, bar) => ({bar, text: isOpen && bar === last ? "≥ " + edge : edge}))
      .filter(({bar}) => isOpen ? bar === last || (bar % every === 0 && last - bar >= every) : bar % every === 0)
      .map(({bar, text}) => svgElement("text",
        {x: this.x(bar), y: kPlot.bottom + 14, "text-anchor": "middle"}, text));
  }

  bar(bar, count) {
    const says = `${this.bins.describe(bar, this.distribution.unit)}: ${countOf(count, "entry", "entries")}`;
    const width = this.x(bar + 1) - this.x(bar);
    // Few among many are to be seen too.
    const height = count > 0 ? Math.max(1.5, kPlot.bottom - this.y(count)) : 0;
    const group = svgElement("g", {class: "bar", role: "button", tabindex: "-1", "aria-pressed": "false",
      "aria-label": says},
    svgElement("rect", {class: "reach", x: this.x(bar), y: kPlot.top, width, height: kPlot.bottom - kPlot.top}),
    svgElement("rect", {class: "filled", x: this.x(bar) + 0.5, y: kPlot.bottom - height,
      width: Math.max(0.5, width - 1), height}));
    group.addEventListener("click", () => this.choose(bar));
    for (const type of ["mouseenter", "focus"]) group.addEventListener(type, () => this.tell(says));
    return group;
  }

  tell(text) {
    this.readout.textContent = text || this.about;
  }

  choose(bar) {
    this.onChosen(this, bar === this.chosen ? null : bar);
  }

  // Shows which bar filters the table; null: none.
  mark(bar) {
    this.chosen = bar;
    this.bars.forEach((group, i) => group.setAttribute("aria-pressed", i === bar));
  }

  onKey(event) {
    const at = this.bars.indexOf(event.target);
    const last = this.bars.length - 1;
    const next = {ArrowLeft: at - 1, ArrowRight: at + 1, Home: 0, End: last}[event.key];
    if (event.key === "Enter" || event.key === " ") {
      this.choose(at);
    } else if (next !== undefined) {
      const bar = this.bars[Math.max(0, Math.min(last, next))];
      this.bars[at].setAttribute("tabindex", "-1");
      bar.setAttribute("tabindex", "0");
      bar.focus();
    } else {
      return;
    }
    event.preventDefault();
  }
}
