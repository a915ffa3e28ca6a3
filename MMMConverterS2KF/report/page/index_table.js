// SPDX-License-Identifier: MIT
// The table of entries: those that are not converted first, then as sorted; a part of it at a time.

const kRowsAtOnce = 200;

// path: the member that is shown and sorted by. text: sorted by letters, else by number, largest first.
const kColumns = [
  {key: "id", name: "entry", text: true},
  {key: "group", name: "group", text: true},
  {key: "verdict.level", name: "verdict", levels: true, says: "How far the motion can be trusted; the details have the reasons."},
  {key: "distance_mm.mean", name: "mean, mm", digits: 2, says: "Mean distance between measured and model markers, over all markers and frames."},
  {key: "distance_mm.p95", name: "95\u00a0%, mm", digits: 1, says: "95th percentile of the same distances."},
  {key: "distance_mm.max", name: "max, mm", digits: 1, says: "Largest of the same distances."},
  {key: "worst_marker_mm", name: "worst marker, mm", digits: 1, with: "worst_marker", says: "The marker whose mean distance is largest."},
  {key: "robot.slide", name: "feet slide, %", digits: 1, says: "Share of the frames in contact in which a foot of the robot slides.",
    numbers: (entries) => entries.numbers("robot.slide").map((share) => 100 * share)},
  {key: "robot.penetration_mm", name: "in the floor, mm", digits: 1, says: "The deepest point of the robot's feet."},
  {key: "robot.direction_deg", name: "limbs, °", digits: 1, says: "How far the robot's limbs point elsewhere than the person's, on average."},
  {key: "frames", name: "frames", digits: 0},
  {key: "not-converged", name: "not converged, %", digits: 1, numbers: shareNotConverged, says: "Share of the frames that are not converged."},
  {key: "markers_absent", name: "absent markers", digits: 0, says: "Markers of the model that the recording does not have."},
  {key: "wrong_markers", name: "wrong markers", digits: 0, says: "Times that markers were swapped, jumped or wandered."},
  {key: "ms_per_frame.median", name: "ms a frame", digits: 3, says: "Median time of computing a frame."},
  {key: "warnings", name: "warnings", digits: 0, numbers: (entries) =>
    Float64Array.from({length: entries.count}, (_, i) => entries.warnings(i).length)},
];

// Sorted by letters, as numbers; NaN where there is none.
function ranksOf(entries, name) {
  const texts = Array.from({length: entries.count}, (_, i) => entries.text(name, i));
  const ranks = new Map(Array.from(new Set(texts)).sort().map((text, rank) => [text, rank]));
  return Float64Array.from(texts, (text) => text === null ? NaN : ranks.get(text));
}

const kLevels = ["good", "check", "failed"];

// NaN where there is none.
function levelsOf(entries, name) {
  const places = new Map(kLevels.map((level, place) => [level, place]));
  return Float64Array.from({length: entries.count}, (_, i) => places.get(entries.text(name, i)));
}

function numbersOfColumn(entries, column) {
  if (column.levels) return levelsOf(entries, column.key);
  if (column.text) return ranksOf(entries, column.key);
  return column.numbers ? column.numbers(entries) : entries.numbers(column.key);
}

class EntryTable {
  constructor(entries) {
    this.entries = entries;
    this.columns = kColumns.map((column) => ({...column, ranks: numbersOfColumn(entries, column)}))
      .filter((column) => column.key === "id" || column.key === "distance_mm.mean" || column.ranks.some(Number.isFinite));
    this.sortedBy = this.columns.find((column) => column.levels) ||
      this.columns.find((column) => column.key === "distance_mm.mean");
    this.isDescending = true;
    this.chosen = [];       // entries that pass the filters, as sorted
    this.open = new Set();  // entries whose details are shown
    byId("more").addEventListener("click", () => this.showMore());
    this.makeFrame();
  }

  makeFrame() {
    this.heads = this.columns.map((column) => this.head(column));
    this.body = element("tbody", {});
    const table = element("table", {class: "entries"},
      element("caption", {class: "unseen"}, "Entries of the batch; a heading sorts them"),
      element("thead", {}, element("tr", {}, ...this.heads, element("th", {scope: "col"}, "links"))), this.body);
    replaceContent(byId("entries"), element("div", {class: "wide", tabindex: "0", role: "region",
      "aria-label": "Table of entries, scrolls sideways"}, table));
    this.markHeads();
  }

  head(column) {
    const button = element("button", {type: "button", class: "plain", title: column.says || null}, column.name);
    button.addEventListener("click", () => this.sortBy(column));
    return element("th", {scope: "col", "data-key": column.key, class: column.text ? "text" : null}, button);
  }

  markHeads() {
    this.columns.forEach((column, i) => {
      if (column !== this.sortedBy) this.heads[i].removeAttribute("aria-sort");
      else this.heads[i].setAttribute("aria-sort", this.isDescending ? "descending" : "ascending");
    });
  }

  sortBy(column) {
    this.isDescending = column === this.sortedBy ? !this.isDescending : !column.text;
    this.sortedBy = column;
    this.markHeads();
    this.show(this.chosen);
  }

