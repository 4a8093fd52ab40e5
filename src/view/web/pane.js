// One picture: quick small frames while something changes, then refinement until nothing more comes.
import { askPicture, Refused } from "./api.js";

const wantedMilliseconds = 75;   // of a frame while moving: 10 a second and some room
const mostPixels = 2.2e6;        // of a finished frame
const settle = 140;              // milliseconds without a change before refinement begins

export class Pane {
  constructor(figure, name, parameters, report) {
    this.figure = figure;
    this.canvas = figure.querySelector("canvas");
    this.context = this.canvas.getContext("2d", { alpha: false });
    this.name = `${name}-${Math.random().toString(36).slice(2)}`;
    this.parameters = parameters;
    this.report = report;
    this.turn = 0;
    this.scale = 0.4;
    this.changedAt = -1e9;
    this.stale = false;
    this.running = false;
    new ResizeObserver(() => this.resize()).observe(this.canvas);
  }
  get visible() { return !this.figure.hidden && this.canvas.clientWidth > 0; }
  size() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    let width = Math.max(16, this.canvas.clientWidth * ratio), height = Math.max(16, this.canvas.clientHeight * ratio);
    const shrink = Math.min(1, Math.sqrt(mostPixels / (width * height)));
    return [Math.max(16, Math.round(width * shrink)), Math.max(16, Math.round(height * shrink))];
  }
  resize() {
    const [width, height] = this.size();
    if (!this.visible || (this.canvas.width === width && this.canvas.height === height)) return;
    const old = this.canvas.width > 1 ? document.createElement("canvas") : null;
    if (old) {
      old.width = this.canvas.width, old.height = this.canvas.height;
      old.getContext("2d").drawImage(this.canvas, 0, 0);
    }
    this.canvas.width = width, this.canvas.height = height;
    if (old) this.context.drawImage(old, 0, 0, width, height);
    this.change();
  }
  /// Something that the picture shows is different now.
  change() {
    this.changedAt = performance.now();
    this.stale = true;
    ++this.turn;
    this.canvas.dataset.done = "0";
    if (this.refining) this.refining.abort();
    if (!this.running) this.run();
  }
  show(frame, quick) {
    this.context.imageSmoothingQuality = "high";
    this.context.drawImage(frame.picture, 0, 0, this.canvas.width, this.canvas.height);
    frame.picture.close();
    const data = this.canvas.dataset;
    data.samples = quick ? "0" : String(frame.samples);
    data.done = frame.done ? "1" : "0";
    data.frames = String(Number(data.frames ?? 0) + 1);
    this.report(frame, quick);
  }
  async run() {
    this.running = true;
    try {
      while (this.visible) {
        const [width, height] = this.size();
        if (this.stale) {
          this.stale = false;
          const begin = performance.now();
          const small = { width: Math.max(16, Math.round(width * this.scale)), height: Math.max(16, Math.round(height * this.scale)) };
          const frame = await askPicture({ ...this.parameters(), ...small, quick: true, client: this.name, turn: this.turn });
          const took = performance.now() - begin;
          this.scale = Math.min(1, Math.max(0.12, this.scale * Math.min(1.25, Math.max(0.6, Math.sqrt(wantedMilliseconds / took)))));
          this.canvas.dataset.quick = took.toFixed(0);
          this.show(frame, true);
          continue;
        }
        const rest = this.changedAt + settle - performance.now();
        if (rest > 0) {
          await new Promise((resolve) => setTimeout(resolve, Math.min(rest, 20)));
          continue;
        }
        if (this.canvas.dataset.done === "1") break;
        this.refining = new AbortController();
        const turn = this.turn;
        try {
          const parameters = { ...this.parameters(), width, height, time: 150, client: this.name, turn };
          const frame = await askPicture(parameters, this.refining.signal);
          if (turn === this.turn) this.show(frame, false);
          if (frame.draft && frame.samples >= 4) await new Promise((resolve) => setTimeout(resolve, 150));
        } catch (error) {
          if (error.name !== "AbortError") throw error;
        }
      }
    } catch (error) {
      this.report(null, false, error instanceof Refused ? error.message : "The viewer does not answer");
      this.canvas.dataset.done = "0";
      if (!(error instanceof Refused) || error.status === 503) setTimeout(() => this.change(), 1500);
    } finally {
      this.running = false;
      if (this.stale && this.visible) setTimeout(() => { if (!this.running) this.run(); }, 50);
    }
  }
  async picture() {
    const [width, height] = this.size();
    return { ...this.parameters(), width, height, time: 2000, format: "png" };
  }
}
