// SPDX-License-Identifier: MIT
// The live view: a connection to the program, the picture, and the figures beside it.

const kFiguresEvery = 200;   // [ms]
const kLongestRetry = 5000;  // [ms]

class LiveView {
  constructor() {
    this.trial = null;
    this.posture = null;
    this.isNew = false;
    this.received = new RateCounter();
    this.drawn = new RateCounter();
    this.retry = 250;
    this.angles = new LiveAngles();
    this.troubles = [];  // counts as they were some time ago
    this.scene = null;
    if (hasWebGl()) {
      this.scene = new Scene(byId("scene"), () => { this.isNew = true; });
      this.scene.options.beside = false;
      new ResizeObserver(() => { this.isNew = true; }).observe(byId("stage"));
    } else {
      byId("no-webgl").hidden = false;
      byId("no-webgl").textContent = "This browser shows no three-dimensional pictures (WebGL is missing or " +
        "switched off). The figures are complete without.";
      byId("scene").hidden = true;
    }
    for (const [id, name] of [["show-body", "body"], ["show-residuals", "residuals"]]) {
      byId(id).addEventListener("change", (event) => {
        if (!this.scene || !this.trial) return;
        this.scene.options[name] = event.target.checked;
        this.scene.setLook();
        this.isNew = true;
      });
    }
    byId("reset-camera").addEventListener("click", () => {
      if (this.scene && this.trial) this.scene.resetCamera(this.trial.middle());
    });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      if (this.scene && this.trial) this.scene.setLook();
    });
    this.connect();
    requestAnimationFrame(() => this.draw());
    setInterval(() => this.showFigures(), kFiguresEvery);
  }

  connect() {
    const scheme = location.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(`${scheme}//${location.host}${location.pathname}`);
    socket.addEventListener("message", (event) => this.take(JSON.parse(event.data)));
    socket.addEventListener("open", () => {
      this.retry = 250;
      this.say("connected; nobody has been seen yet", false);
    });
    socket.addEventListener("close", () => {
      this.say("no connection to the program; it has ended or is out of reach", true);
      setTimeout(() => this.connect(), this.retry);
      this.retry = Math.min(2 * this.retry, kLongestRetry);
    });
  }

  say(text, isLost) {
    const stage = byId("stage-text");
    if (stage.textContent !== text) stage.textContent = text;
    stage.classList.toggle("lost", isLost);
  }

  take(message) {
    if (message.model) {
      this.showBody(message);
      return;
    }
    if (!this.trial) return;
    this.posture = message;
    this.trial.take(message);
    this.angles.take(message);
    this.received.add(performance.now());
    this.isNew = true;
  }

  showBody(body) {
    this.body = body;
    this.trial = new LiveTrial(body);
    this.hasPlace = false;
    this.angles.show(body.anatomy || []);
    this.bars = this.trial.labels.map((label) => {
      const bar = element("i", {class: "distance"});
      const value = element("span", {});
      const row = element("div", {title: label}, bar, element("span", {}, label), value);
      return {row, bar, value};
    });
    replaceContent(byId("marker-bars"), ...this.bars.map((one) => one.row));
    if (!this.scene) return;
    this.scene.show(this.trial);
    byId("pale-legend").hidden = !this.scene.figures[0].body.hasPaleLimb;
    this.scene.setShown((contender) => this.isShown(contender));
    this.scene.resetCamera(this.trial.middle());
  }

  // Whether the body of this index is tracked.
  isShown(index) {
    return index === 0 ? this.trial.isTracking : this.trial.objects[index - 1].isTracking;
  }

  draw() {
    requestAnimationFrame(() => this.draw());
    if (!this.scene || !this.trial || !this.isNew) return;
    this.isNew = false;
    const {isTracking} = this.trial;
    const isNews = ({group}, index) => group.visible !== this.isShown(index);
    if (this.scene.figures.some(isNews)) this.scene.setShown((contender) => this.isShown(contender));
    const middle = this.trial.middle();
    if (isTracking && !this.hasPlace) {
      this.hasPlace = true;
      this.scene.resetCamera(middle);
    } else if (isTracking && byId("follow").checked) {
      this.scene.moveCamera(middle.map((value, axis) => value - this.followed[axis]));
    }
    this.followed = middle;
    this.scene.setFrame(0);
    this.scene.draw();
    this.drawn.add(performance.now());
  }

  showFigures() {
    const posture = this.posture;
    if (!posture) return;
    const now = performance.now();
    this.say(posture.stage, false);
    byId("gathered").hidden = posture.progress >= 1;
    byId("gathered").value = posture.progress;
    const count = (state) => this.trial.states.filter((one) => one === state).length;
    const rows = [
      [this.body.anatomy.length ? "Person" : "Tracked", `${this.body.body}${this.body.calibrated ? ", calibrated" : ""}`],
      ...this.trial.objects.map(({name, isTracking}) => ["Object", `${name}${isTracking ? "" : ", not seen"}`]),
      ["Frame", `${posture.frame} at ${formatNumber(posture.time, 2)} s`],
      ["Rate of the source", this.body.rate ? `${formatNumber(this.body.rate, 1)} Hz` : "–"],
      ["Shown here", `${this.received.rate(now)} received, ${this.drawn.rate(now)} drawn a second`],
      ["Delay in the program", `${formatNumber(posture.delay_ms, 2)} ms`],
      ["Frames dropped", String(posture.dropped)],
      ["Frames lost on the way", String(posture.lost)],
      ["Markers seen", `${count(kStates.used)} of ${this.trial.labels.length}`],
      ["Markers wrong", String(count(kStates.wrong))],
      ["Mean distance", formatMillimetres(this.meanDistance())],
    ];
    replaceContent(byId("figures"),
      ...rows.flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value)]));
    this.showBars();
    this.showWrong(now);
    this.angles.refresh();
  }

  // In words, what is not as it should be in this moment, or was not in the last seconds.
  showWrong(now) {
    const {posture, trial} = this;
    const kRecently = 5000;  // [ms]
    this.troubles.push({now, dropped: posture.dropped, lost: posture.lost});
    while (this.troubles[0].now < now - kRecently) this.troubles.shift();
    const before = this.troubles[0];
    const of = (state) => trial.labels.filter((_, i) => trial.states[i] === state);
    const named = (labels) => labels.slice(0, 6).join(", ") + (labels.length > 6 ? `, and ${labels.length - 6} more` : "");
    const wrong = of(kStates.wrong);
    const hidden = of(kStates.hidden);
    const mean = this.meanDistance();
    const texts = [];
    if (!posture.tracking) texts.push(this.body.anatomy.length ? "nobody is tracked" : `${this.body.body} is not tracked`);
    for (const {name, isTracking} of trial.objects) if (!isTracking) texts.push(`${name} is not tracked`);
    if (wrong.length) texts.push(`${plural(wrong.length, "marker")} not where the label says: ${named(wrong)}`);
    if (hidden.length) texts.push(`${plural(hidden.length, "marker")} not seen: ${named(hidden)}`);
    if (mean > (this.body.calibrated ? 0.02 : 0.055)) texts.push(`markers are ${formatMillimetres(mean)} from the model on average: is it this person's?`);
    if (posture.dropped > before.dropped) texts.push(`${posture.dropped - before.dropped} frames were dropped for newer ones in the last 5 s`);
    if (posture.lost > before.lost) texts.push(`${posture.lost - before.lost} frames were lost on the way in the last 5 s`);
    replaceContent(byId("wrong"), ...(texts.length ? texts.map((text) => element("li", {}, text))
      : [element("li", {class: "fine"}, "nothing")]));
  }

  meanDistance() {
    const known = this.trial.distances.filter((value) => !Number.isNaN(value));
    return known.length ? known.reduce((sum, value) => sum + value, 0) / known.length : NaN;
  }

  showBars() {
    const kWidest = 0.1;  // [m]
    this.bars.forEach(({row, bar, value}, i) => {
      const state = this.trial.states[i];
      const distance = this.trial.distances[i];
      row.className = state === kStates.hidden ? "hidden" : state === kStates.wrong ? "wrong" : "";
      bar.style.width = Number.isNaN(distance) ? "0" : `${Math.min(100, 100 * distance / kWidest)}%`;
      value.textContent = state === kStates.hidden ? "hidden"
        : state === kStates.wrong ? "wrong" : formatMillimetres(distance);
    });
  }
}

const view = new LiveView();
// For tests, and for who looks at the data in the browser's console.
window.mmmLive = {
  get posture() { return view.posture; },
  get body() { return view.body; },
  get drawn() { return view.drawn.rate(performance.now()); },
  drawNow: () => view.scene.draw(),
  get received() { return view.received.rate(performance.now()); },
};
