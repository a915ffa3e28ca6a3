// SPDX-License-Identifier: MIT
// The head of a person's page: who was recorded, when, how and by what.

function describeValue({value, source, deviation}, digits, unit) {
  if (value === null) return "not known";
  return formatNumber(value, digits) + (deviation === null ? "" : ` ± ${formatNumber(deviation, digits)}`) + ` ${unit} (${source})`;
}

// What the recordings say, each thing once.
function listed(recordings, name) {
  return Array.from(new Set(recordings.map((one) => one[name]).filter(Boolean))).join(", ");
}

function describeRecordings(recordings) {
  if (recordings.length === 1) {
    const [{file, motion, frames, rate_hz: rate}] = recordings;
    return `${file}${motion ? `, ${motion}` : ""}: ${formatNumber(frames / rate, 1)} s at ${formatNumber(rate, 0)} Hz`;
  }
  const seconds = recordings.reduce((sum, {frames, rate_hz: rate}) => sum + frames / rate, 0);
  return `${recordings.length}, ${formatNumber(seconds, 0)} s: ${recordings.map(({file, motion}) => motion || file).join(", ")}`;
}

function describeQuality(recordings) {
  const [{verdict, reasons}] = recordings;
  if (recordings.length === 1) return verdict + (reasons.length ? `: ${reasons.join("; ")}` : "");
  const count = (level) => recordings.filter((one) => one.verdict === level).length;
  return ["good", "check", "failed"].filter(count).map((level) => `${count(level)} ${level}`).join(", ") +
    (count("good") < recordings.length ? "; the annex says why" : "");
}

function makePatient({name, height_m: height, mass_kg: mass, recordings}) {
  const rows = [["Name", name || "not stated"], ["Date", listed(recordings, "date") || "not stated"],
    ["Condition", listed(recordings, "condition")], ["Height", describeValue(height, 2, "m")],
    ["Mass", describeValue(mass, 1, "kg")], [recordings.length > 1 ? "Recordings" : "Recording", describeRecordings(recordings)],
    ["Recorded by", listed(recordings, "system")], ["Tracking", describeQuality(recordings)]];
  return element("dl", {class: "patient"}, ...rows.filter(([, text]) => text).map(([title, text]) =>
    element("div", {}, element("dt", {}, title), element("dd", {}, text))));
}

// As a string of CSS, whatever is in it.
function cssString(text) {
  return `"${Array.from(text, (one) => `\\${one.codePointAt(0).toString(16)} `).join("")}"`;
}

// Below each page on paper whose it is.
function nameEachPage({name, recordings}) {
  const text = [name, listed(recordings, "date"), listed(recordings, "condition")].filter(Boolean).join(" · ").slice(0, 90);
  document.head.append(element("style", {}, `@page { @bottom-left { content: ${cssString(text)}; font: 8pt sans-serif; color: #555; } }`));
}

// A page that is the person's first, and the tracking's at its end.
function showPatient(patient) {
  document.body.classList.add("of-patient");
  byId("patient-part").hidden = byId("annex-heading").hidden = false;
  replaceContent(byId("patient"), makePatient(patient));
  byId("annex-summary").append(byId("summary"));
  byId("first-page").append(byId("stills-part"));
  nameEachPage(patient);
}
