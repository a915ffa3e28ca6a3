// SPDX-License-Identifier: MIT
// What is shown as a file: the numbers of a plot as CSV, its picture as SVG, the player's as PNG.

function saveLink(name, href) {
  const link = element("a", {href, download: `${document.title} ${name}`.replace(/[^\p{L}\p{N}.+-]+/gu, "_")});
  link.click();
}

function saveText(name, type, text) {
  const href = URL.createObjectURL(new Blob([text], {type}));
  saveLink(name, href);
  setTimeout(() => URL.revokeObjectURL(href), 10000);
}

// On the page's colour, as canvases are transparent.
function saveCanvas(name, canvas) {
  const copy = element("canvas", {width: canvas.width, height: canvas.height});
  const pen = copy.getContext("2d");
  pen.fillStyle = themeColour("panel");
  pen.fillRect(0, 0, copy.width, copy.height);
  pen.drawImage(canvas, 0, 0);
  saveLink(`${name}.png`, copy.toDataURL("image/png"));
}

function csvCell(value) {
  if (typeof value === "number") return Number.isFinite(value) ? String(Number(value.toPrecision(7))) : "";
  return /[",\r\n]/.test(value) ? `"${value.replaceAll('"', '""')}"` : value;
}

function csvOf(heads, rows) {
  return [heads, ...rows].map((row) => row.map(csvCell).join(",") + "\n").join("");
}

// A chart as it is shown: as svgChart() takes it.
function plotCsv({window: shown, unit, xName, xs, lines}) {
  const [from, to] = shown || [-Infinity, Infinity];
  const named = lines.filter((line) => line.name);
  const withUnit = (name) => unit ? `${name} [${unit}]` : name;
  const heads = named.flatMap((line) => [withUnit(line.name),
    ...(line.band ? [withUnit(`${line.name}, low`), withUnit(`${line.name}, high`)] : [])]);
  const rows = xs.map((x, i) => [x, ...named.flatMap((line) => [line.values(i), ...(line.band ? line.band(i) : [])])])
    .filter(([x]) => from <= x && x <= to);
  return csvOf([xName, ...heads], rows);
}

// With colours as they are now, as a file has no style sheet.
function plotSvg(chart) {
  const svg = svgChart(chart, {width: 720, height: 320, isTitled: true, hasLegend: true});
  const [, , width, height] = svg.getAttribute("viewBox").split(" ");
  for (const [name, value] of Object.entries({width, height, "font-family": "sans-serif"})) svg.setAttribute(name, value);
  svg.prepend(drawn("rect", {width, height}, "fill:var(--panel)"));
  const text = new XMLSerializer().serializeToString(svg).replace(/var\(--([a-z0-9-]+)\)/g, (_, name) => themeColour(name));
  return `<?xml version="1.0" encoding="UTF-8"?>\n${text}\n`;
}

function saveButton(label, title, action) {
  const button = element("button", {type: "button", class: "plain", title}, label);
  button.addEventListener("click", action);
  return button;
}

// describe(): the chart as it is now.
function makePlotButtons(describe) {
  return element("div", {class: "save"},
    saveButton("CSV", "Save the numbers shown", () => {
      const plot = describe();
      saveText(`${plot.title}.csv`, "text/csv", plotCsv(plot));
    }),
    saveButton("SVG", "Save the picture, for print", () => {
      const plot = describe();
      saveText(`${plot.title}.svg`, "image/svg+xml", plotSvg(plot));
    }));
}
