// SPDX-License-Identifier: MIT
// The player: time, its controls and keys, and the scene.

class Player {
  // view: what is shown; it calls setFrame() of all parts when a frame is asked for, and says more of a frame by
  // describe().
  constructor(view) {
    this.view = view;
    this.playing = false;
    this.redraw = oncePerPicture(() => this.draw());
    this.scene = null;
    if (hasWebGl()) {
      this.scene = new Scene(byId("scene"), this.redraw);
      byId("scene").addEventListener("pointerdown", () => byId("player").focus({preventScroll: true}));
      new ResizeObserver(() => {
        this.nameParts();
        this.redraw();
      }).observe(byId("stage"));
    } else {
      byId("no-webgl").hidden = false;
      byId("no-webgl").textContent = "This browser shows no three-dimensional pictures (WebGL is missing " +
        "or switched off). Figures, plots and the heat map are complete without.";
      byId("scene").hidden = true;
    }
    this.listen();
  }

  listen() {
    byId("play").addEventListener("click", () => this.toggle());
    byId("scrub").addEventListener("input", (event) => this.view.seek(Number(event.target.value)));
    byId("player").addEventListener("keydown", (event) => this.onKey(event));
    byId("reset-camera").addEventListener("click", () => this.resetCamera());
    byId("save-picture").addEventListener("click", () => this.savePicture());
    const choices = {"show-body": "body", "show-residuals": "residuals", "show-truth": "truth",
      "show-forces": "forces"};
    for (const [id, name] of Object.entries(choices)) {
      byId(id).addEventListener("change", (event) => this.setOption(name, event.target.checked));
    }
    byId("arrangement").addEventListener("change", (event) =>
      this.setOption("beside", event.target.value === "beside"));
  }

  setOption(name, value) {
    if (!this.scene) return;
    this.scene.options[name] = value;
    this.refresh();
  }

  onKey(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const isField = event.target.matches("select, input[type=radio]");
    const isButton = event.target.matches("button, input[type=checkbox]");
    const step = event.shiftKey ? 10 : 1;
    const frame = this.view.frame;
    const actions = {
      " ": () => this.toggle(),
      ArrowLeft: () => this.view.seek(frame - step),
      ArrowRight: () => this.view.seek(frame + step),
      Home: () => this.view.seek(0),
      End: () => this.view.seek(this.view.trial.frames - 1),
    };
    const action = actions[event.key];
    if (!action || isField || (isButton && event.key === " ")) return;
    event.preventDefault();
    action();
  }

  show(trial) {
    this.pause();
    byId("scrub").max = trial.frames - 1;
    byId("hidden-legend").hidden = !trial.hidesMarkers;
    byId("truth-option").hidden = !trial.truth;
    byId("residuals-option").hidden = byId("marker-legend").hidden = trial.labels.length === 0;
    showGround(trial.ground);
    byId("arrangement").hidden = trial.tracks.length < 2;
    if (!this.scene) return;
    this.scene.show(trial);
    byId("pale-legend").hidden = !this.scene.figures.some((one) => one.body.hasPaleLimb);
    this.followed = trial.middle(this.view.frame);
    this.resetCamera();
  }

  resetCamera() {
    if (this.scene) this.scene.resetCamera(this.view.trial.middle(this.view.frame));
  }

  // Colours or what is shown have changed.
  refresh() {
    if (!this.scene) return;
    this.scene.setShown((contender) => this.view.shown.has(contender));
    this.nameParts();
    this.redraw();
  }

  // Where bodies stand side by side, the name of each.
  nameParts() {
    if (!this.view.trial) return;
    const pictures = this.scene.pictures;
    const columns = this.scene.columns;
    byId("stage-names").style.gridTemplateColumns = `repeat(${columns}, 1fr)`;
    replaceContent(byId("stage-names"), ...(pictures.length < 2 ? [] : pictures.map(([one]) =>
      element("span", {}, converterSwatch(one.track.contender), ...breakable(one.track.name)))));
  }

  setFrame(frame) {
    const trial = this.view.trial;
    byId("scrub").value = frame;
    const time = `${formatNumber(trial.time(frame), 2)} s`;
    const recorded = trial.recorded(frame);
    byId("scrub").setAttribute("aria-valuetext", `frame ${recorded}, ${time}`);
    byId("now").textContent = [time, `frame ${recorded} of ${this.view.recordedFrames}`,
      ...this.view.describe(frame)].filter(Boolean).join(" · ");
    if (this.scene && byId("follow").checked) {
      const middle = trial.middle(frame);
      this.scene.moveCamera(middle.map((value, axis) => value - this.followed[axis]));
    }
    if (this.scene) this.followed = trial.middle(frame);
    this.redraw();
  }

  draw() {
    if (!this.scene || !this.view.trial) return;
    this.scene.setFrame(this.view.frame);
    this.scene.draw();
  }

  savePicture() {
    if (!this.scene || !this.view.trial) return;
    this.draw();  // the canvas keeps its picture until the browser has shown it
    saveCanvas(`${this.view.trial.name} ${formatNumber(this.view.trial.time(this.view.frame), 2)} s`, byId("scene"));
  }

  toggle() {
    if (this.playing) this.pause(); else this.play();
  }

  play() {
    if (this.playing) return;
    if (this.view.frame >= this.view.trial.frames - 1) this.view.seek(0);
    this.setPlaying(true);
    this.lastTick = null;
    this.position = this.view.frame;
    requestAnimationFrame((now) => this.tick(now));
  }

  pause() {
    this.setPlaying(false);
  }

  setPlaying(playing) {
    this.playing = playing;
    byId("play").textContent = playing ? "❚❚" : "▶";
    byId("play").setAttribute("aria-label", playing ? "Pause" : "Play");
  }

  tick(now) {
    if (!this.playing) return;
    const last = this.view.trial.frames - 1;
    // Who moves the frame by hand while it plays, goes on from there.
    if (Math.floor(this.position) !== this.view.frame) this.position = this.view.frame;
    if (this.lastTick !== null) {
      const seconds = Math.min((now - this.lastTick) / 1000, 0.25);
      this.position += seconds * this.view.trial.rate * Number(byId("speed").value);
    }
    this.lastTick = now;
    this.view.seek(Math.min(Math.floor(this.position), last));
    if (this.view.frame >= last) this.pause();
    requestAnimationFrame((next) => this.tick(next));
  }
}
