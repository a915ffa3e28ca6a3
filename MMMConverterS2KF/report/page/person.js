// SPDX-License-Identifier: MIT
// Who the person of a recording is, where they are calibrated: lengths of segments, places of markers.

// A bar from 0 to `value` with a whisker of one standard deviation on each side; `most` is the end
// of the scale. isSigned: the scale starts at -most.
function makeBar(value, deviation, most, isSigned) {
  const place = (x) => `${100 * Math.min(Math.max(isSigned ? (x + most) / (2 * most) : x / most, 0), 1)}%`;
  const span = (kind, from, to) => element("span", {class: kind,
    style: `left: ${place(from)}; right: calc(100% - ${place(to)})`});
  return element("div", {class: "bar", "aria-hidden": "true"},
    span("bar-value", Math.min(value, 0), Math.max(value, 0)),
    span("bar-whisker", value - deviation, value + deviation),
    isSigned ? element("span", {class: "bar-zero"}) : null);
}

function signed(value, digits) {
  const text = formatNumber(Math.abs(value), digits);
  if (!/[1-9]/.test(text)) return text;
  return (value > 0 ? "+" : "") + formatNumber(value, digits);
}

// The share of what was assumed that the recordings replaced.
function determinedCell(observability) {
  if (observability === null) return element("td", {class: "muted"}, "–");
  const isPoor = observability < 0.5;
  return element("td", {class: isPoor ? "poor" : null,
    title: isPoor ? "More assumed than measured" : null}, formatNumber(100 * observability, 0) + " %");
}

function makePersonTable(label, heads, rows) {
  const table = element("table", {class: "figures person-table"},
    element("caption", {class: "unseen"}, label),
    element("thead", {}, element("tr", {}, ...heads.map((head) => element("th", {scope: "col"}, head)))),
    element("tbody", {}, ...rows));
  return element("div", {class: "wide", tabindex: "0", role: "region", "aria-label": label}, table);
}

function makeSegmentTable(segments) {
  const change = (segment) => 100 * (segment.scale - 1);
  const sorted = segments.slice().sort((a, b) => Math.abs(change(b)) - Math.abs(change(a)));
  const most = Math.max(1, ...sorted.map((one) => Math.abs(change(one)) + 100 * one.standard_deviation));
  return makePersonTable("Segment lengths", ["Segment", "length, %", "", "± %", "determined"],
    sorted.map((one) => element("tr", {},
      element("th", {scope: "row"}, ...breakable(one.name)),
      element("td", {}, signed(change(one), 1)),
      element("td", {class: "bar-cell"}, makeBar(change(one), 100 * one.standard_deviation, most, true)),
      element("td", {}, formatNumber(100 * one.standard_deviation, 1)),
      determinedCell(one.observability))));
}

function makeMarkerTable(markers) {
  const deviation = (one) => Math.hypot(...one.standard_deviation_mm) / Math.sqrt(3);
  const sorted = markers.slice().sort((a, b) => b.distance_mm - a.distance_mm);
  const most = Math.max(1, ...sorted.map((one) => one.distance_mm + deviation(one)));
  return makePersonTable("Marker places",
    ["Marker", "moved, mm", "", "x", "y", "z", "± mm", "frames", "determined"],
    sorted.map((one) => element("tr", {},
      element("th", {scope: "row"}, ...breakable(one.name)),
      element("td", {}, formatNumber(one.distance_mm, 1)),
      element("td", {class: "bar-cell"}, makeBar(one.distance_mm, deviation(one), most, false)),
      ...one.offset_mm.map((value) => element("td", {}, signed(value, 1))),
      element("td", {}, one.standard_deviation_mm.map((value) => formatNumber(value, 1)).join(" / ")),
      element("td", {}, String(one.frames)),
      determinedCell(one.observability))));
}

// Lengths of limbs: title, from where to where, by the model's names without their side.
const kLengths = [["thigh", "Hx_joint", "Kx_joint"], ["shank", "Kx_joint", "Ax_joint"], ["leg, hip to ankle", "Hx_joint", "Ax_joint"],
  ["upper arm", "Sx_joint", "Ex_joint"], ["forearm", "Ex_joint", "Wx_joint"]];

// Along the bones from a segment to one that it carries [mm]; NaN: the model has no such.
function boneLength({segments}, from, to) {
  let length = 0;
  let i = segments.findIndex(({name}) => name === to);
  while (i > 0 && segments[i].name !== from) {
    length += Math.hypot(...segments[i].position);
    i = segments[i].parent;
  }
  return i > 0 ? 1000 * length : NaN;
}

// Null: the model has none of them.
function makeLengthTable(model) {
  const rows = kLengths.map(([title, from, to]) => [title, ...["L", "R"].map((side) => boneLength(model, side + from, side + to))]);
  const hips = ["LHx_joint", "RHx_joint"].map((name) => model.segments.find((one) => one.name === name));
  if (hips.every(Boolean) && hips[0].parent === hips[1].parent) {
    const [left, right] = hips.map(({position}) => position);
    rows.push(["between the hips", 1000 * Math.hypot(...left.map((value, i) => value - right[i])), NaN]);
  }
  const known = rows.filter((row) => row.slice(1).some(Number.isFinite));
  return known.length === 0 ? null : makePersonTable("Lengths of limbs", ["Length", "left, mm", "right, mm"],
    known.map(([title, ...values]) => element("tr", {}, element("th", {scope: "row"}, title),
      ...values.map((value) => element("td", {}, Number.isFinite(value) ? formatNumber(value, 0) : "")))));
}

class PersonPart {
  show(trial) {
    const subject = trial.subject;
    byId("person-part").hidden = !subject;
    if (!subject) return;
    const sources = subject.sources.map((one) => `${one.recording} (${plural(one.frames, "frame")})`);
    byId("person-caption").textContent =
      `${subject.name || "The person"}, ` +
      (subject.height_m === null ? "" : `${formatNumber(subject.height_m, 3)} m, `) +
      `${formatNumber(subject.mass_kg, 1)} kg` +
      (sources.length ? `, calibrated on ${sources.join(", ")}.` : ".");
    replaceContent(byId("person-lengths"), makeLengthTable(trial.model));
    replaceContent(byId("person-segments"), makeSegmentTable(subject.segments));
    replaceContent(byId("person-markers"), makeMarkerTable(subject.markers));
  }

  setFrame() {}
}
