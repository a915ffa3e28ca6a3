// SPDX-License-Identifier: MIT
// Configurations, warnings and failures of the part that is shown.

// Labels that were wrong for a while.
function describeIncident(incident, trial) {
  const time = (frame) => formatNumber(trial.time(frame / trial.every), 2);
  return `${incident.labels.join(" and ")} ${incident.kind} in frames ${incident.first} to ${incident.last} ` +
    `(${time(incident.first)} to ${time(incident.last)} s)`;
}

function makeNotes(section) {
  const items = [];
  const add = (about, text) => items.push(element("li", {}, element("strong", {}, about + ": "), text));
  section.trials.forEach((trial) => {
    // What is said of all converters is said once.
    const seen = new Set();
    for (const track of trial.failed) {
      if (!seen.has(track.failure)) {
        add(trial.failure ? trial.name : `${trial.name}, ${track.name}`, track.failure);
      }
      seen.add(track.failure);
    }
    for (const track of trial.tracks) {
      const about = section.trials.length > 1 ? `${trial.name}, ${track.name}` : track.name;
      const texts = track.warnings.slice();
      if (track.ignored.length) texts.push(`labels that stand for no marker: ${track.ignored.join(", ")}`);
      if (track.absent.length) texts.push(`markers that the recording does not have: ${track.absent.join(", ")}`);
      for (const one of track.incidents) texts.push(describeIncident(one, trial));
      for (const text of texts) {
        if (!seen.has(text)) add(about, text);
        seen.add(text);
      }
    }
  });
  return items.length ? element("ul", {class: "notes"}, ...items)
    : element("p", {class: "muted"}, "No warnings, no failures.");
}

function makeConfigurations(section) {
  return section.contenders.map((contender, i) => element("details", {},
    element("summary", {}, converterSwatch(i), contender.name),
    element("pre", {tabindex: "0"}, contender.configuration || "No configuration is known.")));
}
