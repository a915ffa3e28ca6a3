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

// A plot as it is shown. plot: {graph, title, unit, xName, xs, lines: as of a Chart, values(i) at xs[i]}.
function plotCsv({graph, unit, xName, xs, lines}) {
  const [from, to] = graph.xAxisRange();
  const named = lines.filter((line) => line.name);
  const withUnit = (name) => unit ? `${name} [${unit}]` : name;
  const heads = named.flatMap((line) => [withUnit(line.name),
    ...(line.band ? [withUnit(`${line.name}, low`), withUnit(`${line.name}, high`)] : [])]);
  const rows = xs.map((x, i) => [x, ...named.flatMap((line) => [line.values(i), ...(line.band ? line.band(i) : [])])])
    .filter(([x]) => from <= x && x <= to);
  return csvOf([xName, ...heads], rows);
}

// Runs of indices whose places are known.
function knownRuns(count, isKnown) {
  const runs = [];
  for (let i = 0, last = -2; i < count; ++i) {
    if (!isKnown(i)) continue;
    if (last !== i - 1) runs.push([]);
    runs[runs.length - 1].push(i);
    last = i;
  }
  return runs;
}

function svgOfLine(graph, xs, line) {
  const place = (i, value) => `${graph.toDomXCoord(xs[i]).toFixed(2)},${graph.toDomYCoord(value).toFixed(2)}`;
  const drawn = [];
  const band = line.band || (() => [NaN, NaN]);
  for (const run of knownRuns(xs.length, (i) => line.band && band(i).every(Number.isFinite))) {
    const points = [...run.map((i) => place(i, band(i)[0])), ...run.slice().reverse().map((i) => place(i, band(i)[1]))];
    drawn.push(svgElement("polygon", {points: points.join(" "), fill: line.colour, "fill-opacity": 0.15}));
  }
  for (const run of knownRuns(xs.length, (i) => Number.isFinite(line.values(i)))) {
    drawn.push(svgElement("polyline", {points: run.map((i) => place(i, line.values(i))).join(" "), fill: "none",
      stroke: line.colour, "stroke-width": line.width || 1.6, ...(line.dash ? {"stroke-dasharray": line.dash.join(" ")} : {})}));
  }
  return drawn;
}

const kLegendRow = 18;  // [px]
const kTitleHeight = 26;

function plotSvg({graph, title, xs, lines}) {
  const area = graph.getArea();
  const {width, height} = graph.size();
  const ink = themeColour("text");
  const text = (x, y, anchor, words) => svgElement("text", {x, y, "text-anchor": anchor, fill: ink}, words);
  const rule = (x1, y1, x2, y2) => svgElement("line", {x1, y1, x2, y2, stroke: themeColour("grid")});
  const {xticks, yticks} = graph.layout_;
  const ticks = [
    ...xticks.filter((tick) => tick.has_tick !== false).flatMap(({pos, label}) => [
      rule(area.x + pos * area.w, area.y, area.x + pos * area.w, area.y + area.h),
      text(area.x + pos * area.w, area.y + area.h + 15, "middle", label || "")]),
    ...yticks.filter((tick) => tick.has_tick !== false).flatMap(({pos, label}) => [
      rule(area.x, area.y + pos * area.h, area.x + area.w, area.y + pos * area.h),
      text(area.x - 5, area.y + pos * area.h + 4, "end", label || "")])];
  const named = lines.filter((line) => line.name);
  const legend = named.flatMap((line, i) => {
    const y = height + kLegendRow * (i + 0.6);
    return [svgElement("line", {x1: area.x, y1: y - 4, x2: area.x + 26, y2: y - 4, stroke: line.colour, "stroke-width": 3,
      ...(line.dash ? {"stroke-dasharray": line.dash.join(" ")} : {})}), text(area.x + 34, y, "start", line.name)];
  });
  const clip = svgElement("clipPath", {id: "area"},
    svgElement("rect", {x: area.x, y: area.y, width: area.w, height: area.h}));
  const whole = kTitleHeight + height + kLegendRow * (named.length + 0.5);
  const svg = svgElement("svg", {viewBox: `0 ${-kTitleHeight} ${width} ${whole}`, width, height: whole,
    "font-family": "sans-serif", "font-size": 12},
    clip, svgElement("rect", {x: 0, y: -kTitleHeight, width, height: whole, fill: themeColour("panel")}),
    text(area.x, -8, "start", title), ...ticks,
    svgElement("g", {"clip-path": "url(#area)"}, ...lines.flatMap((line) => svgOfLine(graph, xs, line))), ...legend);
  return `<?xml version="1.0" encoding="UTF-8"?>\n${new XMLSerializer().serializeToString(svg)}\n`;
}

function saveButton(label, title, action) {
  const button = element("button", {type: "button", class: "plain", title}, label);
  button.addEventListener("click", action);
  return button;
}

// describe(): the plot as it is now.
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
