// SPDX-License-Identifier: MIT
// Which figures there are, what they mean, and which of them is best.

// scale: from the figure to what is shown. judged: less is better.
const kFigures = [
  {group: "Marker distance, mm", path: "distance_mm.mean", name: "mean", digits: 2, judged: true,
    says: "Distance between measured and model markers: mean over all markers and frames, hidden markers too."},
  {group: "Marker distance, mm", path: "distance_mm.p95", name: "95 %", digits: 1, judged: true,
    says: "95th percentile of the same distances."},
  {group: "Marker distance, mm", path: "distance_mm.max", name: "max", digits: 1, judged: true,
    says: "Largest of the same distances."},
  {group: "Marker distance, mm", path: "distance_mm.worst_frame", name: "worst frame", digits: 1, judged: true,
    says: "Largest mean over the markers of a frame."},
  {group: "Hidden markers, mm", path: "hidden_distance_mm.mean", name: "mean", digits: 2, judged: true,
    says: "As above, over those markers only that were hidden from the converter."},
  {group: "Hidden markers, mm", path: "hidden_distance_mm.p95", name: "95 %", digits: 1, judged: true},
  {group: "Hidden markers, mm", path: "hidden_distance_mm.max", name: "max", digits: 1, judged: true},
  {group: "Hidden markers, mm", path: "hidden_distance_mm.worst_frame", name: "worst frame", digits: 1, judged: true},
  {group: "Frames", path: "frames_to_converge", name: "to converge", digits: 0, judged: true,
    says: "The first frame that is good: its mean marker distance is at most 1.2 times that of its least-squares optimum + 2 mm."},
  {group: "Frames", path: "frames_lost", name: "lost", digits: 0, judged: true,
    says: "Frames whose mean marker distance is more than twice that of their optimum + 20 mm."},
  {group: "Joints", path: "jitter_rad_per_s2", name: "jitter, rad/s²", digits: 1, judged: true,
    says: "Root mean square of the joints' accelerations."},
  {group: "Joints", path: "largest_step_rad", name: "largest step, rad", digits: 3, judged: true,
    says: "Largest change of a joint from one frame to the next."},
  {group: "Joints", path: "limit_share", name: "on limit, %", digits: 1, scale: 100,
    says: "Share of joint samples that lie on a limit."},
  {group: "Truth", path: "joint_center_error_mm", name: "joint centres, mm", digits: 1, judged: true,
    says: "Mean distance of the joint centres from the true ones, where they are known."},
  {group: "Truth", path: "joint_angle_error_deg", name: "joint angles, °", digits: 2, judged: true,
    says: "Mean absolute error of the joint angles, where the true ones are known."},
  {group: "Truth", path: "within_1_sd", name: "in 1 sd, %", digits: 0, scale: 100,
    says: "Share of the joint angles that are within one of their standard deviations from the truth: 68 % where these are right."},
  {group: "Truth", path: "within_2_sd", name: "in 2 sd, %", digits: 0, scale: 100,
    says: "The same with two: 95 %."},
  {group: "Time a frame, ms", path: "ms_per_frame.median", name: "median", digits: 3, judged: true,
    says: "What a frame takes to compute; depends on the machine."},
  {group: "Time a frame, ms", path: "ms_per_frame.p99", name: "99 %", digits: 2, judged: true,
    says: "99th percentile of the same."},
];

// The figure of a row of the JSON; null where there is none.
function figureOf(row, path) {
  let value = row;
  for (const key of path.split(".")) {
    if (value === null || value === undefined) return null;
    value = value[key];
  }
  return value === undefined ? null : value;
}

function shownFigure(row, figure) {
  const value = figureOf(row, figure.path);
  return value === null ? "–" : formatNumber(value * (figure.scale || 1), figure.digits);
}

// Whether a row's figure is the best of its trial, as shown: no one is best where all are equal.
function isBest(row, rows, figure) {
  if (!figure.judged || rows.length < 2) return false;
  const shown = (other) => parseFloat(shownFigure(other, figure));
  const others = rows.map(shown).filter(Number.isFinite);
  const least = Math.min(...others);
  return shown(row) === least && others.some((other) => other > least);
}

// Rows stand by trial, then contender.
function rowsOfTrial(figures, trial) {
  const count = figures.contenders.length;
  return figures.rows.slice(trial * count, (trial + 1) * count);
}

// In one line: who comes how near to the markers, in the mean over the recordings on which anyone
// has a result; of those who have one on each of them.
function verdictOf(figures) {
  const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
  const used = figures.trials
    .map((trial, i) => ({trial, rows: rowsOfTrial(figures, i)}))
    .filter(({rows}) => rows.some((row) => !row.failure));
  const means = figures.contenders
    .map((contender, i) => ({name: contender.name, rows: used.map(({rows}) => rows[i])}))
    .filter(({rows}) => rows.length > 0 && rows.every((row) => !row.failure))
    .map(({name, rows}) => ({name, distance: mean(rows.map((row) => figureOf(row, "distance_mm.mean")))}))
    .sort((a, b) => a.distance - b.distance);
  const parts = [];
  if (means.length > 0) {
    const named = means.map((one) => `${one.name} ${formatNumber(one.distance, 2)} mm`);
    const listed = named.length <= 3 ? named.join(", ") : `${named[0]} to ${named[named.length - 1]}`;
    const optimum = mean(used.map(({trial}) => trial.optimum_mm));
    parts.push(`Mean marker distance: ${listed} (optimum ${formatNumber(optimum, 2)} mm)`);
  }
  const failures = figures.rows.filter((row) => row.failure).length;
  if (failures > 0) parts.push(`${failures} of ${figures.rows.length} failed`);
  return parts.map((part) => part + ".").join(" ");
}
