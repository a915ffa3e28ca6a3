// SPDX-License-Identifier: MIT
// Charts as SVG: on paper, as files, and those of the gait cycle on the screen too. Colours may be var(--name), so that
// paper has its own.

// Marks of an axis, some `count` of them and at least two: steps of 1, 2 or 5 and a power of ten; on a logarithmic one
// the powers, or what lies between them.
function ticksOf([least, most], count, isLogarithmic) {
  if (!(most > least)) return [];
  if (isLogarithmic) {
    const powers = [];
    for (let power = Math.ceil(Math.log10(least) - 1e-9); 10 ** power <= most * (1 + 1e-9); ++power) powers.push(10 ** power);
    if (powers.length > 1) return powers.map((value) => ({value, label: String(Number(value.toPrecision(1)))}));
  }
  for (let wanted = count; ; wanted *= 2) {
    const power = 10 ** Math.floor(Math.log10((most - least) / wanted));
    const step = [1, 2, 5, 10].map((times) => times * power).find((one) => one * wanted >= (most - least) * (1 - 1e-9));
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const ticks = [];
    for (let i = Math.ceil(least / step - 1e-9); i * step <= most + 1e-9 * step; ++i) {
      ticks.push({value: i * step, label: (i * step).toFixed(digits)});
    }
    if (ticks.length > 1) return ticks;
  }
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

// `style`, as attributes would not know var().
function drawn(tag, attributes, style) {
  const made = svgElement(tag, Object.fromEntries(Object.entries(attributes).filter(([, value]) => value !== null)));
  made.setAttribute("style", style);
  return made;
}

// line: as of a Chart; more of it here: shade, the opacity of its band; opacity; hasEdges, a band whose edges alone are
// drawn.
function svgOfLine(line, {xs, from, to, place}) {
  const made = [];
  const isShown = (i) => from <= xs[i] && xs[i] <= to;
  const band = line.band || (() => [NaN, NaN]);
  for (const run of knownRuns(xs.length, (i) => line.band && isShown(i) && band(i).every(Number.isFinite))) {
    const edges = [0, 1].map((end) => run.map((i) => place(xs[i], band(i)[end])));
    if (line.hasEdges) {
      made.push(...edges.map((points) => drawn("polyline", {points: points.join(" "), class: "doubt"},
        `fill:none;stroke:${line.colour};stroke-width:0.8;stroke-dasharray:1 2`)));
    } else {
      made.push(drawn("polygon", {points: [...edges[0], ...edges[1].reverse()].join(" "), class: "band"},
        `fill:${line.colour};fill-opacity:${line.shade || 0.16}`));
    }
  }
  for (const run of knownRuns(xs.length, (i) => isShown(i) && Number.isFinite(line.values(i)))) {
    made.push(drawn("polyline", {points: run.map((i) => place(xs[i], line.values(i))).join(" "), class: line.kind || "curve",
      "data-line": line.name || null}, `fill:none;stroke:${line.colour};stroke-width:${line.width || 1.6}` +
      (line.opacity ? `;stroke-opacity:${line.opacity}` : "") + (line.dash ? `;stroke-dasharray:${line.dash.join(" ")}` : "")));
  }
  return made;
}

// chart: {title, unit, xName, xs, lines, range, and perhaps window: [from, to] of xs, isLogarithmic, hasNoScale,
// verticals: [{x, colour}], xLabel(text)}. look: {width, height, isTitled, hasLegend}: units are pixels where the
// picture is as wide as on paper.
function svgChart(chart, look) {
  const {xs, lines} = chart;
  const [from, to] = chart.window || [xs[0], xs[xs.length - 1]];
  const named = look.hasLegend ? lines.filter((line) => line.name) : [];
  const top = look.isTitled ? 24 : 6;
  const area = {x: chart.hasNoScale ? 6 : 34, y: top, w: 0, h: look.height - top - (chart.xName ? 30 : 17)};
  area.w = look.width - area.x - 8;
  const scale = chart.isLogarithmic ? Math.log10 : (value) => value;
  const [least, most] = chart.range.map(scale);
  const x = (value) => area.x + area.w * (value - from) / ((to - from) || 1);
  const y = (value) => area.y + area.h * (1 - (scale(value) - least) / ((most - least) || 1));
  // What is far outside is just outside: a dashed line of many pages would be as many dashes on paper.
  const inside = (height) => Math.min(Math.max(height, area.y - 9), area.y + area.h + 9);
  const place = (at, value) => `${x(at).toFixed(1)},${inside(y(value)).toFixed(1)}`;
  const text = (at, height, anchor, words) => {
    const made = drawn("text", {x: at.toFixed(1), y: height.toFixed(1), "text-anchor": anchor}, "fill:var(--muted)");
    made.textContent = words;
    return made;
  };
  const rule = (x1, y1, x2, y2, style) => drawn("line",
    {x1: x1.toFixed(1), y1: y1.toFixed(1), x2: x2.toFixed(1), y2: y2.toFixed(1)}, style);
  const grid = "stroke:var(--grid);stroke-width:1";
  const ticks = [
    ...ticksOf([from, to], Math.max(2, Math.floor(area.w / 70))).flatMap(({value, label}) => [
      rule(x(value), area.y, x(value), area.y + area.h, grid),
      text(x(value), area.y + area.h + 12, value > to - 1e-9 && chart.xLabel ? "end" : "middle", chart.xLabel ? chart.xLabel(label) : label)]),
    ...(chart.hasNoScale ? [] : ticksOf(chart.range, Math.max(2, Math.floor(area.h / 26)), chart.isLogarithmic).flatMap(({value, label}) => [
      rule(area.x, y(value), area.x + area.w, y(value), grid), text(area.x - 4, y(value) + 3.5, "end", label)]))];
  const isZeroIn = !chart.isLogarithmic && least < 0 && most > 0;
  if (isZeroIn) ticks.push(rule(area.x, y(0), area.x + area.w, y(0), "stroke:var(--muted);stroke-width:0.7"));
  const clip = `area-${svgChart.made = (svgChart.made || 0) + 1}`;
  const legend = named.map((line, i) => {
    const height = look.height + 16 * i + 6;
    return svgElement("g", {}, drawn("line", {x1: area.x, y1: height - 4, x2: area.x + 26, y2: height - 4},
      `stroke:${line.colour};stroke-width:2.5` + (line.dash ? `;stroke-dasharray:${line.dash.join(" ")}` : "")),
    text(area.x + 34, height, "start", line.name));
  });
  const whole = look.height + (named.length ? 16 * named.length + 4 : 0);
  const title = svgElement("title", {});
  title.textContent = chart.title;
  return svgElement("svg", {viewBox: `0 0 ${look.width} ${whole}`, class: "chart", "font-size": 11, "font-family": "inherit",
    role: "img", "aria-label": chart.title}, title,
  svgElement("clipPath", {id: clip}, svgElement("rect", {x: area.x, y: area.y, width: area.w, height: area.h})),
  ...(look.isTitled ? [text(area.x, 14, "start", chart.title)] : []), ...ticks,
  ...(chart.verticals || []).map((one) => rule(x(one.x), area.y, x(one.x), area.y + area.h,
    `stroke:${one.colour};stroke-width:1.2;stroke-dasharray:${one.dash || "3 3"}`)),
  svgElement("g", {"clip-path": `url(#${clip})`}, ...lines.flatMap((line) => svgOfLine(line, {xs, from, to, place}))),
  text(area.x + area.w / 2, look.height - 4, "middle", chart.xName || ""), ...legend);
}
