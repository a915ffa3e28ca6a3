// SPDX-License-Identifier: MIT
// Elements, numbers and colours. Text of users enters the page through text nodes only.

function byId(id) {
  return document.getElementById(id);
}

// element("a", {href: "#x"}, "text", child): attributes that are null or false are left out.
function element(tag, attributes, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (value !== null && value !== false) made.setAttribute(name, value === true ? "" : value);
  }
  made.append(...children.filter((child) => child !== null));
  return made;
}

function replaceContent(parent, ...children) {
  parent.replaceChildren(...children.filter((child) => child !== null));
}

function option(value, text) {
  return element("option", {value}, text);
}

// A number with as many digits as were asked for; a dash where there is none.
function formatNumber(value, digits) {
  return Number.isFinite(value) ? value.toFixed(digits) : "–";
}

// A name that may be broken after each underscore and slash.
function breakable(name) {
  const parts = name.split(/(?<=[_/])/);
  return parts.flatMap((part, i) => i === 0 ? [part] : [element("wbr"), part]);
}

function formatMillimetres(metres) {
  return formatNumber(1000 * metres, 1) + " mm";
}

function plural(count, noun) {
  return `${count} ${noun}${count === 1 ? "" : "s"}`;
}

// Numbers without a common divisor: 56 converters differ in colour or dash.
const kNumConverterColours = 8;
const kDashes = [null, [7, 3], [2, 2], [9, 3, 2, 3], [4, 4], [12, 4], [6, 2, 2, 2, 2, 2]];

// A colour of the style sheet as it is now, light or dark.
function themeColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
}

function converterColour(index) {
  return themeColour("converter-" + (index % kNumConverterColours));
}

function converterDash(index) {
  return kDashes[index % kDashes.length];
}

function svgElement(tag, attributes, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

// The line that stands for a curve in a legend.
function lineSwatch(colour, dash) {
  const line = svgElement("line", {x1: 1, y1: 4, x2: 27, y2: 4, "stroke-width": 3});
  const svg = svgElement("svg", {viewBox: "0 0 28 8", class: "swatch", "aria-hidden": "true"}, line);
  if (dash) line.setAttribute("stroke-dasharray", dash.join(" "));
  line.style.stroke = colour;
  return svg;
}

function converterSwatch(index) {
  return lineSwatch(`var(--converter-${index % kNumConverterColours})`, converterDash(index));
}

// Calls `redraw` once before the next picture, however often it is asked for.
function oncePerPicture(redraw) {
  let waiting = false;
  return () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      redraw();
    });
  };
}

// rows: a heading and cells each.
function makeTable(kind, label, heads, rows) {
  const table = element("table", {class: `figures ${kind}`},
    element("caption", {class: "unseen"}, label),
    element("thead", {}, element("tr", {}, ...heads.map((head) => element("th", {scope: "col"}, head)))),
    element("tbody", {}, ...rows.map(([head, ...cells]) => element("tr", {},
      element("th", {scope: "row"}, head), ...cells))));
  return element("div", {class: "wide", tabindex: "0", role: "region", "aria-label": label}, table);
}

// The JSON of a block of the page's data.
function readBlock(name) {
  return JSON.parse(document.querySelector(`script.${name}`).textContent);
}

function showNotes(warnings) {
  byId("notes-part").hidden = warnings.length === 0;
  replaceContent(byId("notes"), ...warnings.map((warning) => element("li", {}, warning)));
}

// In other colours where the reader chooses these.
function redrawWithColours(view) {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => view.refresh());
}

// For tests: all that was asked for is drawn.
function markReady() {
  requestAnimationFrame(() => requestAnimationFrame(() => performance.mark("ready")));
}

// Marks of a value axis, of which at least two are named: one number says nothing of the scale.
function twoTicks(least, most, pixels, options, graph, values) {
  for (let apart = options("pixelsPerLabel"); ; apart /= 1.5) {
    const ticks = Dygraph.numericTicks(least, most, pixels,
      (name) => (name === "pixelsPerLabel" ? apart : options(name)), graph, values);
    const named = ticks.filter(({v, label}) => label && v >= least && v <= most);
    if (named.length > 1 || apart < 4) return ticks;
  }
}
