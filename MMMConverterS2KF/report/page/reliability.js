// SPDX-License-Identifier: MIT
// How often the true joint angle is within what the standard deviations claim.

class ReliabilityPart {
  constructor(view) {
    this.view = view;
  }

  show() {
    const {figures, trials} = this.view.section;
    this.rows = rowsOfTrial(figures, trials.indexOf(this.view.trial))
      .map((row, contender) => ({row, contender}))
      .filter(({row}) => !row.failure && row.reliability);
    byId("reliability-part").hidden = this.rows.length === 0;
  }

  refresh() {
    if (this.rows.length === 0) return;
    const shown = this.rows.filter(({contender}) => this.view.shown.has(contender));
    replaceContent(byId("reliability-plot"), svgElement("svg",
      {viewBox: "0 0 320 300", role: "img", "aria-label": "Observed against claimed share of joint angles"},
      ...this.axes(), ...shown.map(({row, contender}) => this.curve(row, contender))));
  }

  x(share) { return 44 + 260 * share; }
  y(share) { return 262 - 250 * share; }

  axes() {
    const lines = [0, 0.2, 0.4, 0.6, 0.8, 1].flatMap((share) => [
      svgElement("line", {class: "grid", x1: this.x(0), x2: this.x(1), y1: this.y(share), y2: this.y(share)}),
      svgElement("text", {x: this.x(0) - 6, y: this.y(share) + 4, "text-anchor": "end"}, formatNumber(100 * share, 0)),
      svgElement("text", {x: this.x(share), y: this.y(0) + 16, "text-anchor": "middle"}, formatNumber(100 * share, 0))]);
    return [...lines,
      svgElement("line", {class: "right", x1: this.x(0), y1: this.y(0), x2: this.x(1), y2: this.y(1)}),
      svgElement("text", {x: this.x(0.5), y: 296, "text-anchor": "middle"}, "claimed, %"),
      svgElement("text", {x: 0, y: 0, "text-anchor": "middle",
        transform: `translate(12 ${this.y(0.5)}) rotate(-90)`}, "observed, %")];
  }

  curve(row, contender) {
    const points = row.reliability.map((one) => `${this.x(one.claimed)},${this.y(one.observed)}`);
    const line = svgElement("polyline", {class: "curve", points: [`${this.x(0)},${this.y(0)}`, ...points].join(" ")},
      svgElement("title", {}, row.contender));
    line.style.stroke = `var(--converter-${contender % kNumConverterColours})`;
    const dash = converterDash(contender);
    if (dash) line.setAttribute("stroke-dasharray", dash.join(" "));
    return line;
  }

  setFrame() {}
}
