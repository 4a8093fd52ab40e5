// Histogram and profile of what is selected.
import { ask, save, saveFile } from "./api.js";
import { drawHistogram, drawProfile, printTheme, short, themeOf, titleOf } from "./charts.js";

export class Statistics {
  constructor({ parameters }) {
    this.parameters = parameters;
    this.turn = 0;
    this.histogram = document.getElementById("histogram");
    this.profile = document.getElementById("profile");
    for (const button of document.querySelectorAll("[data-save]")) button.addEventListener("click", () => this.save(button.dataset.save));
    new ResizeObserver(() => this.draw()).observe(this.histogram);
  }
  /// After a while, so that the first picture comes first.
  change() {
    const turn = ++this.turn;
    setTimeout(async () => {
      if (turn !== this.turn) return;
      try {
        const now = await ask("statistics", this.parameters());
        if (turn !== this.turn) return;
        this.now = now;
        this.draw();
        this.tell();
      } catch (error) {
        document.getElementById("summary").textContent = error.message;
      }
    }, 400);
  }
  draw() {
    if (!this.now) return;
    drawHistogram(this.histogram, this.now, themeOf(this.histogram));
    drawProfile(this.profile, this.now, themeOf(this.profile));
  }
  tell() {
    const s = this.now, p = s.profile, unit = s.title.length > 1 ? ` ${s.title.at(-1)}` : "";
    const power = s.bands.map((band, i) => `${short(s.absorbed[i])} ${band}`).join(", ");
    const summary = s.categories.length ? "" : ` ${titleOf(s).split(" [")[0]}: mean ${short(s.mean)}${unit}, standard deviation ${short(s.deviation)}, from ${short(s.low)} to ${short(s.high)}.`;
    document.getElementById("summary").textContent = `${s.organs.toLocaleString("en")} organs, ${s.facets.toLocaleString("en")} facets, ${short(s.area)} m².${summary}${power ? ` Absorbed in all [W]: ${power}.` : ""}`;
    document.getElementById("summary").dataset.facets = s.facets;
    const table = document.createElement("table"), head = document.createElement("tr");
    for (const name of ["height [m]", "area [m²]", ...(p.mean.length ? [`mean ${titleOf(s)}`] : []), ...s.bands.map((b) => `absorbed ${b} [W]`)])
      head.append(Object.assign(document.createElement("th"), { textContent: name, scope: "col" }));
    table.append(head);
    for (let i = p.area.length - 1; i >= 0; --i) {
      const line = document.createElement("tr"), values = [p.area[i], ...(p.mean.length ? [p.mean[i]] : []), ...s.bands.map((_, b) => p.absorbed[i * s.bands.length + b])];
      line.append(Object.assign(document.createElement("th"), { textContent: `${short(p.height[i])} to ${short(p.height[i + 1])}`, scope: "row" }));
      for (const v of values) line.append(Object.assign(document.createElement("td"), { textContent: short(v) }));
      table.append(line);
    }
    document.getElementById("profile-table").replaceChildren(table);
  }
  async save(name) {
    if (name.endsWith(".csv")) return saveFile(name, name, this.parameters());
    if (!this.now) return;
    const canvas = document.createElement("canvas");
    (name.startsWith("histogram") ? drawHistogram : drawProfile)(canvas, this.now, printTheme);
    canvas.toBlob((blob) => save(name, blob), "image/png");
  }
}
