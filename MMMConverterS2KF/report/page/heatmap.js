// SPDX-License-Identifier: MIT
// Residuals as a map: a row for each marker, time to the right.

const kRowHeight = 14;  // [px], as in the style sheet

// Colours from nothing to much; lightness runs one way, so that it needs no sight of hues.
function heatRamp() {
  const stops = themeColour("heat").split(/\s+/).map((hex) =>
    [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16)));
  const ramp = new Uint8Array(3 * 256);
  for (let i = 0; i < 256; ++i) {
    const place = i / 255 * (stops.length - 1);
    const from = Math.min(Math.floor(place), stops.length - 2);
    for (let channel = 0; channel < 3; ++channel) {
      ramp[3 * i + channel] = stops[from][channel] +
        (place - from) * (stops[from + 1][channel] - stops[from][channel]);
    }
  }
  return ramp;
}

class HeatMap {
  constructor(view) {
    this.view = view;
    this.canvas = byId("heat-map");
    this.redraw = oncePerPicture(() => this.draw());
    byId("heat-converter").addEventListener("change", () => this.refresh());
    byId("heat-order").addEventListener("change", () => this.refresh());
    this.canvas.addEventListener("pointermove", (event) => this.read(event));
    this.canvas.addEventListener("click", (event) => this.view.seek(this.placeOf(event).frame));
    byId("heat-save").append(saveButton("CSV", "Save the numbers shown", () => this.saveNumbers()),
      saveButton("PNG", "Save the picture", () => saveCanvas("residuals", this.canvas)));
    // Paper takes the picture as it is, in another width.
    new ResizeObserver(() => {
      if (!matchMedia("print").matches) this.redraw();
    }).observe(byId("heat-stage"));
  }

  // A row for each frame, [mm].
  saveNumbers() {
    const {trial} = this.view;
    const rows = Array.from({length: trial.frames}, (_, k) =>
      [trial.time(k), ...this.rows.map((row) => 1000 * row.distances[k])]);
    saveText(`residuals ${this.track.name}.csv`, "text/csv",
      csvOf(["time [s]", ...this.rows.map((row) => `${row.name} [mm]`)], rows));
  }

  show(trial) {
    this.window = null;
    replaceContent(byId("heat-converter"),
      ...trial.tracks.map((track, i) => option(i, track.name)));
    this.largest = this.commonScale(trial);
  }

  // One scale for all converters, so that their maps compare: the largest 99th percentile, rounded
  // up [m].
  commonScale(trial) {
    let largest = 0.001;
    for (const track of trial.tracks) {
      const step = Math.max(1, Math.floor(track.distances.length / 50000));
      const some = [];
      for (let i = 0; i < track.distances.length; i += step) {
        if (!Number.isNaN(track.distances[i])) some.push(track.distances[i]);
      }
      some.sort((a, b) => a - b);
      largest = Math.max(largest, some[Math.floor(0.99 * (some.length - 1))] || 0);
    }
    return Math.ceil(largest * 100) / 100;
  }

  refresh() {
    this.track = this.view.trial.tracks[Number(byId("heat-converter").value) || 0];
    const frames = this.view.trial.frames;
    this.rows = this.view.trial.labels.map((name, label) => {
      const distances = this.track.distances.subarray(label * frames, (label + 1) * frames);
      const seen = distances.filter((distance) => !Number.isNaN(distance));
      return {name, label, distances, mean: this.meanOf(label, seen)};
    });
    const order = byId("heat-order").value;
    const last = (mean) => Number.isNaN(mean) ? -1 : mean;
    if (order === "mean") this.rows.sort((a, b) => last(b.mean) - last(a.mean));
    if (order === "name") this.rows.sort((a, b) => a.name.localeCompare(b.name));
    replaceContent(byId("heat-names"), ...this.rows.map((row) => element("div", {title: row.name},
      element("span", {class: "name"}, row.name),
      element("span", {class: "mean"}, formatNumber(1000 * row.mean, 1)))));
    this.drawScale();
    this.redraw();
  }

  // Over all frames, drawn or not.
  meanOf(label, seen) {
    const means = this.track.labelMeans;
    if (means) return means[label] === null ? NaN : means[label];
    return seen.reduce((sum, one) => sum + one, 0) / seen.length;
  }