  // Those without a value stand last; those of a level by their distance, the largest first; else
  // equal ones as in the results.
  show(chosen) {
    const {converted} = this.entries;
    const {ranks} = this.sortedBy;
    const sign = this.isDescending ? -1 : 1;
    const distances = this.entries.numbers("distance_mm.mean");
    const distance = (i) => this.sortedBy.levels && Number.isFinite(distances[i]) ? distances[i] : -Infinity;
    const worse = (a, b) => distance(a) === distance(b) ? 0 : distance(b) - distance(a);
    const place = (i) => (converted[i] ? 2 : 0) + (Number.isFinite(ranks[i]) ? 0 : 1);
    this.chosen = chosen.sort((a, b) =>
      place(a) - place(b) || sign * (ranks[a] - ranks[b]) || worse(a, b) || a - b);
    this.body.replaceChildren();
    this.numShown = 0;
    this.showMore();
  }

  showMore() {
    const more = this.chosen.slice(this.numShown, this.numShown + kRowsAtOnce);
    this.body.append(...more.flatMap((entry) => this.rows(entry)));
    this.numShown += more.length;
    const left = this.chosen.length - this.numShown;
    byId("more").hidden = left === 0;
    byId("more").textContent = `Show ${formatCount(Math.min(left, kRowsAtOnce))} more`;
    const total = countOf(this.entries.count, "entry", "entries");
    byId("shown").textContent = this.chosen.length === this.entries.count
      ? (left ? `The first ${formatCount(this.numShown)} of ${total}.` : `${total}.`)
      : `${formatCount(this.chosen.length)} of ${total}` + (left ? `, the first ${formatCount(this.numShown)} of them shown.` : ".");
  }

  rows(entry) {
    const row = this.entries.converted[entry] ? this.row(entry) : this.failedRow(entry);
    return this.open.has(entry) ? [row, this.details(entry)] : [row];
  }

  row(entry) {
    return element("tr", {"data-entry": entry}, this.rowHead(entry),
      ...this.columns.slice(1).map((column) => this.cell(column, entry)), this.links(entry));
  }

  failedRow(entry) {
    const group = this.columns[1].key === "group" ? this.cell(this.columns[1], entry) : null;
    const span = this.columns.length - (group ? 2 : 1);
    return element("tr", {"data-entry": entry, class: "failed"}, ...[this.rowHead(entry), group].filter(Boolean),
      element("td", {colspan: span, class: "reason"}, element("span", {class: "stay"},
        element("strong", {}, this.entries.state(entry) + ": "), this.entries.reason(entry))), this.links(entry));
  }

  rowHead(entry) {
    const id = this.entries.text("id", entry) || "–";
    const button = element("button", {type: "button", class: "plain disclose",
      "aria-expanded": String(this.open.has(entry)), "aria-label": "All about " + id}, "▸");
    button.addEventListener("click", () => this.toggle(entry, button));
    return element("th", {scope: "row"},
      element("span", {class: "row-name"}, button, element("span", {}, ...breakable(id))));
  }

  cell(column, entry) {
    if (column.text || column.levels) return element("td", {class: "text"}, this.entries.text(column.key, entry) || "–");
    const shown = formatNumber(column.ranks[entry], column.digits);
    const name = column.with ? this.entries.text(column.with, entry) : null;
    return element("td", {"data-key": column.key},
      name ? element("span", {class: "with"}, name + " ") : null, shown);
  }

  links(entry) {
    const cell = element("td", {class: "links"});
    for (const name of ["report", "motion", "robot_motion"]) {
      const link = relativeLink(this.entries.text(name, entry));
      if (link) cell.append(element("a", {href: link}, name.split("_")[0]), " ");
    }
    return cell;
  }

  toggle(entry, button) {
    const row = button.closest("tr");
    const opens = !this.open.has(entry);
    button.setAttribute("aria-expanded", String(opens));
    if (opens) {
      this.open.add(entry);
      row.after(this.details(entry));
    } else {
      this.open.delete(entry);
      row.nextElementSibling.remove();
    }
  }

  // Warnings, then every member as it was given.
  details(entry) {
    const {entries} = this;
    const warnings = entries.warnings(entry);
    const pairs = Array.from(entries.columns.keys())
      .filter((name) => !["id", "warnings"].includes(name) && !name.startsWith("metadata."))
      .map((name) => [name, entries.text(name, entry)]).filter(([, text]) => text !== null)
      .concat(entries.metadata(entry).map(([name, text]) => ["metadata " + name, text || ""]));
    return element("tr", {class: "details"}, element("td", {colspan: this.columns.length + 1},
      element("div", {class: "stay"},
        warnings.length ? element("ul", {class: "warnings"}, ...warnings.map((text) => element("li", {}, text))) : null,
        element("dl", {}, ...pairs.map(([name, text]) =>
          element("div", {}, element("dt", {}, ...breakable(name)), element("dd", {}, ...breakable(text))))))));
  }
}
