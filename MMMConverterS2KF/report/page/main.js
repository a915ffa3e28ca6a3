// SPDX-License-Identifier: MIT
// What is shown, and who is told when it changes.

class View {
  constructor(sections) {
    this.sections = sections;
    this.frame = 0;
    this.shown = new Set();  // converters, by index
    this.trial = null;
    this.player = new Player(this);
    this.heatMap = new HeatMap(this);
    this.parts = [this.player, new Plots(this), this.heatMap, new Stills(this),
      new GaitPart(this), new PersonPart(), new ReliabilityPart(this)];
    byId("trial").addEventListener("change", (event) => this.showTrial(Number(event.target.value)));
  }

  get shownTracks() {
    return this.trial.tracks.filter((track) => this.shown.has(track.contender));
  }

  // Of the recording that is shown, drawn or not.
  get recordedFrames() {
    return this.section.figures.trials[this.section.trials.indexOf(this.trial)].frames;
  }

  showSection(index) {
    this.section = this.sections[index];
    this.section.load();
    Array.from(byId("sections").children).forEach((button, i) =>
      button.setAttribute("aria-pressed", i === index));
    Array.from(byId("summary").children).forEach((summary, i) =>
      summary.classList.toggle("other", i !== index));
    replaceContent(byId("notes"), makeNotes(this.section));
    replaceContent(byId("configurations"), ...makeConfigurations(this.section));
    const drawn = this.section.trials.map((trial, i) => i)
      .filter((i) => this.section.trials[i].tracks.length > 0);
    byId("view").hidden = drawn.length === 0;
    this.player.pause();
    this.trial = null;
    if (drawn.length === 0) return;
    replaceContent(byId("trial"), ...drawn.map((i) => option(i, this.section.trials[i].name)));
    this.showTrial(drawn[0]);
  }

  showTrial(index) {
    this.trial = this.section.trials[index];
    byId("trial").value = index;
    this.frame = this.trial.firstSeen;
    this.shown = new Set(this.trial.tracks.map((track) => track.contender));
    this.listConverters();
    replaceContent(byId("thinned"), describeThinning(this.trial, this.recordedFrames));
    byId("viewbar").hidden = drawnCount(this.section) < 2 && this.trial.tracks.length < 2;
    byId("thinned").hidden = this.trial.every === 1 && this.trial.optimumEvery === 1;
    for (const part of this.parts) part.show(this.trial);
    this.refresh();
  }

  listConverters() {
    this.distances = [];
    replaceContent(byId("converters"), ...this.trial.tracks.map((track) => {
      const box = element("input", {type: "checkbox", checked: true});
      box.addEventListener("change", () => this.setShown(track.contender, box.checked));
      const distance = element("output", {title: "Mean marker distance in this frame of the first run"});
      this.distances.push({track, distance});
      return element("label", {class: "converter"}, box, converterSwatch(track.contender), track.name, distance);
    }));
  }

  setShown(contender, isShown) {
    if (isShown) this.shown.add(contender); else this.shown.delete(contender);
    this.refresh();
  }

  // Colours or what is shown have changed.
  refresh() {
    if (!this.trial) return;
    for (const part of this.parts) if (part.refresh) part.refresh();
    this.seek(this.frame);
  }

  seek(frame) {
    if (!this.trial) return;
    this.frame = Math.min(Math.max(Math.round(frame), 0), this.trial.frames - 1);
    for (const {track, distance} of this.distances) {
      distance.textContent = formatMillimetres(track.frameMean(this.frame));
    }
    for (const part of this.parts) part.setFrame(this.frame);
  }

  // On paper, where nothing can wait.
  print() {
    if (this.trial) this.heatMap.draw();
  }

  describe(frame) {
    const {trial} = this;
    const hidden = trial.labels.filter((_, label) => trial.isHidden(label, frame)).length;
    return [trial.hidesMarkers ? `${plural(hidden, "marker")} hidden` : "",
      this.section.figures.options.runs > 1 ? "the first run" : "", trial.ground ? trial.ground.describe(frame) : ""];
  }

  // A part was zoomed to a range of time; the others follow.
  zoom(source, range) {
    if (this.zooming) return;
    this.zooming = true;
    for (const part of this.parts) if (part.zoom) part.zoom(source, range);
    this.zooming = false;
  }
}

// Recordings of a section that have a picture.
function drawnCount(section) {
  return section.trials.filter((trial) => trial.tracks.length > 0).length;
}

// What a page of a long recording leaves out.
function describeThinning(trial, frames) {
  const texts = [];
  if (trial.every > 1) {
    texts.push(`Of the ${frames} frames one in ${trial.every} is drawn; bands of the plots reach from the least ` +
      "to the largest value of all frames. The figures in the table are those of all frames.");
  }
  if (trial.optimumEvery > 1) {
    texts.push(`The optimum is computed for one frame in ${trial.optimumEvery}, and wherever it decides whether a ` +
      "frame is good or lost; it is linear between these.");
  }
  return texts.join(" ");
}

function listSections(view) {
  byId("program").textContent = view.sections.length ? view.sections[0].figures.program : "";
  replaceContent(byId("summary"), ...view.sections.map((section) =>
    makeSummary(section, view.sections.length === 1 && section.title === document.title)));
  if (view.sections.length < 2) return;
  replaceContent(byId("sections"), ...view.sections.map((section, i) => {
    const button = element("button", {type: "button", "aria-pressed": "false"},
      element("strong", {}, section.title), element("span", {},
        (section.verdict ? `${section.verdict}. ` : "") + verdictOf(section.figures)));
    button.addEventListener("click", () => view.showSection(i));
    return button;
  }));
}

function start() {
  const view = new View(readSections());
  const patient = document.querySelector("script.patient");
  if (patient) showPatient(JSON.parse(patient.textContent));
  listSections(view);
  if (view.sections.length) view.showSection(0);
  redrawWithColours(view);
  drawOnPaper(view);
  // For tests, and for who looks at the data in the browser's console.
  window.mmmReport = {
    figures: view.sections.map((section) => section.figures),
    get frame() { return view.frame; },
    get every() { return view.trial ? view.trial.every : 1; },
    get frames() { return view.trial ? view.trial.frames : 0; },
    get arrows() {
      const ground = view.player.scene ? view.player.scene.ground : null;
      return ground ? ground.arrows.map((arrow) => arrow.said(ground.group.visible)) : [];
    },
    get reach() { return view.player.scene ? view.player.scene.reach : null; },
    get playing() { return view.player.playing; },
    pool: poolGroups,
    play: () => view.player.play(),
    pause: () => view.player.pause(),
    seek: (frame) => view.seek(frame),
    showSection: (index) => view.showSection(index),
    showTrial: (index) => view.showTrial(index),
  };
  markReady();
}

start();
