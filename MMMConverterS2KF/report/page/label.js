// SPDX-License-Identifier: MIT
// The page of a recording's labels: what was changed, the points under their names and the track of a marker, before
// and after.

const kMostRows = 500;

class LabelView {
  constructor(figures, trial) {
    this.figures = figures;
    this.trial = trial;
    this.frame = 0;
    this.charts = [];
    this.shown = new Set(trial.tracks.map((track) => track.contender));
    const change = figures.changes.find(({to}) => trial.names.some((one) => one.name === to));
    this.name = change ? change.to : trial.names.length > 0 ? trial.names[0].name : null;
    if (change) this.frame = trial.drawn(change.first_frame);
    byId("player-part").hidden = trial.names.length === 0;
    if (trial.names.length > 0) {
      this.player = new Player(this);
      this.player.show(trial);
      byId("residuals-option").hidden = byId("marker-legend").hidden = true;
    }
    this.refresh();
  }

  get recordedFrames() {
    return this.figures.frames;
  }

  describe(frame) {
    const changed = this.trial.names.filter((_, label) => this.trial.isChanged(label, frame)).map((one) => one.name);
    return [changed.length > 0 ? `${this.figures.repair ? "changed" : "newly named"}: ${changed.join(", ")}` : ""];
  }

  track() {
    return this.trial.names.find((one) => one.name === this.name);
  }

  show(name, frame) {
    this.name = name;
    byId("name").value = name;
    this.refresh();
    this.seek(frame);
  }

  // Another marker, or colours have changed.
  refresh() {
    for (const chart of this.charts) chart.destroy();
    this.charts = [];
    const track = this.track();
    if (track === undefined) return;
    this.trial.chosen = track.name;
    this.player.refresh();
    const shades = this.figures.changes.filter((change) => change.to === track.name)
      .map((change) => [this.trial.drawn(change.first_frame), this.trial.drawn(change.last_frame)]);
    this.charts = ["x", "y", "z"].map((axis, i) => {
      const values = (which) => (k) => track[which][i * this.trial.frames + k];
      const lines = [{name: this.trial.words.after, colour: converterColour(0), dash: null, values: values("after")}];
      if (track.hasBefore) {
        lines.push({name: this.trial.words.before, colour: converterColour(1), dash: [4, 4], values: values("before")});
      }
      return new Chart(byId(`${axis}-plot`), this, {lines, shades, unit: "m", digits: 3,
        range: withMargin(extremes(lines, this.trial.frames)), label: `${axis} over time, metres`});
    });
    this.seek(this.frame);
  }

  seek(frame) {
    this.frame = Math.min(Math.max(Math.round(frame), 0), this.trial.frames - 1);
    if (this.player) this.player.setFrame(this.frame);
    for (const chart of this.charts) chart.setFrame(this.frame);
  }

  zoom(source, range) {
    if (this.zooming) return;
    this.zooming = true;
    for (const chart of this.charts) {
      if (chart !== source) chart.zoom(range);
    }
    this.zooming = false;
  }
}

function makeChanges(changes, view) {
  const heads = [view.figures.repair ? "Label" : "Point", "is", "frames", "seconds", "probability"];
  const rows = changes.slice(0, kMostRows).map((change) => {
    const shown = [change.to, change.from].find((name) => view.trial.names.some((one) => one.name === name));
    const button = element("button", {type: "button", disabled: shown === undefined}, change.from);
    button.addEventListener("click", () => view.show(shown, view.trial.drawn(change.first_frame)));
    return element("tr", {},
      element("th", {scope: "row"}, button),
      element("td", {}, change.to === null ? "none of the markers" : change.to),
      element("td", {}, `${change.first_frame} to ${change.last_frame}`),
      element("td", {}, `${formatNumber(change.first_s, 2)} to ${formatNumber(change.last_s, 2)}`),
      element("td", {}, formatNumber(change.probability, 3)));
  });
  const table = element("table", {class: "figures changes"},
    element("caption", {class: "unseen"}, byId("change-heading").textContent),
    element("thead", {}, element("tr", {}, ...heads.map((head) => element("th", {scope: "col"}, head)))),
    element("tbody", {}, ...rows));
  const more = changes.length - rows.length;
  return [element("div", {class: "wide", tabindex: "0", role: "region", "aria-label": byId("change-heading").textContent}, table),
    more > 0 ? element("p", {class: "caption"}, `And ${more} more, which the summary (JSON) has.`) : null];
}

// Of a repair there are labels before and after it; points without labels got names.
function chooseWords(isRepair) {
  for (const one of document.querySelectorAll(isRepair ? ".of-names" : ".of-repair")) one.hidden = true;
  if (isRepair) return;
  byId("player-heading").textContent = "Points under the names that were found";
  byId("change-heading").textContent = "Which points got which names";
}

function start() {
  const figures = readBlock("figures");
  chooseWords(figures.repair);
  byId("program").textContent = figures.program;
  byId("sentence").textContent = figures.sentence;
  byId("about").textContent = `${figures.input.file}: ${plural(figures.frames, "frame")} at ` +
    `${formatNumber(figures.rate_hz, 0)} Hz, ${plural(figures.input.points, "point")}. ` +
    (figures.output === null ? "Nothing was written." : `Written to ${figures.output}.`);
  const view = new LabelView(figures, new LabelTrial(readBlock("tracks"), figures.repair));
  replaceContent(byId("name"), ...view.trial.names.map((one) => option(one.name, one.name)));
  byId("name").value = view.name;
  byId("name").addEventListener("change", (event) => view.show(event.target.value, view.frame));
  byId("no-change").hidden = figures.changes.length > 0;
  if (figures.changes.length > 0) replaceContent(byId("changes"), ...makeChanges(figures.changes, view));
  showNotes(figures.warnings);
  redrawWithColours(view);
  drawOnPaper(view);
  // For tests, and for who looks at the data in the browser's console.
  window.mmmReport = {
    figures,
    get name() { return view.name; },
    get frame() { return view.frame; },
    // Crosses of what was changed in this frame, and ends of sticks: after it, and before.
    get drawn() {
      return view.trial.tracks.map((track) => {
        const one = track.makeFigure(makeSigns());
        one.setFrame(view.frame);
        return {name: one.track.name, crosses: one.crosses.count, ends: one.lines.count};
      });
    },
    seek: (frame) => view.seek(frame),
  };
  markReady();
}

start();
