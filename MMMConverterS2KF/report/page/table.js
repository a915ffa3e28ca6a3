// SPDX-License-Identifier: MIT
// The table of figures: converters below each other for each recording.

class FiguresTable {
  constructor(section) {
    this.figures = section.figures;
    // Columns in which no row has a number are left out.
    this.columns = kFigures.filter((figure) =>
      this.figures.rows.some((row) => figureOf(row, figure.path) !== null));
  }

  make() {
    const table = element("table", {class: "figures"},
      element("caption", {class: "unseen"}, "Figures of each converter on each recording"),
      element("thead", {}, this.groupRow(), this.nameRow()));
    this.figures.trials.forEach((trial, i) => table.append(this.trialBody(trial, rowsOfTrial(this.figures, i))));
    return element("div", {class: "wide", tabindex: "0", role: "region",
      "aria-label": "Table of figures, scrolls sideways"}, table);
  }

  groupRow() {
    const row = element("tr", {}, element("td", {}));
    for (let i = 0; i < this.columns.length;) {
      const group = this.columns[i].group;
      const span = this.columns.filter((figure) => figure.group === group).length;
      row.append(element("th", {scope: "colgroup", colspan: span, class: "group"}, group));
      i += span;
    }
    return row;
  }

  nameRow() {
    return element("tr", {}, element("th", {scope: "col"}, "Converter"),
      ...this.columns.map((figure) => element("th",
        {scope: "col", title: figure.says || null, class: this.edge(figure)}, figure.name)));
  }

  // The first column of each group has a line on its left.
  edge(figure) {
    const first = this.columns.find((other) => other.group === figure.group);
    return first === figure ? "edge" : null;
  }

  trialBody(trial, rows) {
    const whole = rows.filter((row) => !row.failure);
    const about = trial.failure ? "" : [
      plural(trial.frames, "frame") + ` at ${formatNumber(trial.rate_hz, 0)} Hz`,
      plural(trial.compared_markers, "marker"), plural(trial.compared_joints, "joint"),
      `optimum ${formatNumber(trial.optimum_mm, 2)} mm`].join(" · ");
    return element("tbody", {},
      element("tr", {class: "trial"}, element("th", {scope: "rowgroup", colspan: this.columns.length + 1},
        element("span", {class: "stay"}, trial.name + " ", element("span", {class: "muted"}, about)))),
      ...rows.map((row, i) => row.failure ? this.failedRow(row, i) : this.row(row, i, whole)));
  }

  row(row, contender, rows) {
    const cells = this.columns.map((figure) => {
      const best = isBest(row, rows, figure);
      const classes = [this.edge(figure), best ? "best" : null].filter(Boolean).join(" ");
      return element("td", {class: classes || null, "data-figure": figure.path,
        title: String(figureOf(row, figure.path))}, shownFigure(row, figure),
      best ? element("span", {class: "unseen"}, " (best)") : null);
    });
    return element("tr", {"data-trial": row.trial, "data-contender": row.contender},
      this.rowHead(row, contender), ...cells);
  }

  failedRow(row, contender) {
    return element("tr", {class: "failed", "data-trial": row.trial, "data-contender": row.contender},
      this.rowHead(row, contender),
      element("td", {colspan: Math.max(1, this.columns.length)},
        element("span", {class: "stay reason"}, element("strong", {}, "failed: "), row.failure)));
  }

  rowHead(row, contender) {
    return element("th", {scope: "row"},
      element("span", {class: "row-name"}, converterSwatch(contender), element("span", {}, ...breakable(row.contender))));
  }

  makeExplanation() {
    const terms = this.columns.filter((figure) => figure.says).flatMap((figure) => [
      element("dt", {}, `${figure.group}: ${figure.name}`), element("dd", {}, figure.says)]);
    return element("details", {class: "explanation"},
      element("summary", {}, "What the figures mean"),
      element("dl", {}, ...terms,
        element("dt", {}, "Bold, with a dot"), element("dd", {}, "The best of its recording."),
        element("dt", {}, "Optimum"), element("dd", {},
          "The mean distance at the least-squares posture of each frame on its own, all markers seen: " +
          "what a tracker can reach in marker distance. It says nothing of hidden markers or of joints.")));
  }
}

// What was done, in words.
function describeOptions(options) {
  const parts = [];
  if (options.hide > 0) {
    parts.push(options.hiding_model === "stationary"
      ? `${formatNumber(100 * options.hide, 1)} % of the markers hidden at any time`
      : `each visible marker hides with ${formatNumber(100 * options.hide, 2)} % a frame`,
    `for ${formatNumber(options.mean_hidden_frames, 0)} frames on average`);
  }
  if (options.runs > 1) parts.push(plural(options.runs, "run"));
  if (options.hide > 0) parts.push(`seed ${options.seed}`);
  const text = parts.join(", ");
  return text && text[0].toUpperCase() + text.slice(1) + ".";
}

// isOnly: the page's title says already what it is.
function makeSummary(section, isOnly) {
  const table = new FiguresTable(section);
  const paragraphs = section.text.split(/\n\s*\n/).filter((text) => text.trim());
  const options = describeOptions(section.figures.options);
  return element("article", {class: "summary"},
    section.title && !isOnly ? element("h2", {}, section.title) : null,
    element("p", {class: "verdict"}, verdictOf(section.figures)),
    ...paragraphs.map((text) => element("p", {}, text)),
    options ? element("p", {class: "muted"}, options) : null,
    table.make(), table.makeExplanation());
}
