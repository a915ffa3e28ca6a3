// SPDX-License-Identifier: MIT
// What the index was given: the members of all entries, by column (batch_index.cc).

class Column {
  // A list of values, or the different values and which of them each entry has; null: no values.
  constructor(json) {
    const isList = Array.isArray(json);
    this.list = isList ? json : null;
    this.values = isList || !json ? [null] : json.values;
    this.index = isList || !json ? null : json.index;
  }

  at(entry) {
    if (this.list) return this.list[entry];
    return this.values[this.index ? this.index[entry] : 0];
  }
}

const kNoColumn = new Column(null);
const kPaths = ["recording", "motion", "robot_motion", "report"];

function asText(value) {
  if (value === null) return null;
  return typeof value === "string" ? value : JSON.stringify(value);
}

class Entries {
  constructor(json) {
    this.program = json.program;
    this.count = json.entries;
    this.columns = new Map(Object.entries(json.columns)
      .map(([name, column]) => [name, new Column(column)]));
    this.converted = new Uint8Array(this.count);
    for (let i = 0; i < this.count; ++i) this.converted[i] = this.value("state", i) === "converted" ? 1 : 0;
    this.numbersOf = new Map();
    this.searched = [];  // what a text filter looks at, made at first use
  }

  value(name, entry) {
    return (this.columns.get(name) || kNoColumn).at(entry);
  }

  // null where there is none. Paths stand as what is before and after the entry's id.
  text(name, entry) {
    const value = this.value(name, entry);
    if (kPaths.includes(name) && Array.isArray(value)) return value.join(this.text("id", entry));
    return asText(value);
  }

  // Of all entries; NaN where there is none.
  numbers(name) {
    if (!this.numbersOf.has(name)) {
      const column = this.columns.get(name) || kNoColumn;
      this.numbersOf.set(name, Float64Array.from({length: this.count}, (_, i) => {
        const value = column.at(i);
        return typeof value === "number" ? value : NaN;
      }));
    }
    return this.numbersOf.get(name);
  }

  warnings(entry) {
    const warnings = this.value("warnings", entry);
    return Array.isArray(warnings) ? warnings.map(asText) : [];
  }

  // [name, value] of each.
  metadata(entry) {
    const names = this.value("metadata.names", entry) || [];
    const values = this.value("metadata.values", entry);
    return names.map((name, i) => [name, asText(values[i])]);
  }

  state(entry) {
    if (this.converted[entry]) return "converted";
    return this.value("state", entry) === "missing" ? "missing" : "failed";
  }

  reason(entry) {
    return this.text("reason", entry) || "no reason is known";
  }

  // Each word occurs somewhere in what is said of the entry.
  matches(entry, words) {
    if (words.length === 0) return true;
    if (!this.searched[entry]) {
      const texts = ["id", "group", "reason"].map((name) => this.text(name, entry))
        .concat(this.warnings(entry), this.metadata(entry).map((pair) => pair.join("=")));
      this.searched[entry] = texts.filter(Boolean).join("\n").toLowerCase();
    }
    return words.every((word) => this.searched[entry].includes(word));
  }
}

// Frames that are not converged, of the frames of each entry [%].
function shareNotConverged(entries) {
  const frames = entries.numbers("frames");
  return entries.numbers("frames_not_converged")
    .map((count, i) => frames[i] > 0 ? 100 * count / frames[i] : NaN);
}

// A link for a relative path without scheme; null for any other.
function relativeLink(path) {
  if (!path || path.startsWith("/") || /^[a-z][a-z0-9+.-]*:/i.test(path)) return null;
  return path.split("/").map(encodeURIComponent).join("/");
}

function formatCount(count) {
  return count.toLocaleString("en-US");
}

function countOf(count, singular, more) {
  return `${formatCount(count)} ${count === 1 ? singular : more}`;
}

function formatDuration(seconds) {
  if (!Number.isFinite(seconds)) return "–";
  if (seconds < 59.95) return formatNumber(seconds, seconds < 9.995 ? 2 : 1) + " s";
  const whole = Math.round(seconds);
  const two = (number) => String(number).padStart(2, "0");
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${two(whole % 60)} s`;
  return `${formatCount(Math.floor(whole / 3600))} h ${two(Math.floor(whole % 3600 / 60))} min`;
}

function readEntries() {
  return new Entries(JSON.parse(document.querySelector("script.batch").textContent));
}
