// SPDX-License-Identifier: MIT
// Strides against healthy gait: Movement Analysis Profile and Gait Profile Score (Baker et al. 2009).

// Of several recordings; null: none has it.
function poolProfiles(profiles) {
  const known = profiles.filter(Boolean);
  if (known.length === 0) return null;
  return Object.fromEntries(kSides.map((side) => [side, {
    score: poolFigures(known.map((one) => one[side].score)),
    variables: known[0][side].variables.map(({joint, what}, i) =>
      ({joint, what, ...poolFigures(known.map((one) => one[side].variables[i]))}))}]));
}

// Of both sides: the pelvis once, as the left foot's strides have it.
function overallScore(profile) {
  const scores = [...profile.left.variables, ...profile.right.variables.filter(({joint}) => joint !== "pelvis")];
  return Math.sqrt(scores.reduce((sum, {mean}) => sum + mean * mean, 0) / scores.length);
}

function makeProfileTable(profile) {
  const most = Math.max(1, ...kSides.flatMap((side) => [...profile[side].variables, profile[side].score].map(({mean, sd}) => mean + (sd || 0))));
  const cells = ({mean, sd}, side) => {
    const bar = makeBar(mean, sd || 0, most, false);
    bar.classList.add(`${side}-bar`);
    return [element("td", {}, formatNumber(mean, 1) + (sd === null ? "" : ` ± ${formatNumber(sd, 1)}`)), element("td", {class: "bar-cell"}, bar)];
  };
  const row = (name, left, right) => element("tr", {}, element("th", {scope: "row"}, name), ...cells(left, "left"), ...cells(right, "right"));
  const rows = profile.left.variables.map((left, i) => row(`${left.joint} ${left.what}`, left, profile.right.variables[i]));
  rows.push(row("Gait Profile Score", profile.left.score, profile.right.score));
  return makePersonTable("Movement Analysis Profile", ["rms from normal, °", "left", "", "right", ""], rows);
}

// groups: {name, profile} of each condition.
function showNormal(normal, groups) {
  byId("normal-legend").hidden = byId("normal-source").hidden = !normal;
  const scored = groups.filter(({profile}) => profile);
  byId("profile-part").hidden = scored.length === 0;
  if (!normal) return;
  const lacking = normal.lacking || [];
  byId("normal-source").textContent = `Normal: ${normal.source}` +
    (lacking.length > 0 ? `. No scores: there are no bands of ${lacking.join(", ")}.` : "");
  replaceContent(byId("profile"), ...scored.flatMap(({name, profile}) => [name ? element("h3", {}, name) : null,
    makeProfileTable(profile), element("p", {}, `Gait Profile Score of both sides: ${formatNumber(overallScore(profile), 1)}°`)]),
  element("p", {class: "caption"}, "Gait Variable Scores are root mean square differences from the normal mean over the cycle, of " +
    "each stride; their mean ± one standard deviation, and the root mean square of the nine (Baker et al. 2009)."));
}
