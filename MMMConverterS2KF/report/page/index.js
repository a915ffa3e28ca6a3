// SPDX-License-Identifier: MIT
// The index of a batch: which entries are shown, and who is told when that changes.

const kShows = {
  "all": () => true,
  "converted": (entries, entry) => entries.converted[entry] === 1,
  "not-converted": (entries, entry) => entries.converted[entry] === 0,
  "warnings": (entries, entry) => entries.warnings(entry).length > 0,
};

class Index {
  constructor(entries) {
    this.entries = entries;
    this.filters = new Map();  // by what is filtered: {label, passes(entry), removed()}
    this.table = new EntryTable(entries);
    this.failures = new FailureList(entries, (failure) => this.showFailure(failure));
    const apply = oncePerPicture(() => this.apply());
    byId("search").addEventListener("input", apply);
    byId("show").addEventListener("change", apply);
    this.makeDistributions();
    this.apply();
  }

  makeDistributions() {
    this.histograms = kDistributions
      .map((distribution) => ({distribution, values: distribution.values(this.entries)}))
      .filter(({values}) => values.some(Number.isFinite))
      .map(({distribution, values}) =>
        new Histogram(distribution, values, (histogram, bar) => this.showBar(histogram, bar)));
    byId("distributions-part").hidden = this.histograms.length === 0;
    replaceContent(byId("distributions"), ...this.histograms.map((histogram) => histogram.make()));
  }

  showBar(histogram, bar) {
    const {distribution, bins, values} = histogram;
    histogram.mark(bar);
    if (bar === null) {
      this.filters.delete(distribution.key);
    } else {
      this.filters.set(distribution.key, {
        label: `${distribution.title.toLowerCase()} ${bins.describe(bar, distribution.unit)}`,
        passes: (entry) => bins.of(values[entry]) === bar,
        removed: () => histogram.mark(null),
      });
    }
    this.apply();
  }

  showFailure(failure) {
    const members = new Set(failure.members);
    this.filters.set("failure", {label: `${failure.state}: ${failure.reason}`,
      passes: (entry) => members.has(entry), removed: () => {}});
    this.apply();
    byId("entries-part").scrollIntoView();
  }

  clear(key) {
    const filter = this.filters.get(key);
    this.filters.delete(key);
    filter.removed();
    this.apply();
    // The button that had the focus is gone.
    (document.querySelector("#chips button") || document.querySelector("#entries .wide")).focus({preventScroll: true});
  }

  listFilters() {
    replaceContent(byId("chips"), ...Array.from(this.filters, ([key, filter]) => {
      const button = element("button", {type: "button", "aria-label": `Clear the filter ${filter.label}`},
        element("span", {class: "label"}, filter.label), element("span", {"aria-hidden": "true"}, "×"));
      button.addEventListener("click", () => this.clear(key));
      return button;
    }));
  }

  apply() {
    const {entries} = this;
    const words = byId("search").value.toLowerCase().split(/\s+/).filter(Boolean);
    const isShown = kShows[byId("show").value];
    const filters = Array.from(this.filters.values());
    const chosen = [];
    for (let i = 0; i < entries.count; ++i) {
      if (isShown(entries, i) && filters.every((filter) => filter.passes(i)) && entries.matches(i, words)) chosen.push(i);
    }
    this.listFilters();
    this.table.show(chosen);
  }
}

function start() {
  const entries = readEntries();
  byId("program").textContent = `${entries.program} · ${countOf(entries.count, "entry", "entries")}`;
  replaceContent(byId("totals"), ...makeTotals(entries));
  const index = new Index(entries);
  // For tests, and for who looks at the data in the browser's console.
  window.mmmReport = {
    entries,
    get chosen() { return index.table.chosen; },
  };
  markReady();
}

start();
