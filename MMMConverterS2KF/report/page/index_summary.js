// SPDX-License-Identifier: MIT
// What a batch came to, and what failed.

const kFailuresAtOnce = 20;
const kNamesOfFailure = 5;

// Entries whose number is not known add nothing.
function sumOf(numbers) {
  return numbers.reduce((sum, number) => Number.isFinite(number) ? sum + number : sum, 0);
}

function makeTotals(entries) {
  const states = {converted: 0, failed: 0, missing: 0};
  for (let i = 0; i < entries.count; ++i) ++states[entries.state(i)];
  const rates = entries.numbers("rate_hz");
  const frames = entries.numbers("frames").map((count, i) => entries.converted[i] ? count : NaN);
  const recorded = sumOf(frames.map((count, i) => count / rates[i]));
  const seconds = sumOf(entries.numbers("seconds"));
  const item = (name, value, about) => element("div", {class: about || null},
    element("dt", {}, name), element("dd", {}, value));
  return [
    item("converted", formatCount(states.converted)),
    item("failed", formatCount(states.failed), states.failed ? "bad" : null),
    item("missing", formatCount(states.missing), states.missing ? "bad" : null),
    item("recorded", formatDuration(recorded)),
    item("frames", formatCount(sumOf(frames))),
    item("computing time", formatDuration(seconds)),
    item("real-time factor", seconds > 0 && recorded > 0 ? formatNumber(recorded / seconds, 1) + " ×" : "–"),
  ];
}

// Entries that are not converted, by state and reason; the most frequent first.
function findFailures(entries) {
  const failures = new Map();
  for (let i = 0; i < entries.count; ++i) {
    if (entries.converted[i]) continue;
    const key = entries.state(i) + " " + entries.reason(i);
    if (!failures.has(key)) failures.set(key, {state: entries.state(i), reason: entries.reason(i), members: []});
    failures.get(key).members.push(i);
  }
  return Array.from(failures.values()).sort((a, b) => b.members.length - a.members.length);
}

// onChosen(failure): its entries are to be shown.
class FailureList {
  constructor(entries, onChosen) {
    this.entries = entries;
    this.onChosen = onChosen;
    this.failures = findFailures(entries);
    byId("failures-part").hidden = this.failures.length === 0;
    byId("more-failures").addEventListener("click", () => this.showMore());
    this.showMore();
  }

  showMore() {
    const list = byId("failures");
    const first = list.children.length;
    list.append(...this.failures.slice(first, first + kFailuresAtOnce).map((failure) => this.item(failure)));
    const left = this.failures.length - list.children.length;
    byId("more-failures").hidden = left <= 0;
    byId("more-failures").textContent = `Show more (${countOf(left, "reason", "reasons")})`;
  }

  item(failure) {
    const {members} = failure;
    const names = members.slice(0, kNamesOfFailure).flatMap((entry, i) => [
      i > 0 ? ", " : "", element("span", {class: "name"}, ...breakable(this.entries.text("id", entry) || "–"))]);
    if (members.length > kNamesOfFailure) names.push(` and ${formatCount(members.length - kNamesOfFailure)} more`);
    const button = element("button", {type: "button", class: "plain"}, "show in the table");
    button.addEventListener("click", () => this.onChosen(failure));
    return element("li", {},
      element("p", {class: "reason"}, element("strong", {}, failure.state + ": "), failure.reason),
      element("p", {class: "members"}, members.length > 1 ? `${formatCount(members.length)} entries: ` : "",
        ...names, members.length > 1 ? button : null));
  }
}
