// SPDX-License-Identifier: MIT
// A small body, seen from the front, whose joints can be chosen.

const kLimbJoints = ["hip", "knee", "ankle", "shoulder", "elbow", "wrist"];

// Places in a picture of 120 x 220, on the side that is right in it, which is the body's left; joints of the middle
// have one place.
const kJointPlaces = {
  neck: [60, 38], trunk: [60, 80], pelvis: [60, 108], shoulder: [80, 50], elbow: [90, 84], wrist: [97, 114],
  hip: [71, 118], knee: [73, 160], ankle: [74, 198],
};
const kPickedLimbs = [["neck", "trunk", "pelvis"], ["neck", "shoulder", "elbow", "wrist"], ["pelvis", "hip", "knee", "ankle"]];

// joints: names that there are, as of a Map; choose(name) is called.
function makeJointPicker(joints, choose) {
  const svg = svgElement("svg", {viewBox: "0 0 120 220", role: "group", "aria-label": "Body: choose a joint"},
    svgElement("circle", {cx: 60, cy: 20, r: 12, class: "picked-body"}));
  const sides = [(x) => x, (x) => 120 - x];
  for (const side of sides) {
    for (const limb of kPickedLimbs) {
      const points = limb.map((name) => `${side(kJointPlaces[name][0])},${kJointPlaces[name][1]}`);
      svg.append(svgElement("polyline", {points: points.join(" "), class: "picked-body"}));
    }
    svg.append(svgElement("polyline", {points: `${side(74)},198 ${side(82)},208`, class: "picked-body"}));
  }
  for (const name of joints.keys()) {
    if (!kJointPlaces[name]) continue;
    const [x, y] = kJointPlaces[name];
    (x === 60 ? sides.slice(1) : sides).forEach((side, i) => {
      const title = svgElement("title", {});
      title.textContent = name;
      const dot = svgElement("circle", {cx: side(x), cy: y, r: 7, "data-joint": name, role: "button",
        tabindex: i === 0 ? 0 : -1, "aria-label": name}, title);
      dot.addEventListener("click", () => choose(name));
      dot.addEventListener("keydown", (event) => {
        if (event.key !== "Enter" && event.key !== " ") return;
        event.preventDefault();
        choose(name);
      });
      svg.append(dot);
    });
  }
  return svg;
}