  // The frames that are seen: zoomed as the plots.
  get range() {
    return this.window || [0, this.view.trial.frames - 1];
  }

  zoom(source, range) {
    const trial = this.view.trial;
    this.window = [trial.frameAt(range[0]), trial.frameAt(range[1])];
    this.redraw();
  }

  draw() {
    const trial = this.view.trial;
    if (!trial) return;
    const width = Math.max(1, Math.round(byId("heat-stage").clientWidth));
    this.canvas.width = width;
    this.canvas.height = kRowHeight * this.rows.length;
    this.canvas.style.height = `${this.canvas.height}px`;
    const pen = this.canvas.getContext("2d");
    const picture = pen.createImageData(width, this.canvas.height);
    const ramp = heatRamp();
    const [first, last] = this.range;
    const hiddenInk = [1, 3, 5].map((i) => parseInt(themeColour("text").slice(i, i + 2), 16));
    this.rows.forEach((row, place) => {
      for (let x = 0; x < width; ++x) {
        const from = first + Math.floor(x / width * (last - first + 1));
        const to = Math.max(from + 1, first + Math.floor((x + 1) / width * (last - first + 1)));
        const value = meanBetween(row.distances, from, to);
        if (Number.isNaN(value)) continue;
        const colour = 3 * Math.min(255, Math.round(255 * value / this.largest));
        const hidden = trial.isHidden(row.label, from);
        for (let y = 0; y < kRowHeight - 1; ++y) {
          const pixel = 4 * ((place * kRowHeight + y) * width + x);
          const isLine = hidden && y >= kRowHeight - 4 && y < kRowHeight - 2;
          for (let channel = 0; channel < 3; ++channel) {
            picture.data[pixel + channel] = isLine ? hiddenInk[channel] : ramp[colour + channel];
          }
          picture.data[pixel + 3] = 255;
        }
      }
    });
    pen.putImageData(picture, 0, 0);
    this.placeCursor();
  }

  drawScale() {
    const canvas = byId("heat-scale");
    const pen = canvas.getContext("2d");
    const ramp = heatRamp();
    for (let i = 0; i < 256; ++i) {
      pen.fillStyle = `rgb(${ramp[3 * i]}, ${ramp[3 * i + 1]}, ${ramp[3 * i + 2]})`;
      pen.fillRect(i, 0, 1, canvas.height);
    }
    byId("scale-low").textContent = "0 mm";
    byId("scale-high").textContent = `${formatNumber(1000 * this.largest, 0)} mm and more`;
  }

  placeOf(event) {
    const box = this.canvas.getBoundingClientRect();
    const [first, last] = this.range;
    const frame = first + Math.floor((event.clientX - box.left) / box.width * (last - first + 1));
    const place = Math.floor((event.clientY - box.top) / box.height * this.rows.length);
    const within = (value, most) => Math.min(Math.max(value, 0), most);
    return {frame: within(frame, this.view.trial.frames - 1), row: this.rows[within(place, this.rows.length - 1)]};
  }

  read(event) {
    const {frame, row} = this.placeOf(event);
    const distance = row.distances[frame];
    const state = Number.isNaN(distance) ? "not measured" : formatMillimetres(distance);
    byId("heat-readout").textContent = `${row.name} · ${formatNumber(this.view.trial.time(frame), 2)} s · ${state}` +
      (this.view.trial.isHidden(row.label, frame) ? " · hidden from the converters" : "");
  }

  setFrame() {
    this.placeCursor();
  }

  placeCursor() {
    const [first, last] = this.range;
    const share = (this.view.frame - first + 0.5) / (last - first + 1);
    byId("heat-cursor").hidden = share < 0 || share > 1;
    byId("heat-cursor").style.transform = `translateX(${share * byId("heat-stage").clientWidth}px)`;
  }
}

// Over those that are numbers; NaN where there is none.
function meanBetween(values, from, to) {
  let sum = 0;
  let count = 0;
  for (let i = from; i < to; ++i) {
    if (Number.isNaN(values[i])) continue;
    sum += values[i];
    ++count;
  }
  return count ? sum / count : NaN;
}
