// The organ that was picked, found or stepped to: its names and its numbers.
import { ask } from "./api.js";
import { short } from "./charts.js";

function cell(tag, text, title) {
  const node = document.createElement(tag);
  node.textContent = text;
  if (title !== undefined) node.title = title;
  return node;
}

function row(head, ...values) {
  const line = document.createElement("tr"), name = cell("th", head);
  name.scope = "row";
  line.append(name, ...values);
  return line;
}

const number = (value) => cell("td", short(value), String(value));
const text = (value) => Object.assign(cell("td", value), { className: "text" });
const unitText = (unit) => Object.assign(cell("td", unit), { className: "unit" });

export class OrganPanel {
  constructor({ state, result, picked, went }) {
    Object.assign(this, { state, result, picked, went });
    this.row = null;
    this.box = document.getElementById("organ");
    this.empty = this.box.innerHTML;
    const search = document.getElementById("search");
    let later;
    search.addEventListener("input", () => { clearTimeout(later), later = setTimeout(() => this.search(search.value), 150); });
  }
  async search(wanted) {
    const list = document.getElementById("found"), count = document.getElementById("found-count");
    list.replaceChildren(), count.textContent = "";
    if (!wanted.trim()) return;
    const found = await ask("search", { text: wanted.trim(), result: this.result() });
    count.textContent = found.total === 0 ? "No organ of that name" : found.total > found.organs.length ? `${found.total} organs; the first ${found.organs.length}` : found.total === 1 ? "1 organ" : `${found.total} organs`;
    list.replaceChildren(...found.organs.map((organ) => {
      const line = document.createElement("li"), button = cell("button", organ.name);
      button.type = "button";
      button.append(cell("small", organ.placement));
      button.addEventListener("click", async () => {
        for (const other of list.querySelectorAll("button")) other.removeAttribute("aria-current");
        button.setAttribute("aria-current", "true");
        await this.go(organ.organ);
        this.goTo();
      });
      line.append(button);
      return line;
    }));
  }
  async go(organ) {
    this.show(await ask("organ", { organ, state: this.state(), result: this.result() }));
  }
  async refresh() {
    if (this.row === null) return;
    try { await this.go(this.row); } catch { this.forget(); }
  }
  step(by, count) {
    this.go(this.row === null ? 0 : (this.row + by + count) % count);
  }
  goTo() {
    if (this.low) this.went(this.low, this.high);
  }
  forget() {
    this.row = this.low = null;
    this.box.innerHTML = this.empty;
    delete this.box.dataset.organ;
    this.picked();
  }
  /// Answer of pick or organ.
  show(o, title) {
    if (o.organ === null) return this.forget();
    this.row = o.organ, this.low = o.low, this.high = o.high;
    this.box.dataset.organ = o.organ;
    const names = document.createElement("table");
    names.append(cell("caption", o.name), row("Type", text(o.type)), row("Plant", text(`${o.plant}, ${o.placement}`)), row("Area", text(`${short(o.area)} m²`)), row("Facets", text(String(o.facets))));
    names.querySelectorAll("td")[2].title = String(o.area);
    if (o.value !== undefined && o.value !== null) names.append(row(title || "Shown here", text(short(o.value))));
    this.box.replaceChildren(names, this.numbers("Whole organ", o, [["Absorbed", o.absorbed, (unit) => unit.replace(/ m⁻²/, "")], ["Absorbed per area", o.absorbed_per_area]]));
    if (o.facet) this.box.append(this.numbers(`Facet ${o.facet.row}, ${o.side} seen`, { ...o.facet, bands: o.bands, units: o.units }, [["Absorbed per area", o.facet.absorbed]]));
    const button = cell("button", "Go there (F)");
    button.type = "button";
    button.addEventListener("click", () => this.goTo());
    this.box.append(button);
    this.picked();
  }
  numbers(caption, o, rows) {
    const table = document.createElement("table"), head = document.createElement("tr");
    table.append(cell("caption", caption));
    head.append(cell("th", ""), ...o.bands.map((band) => Object.assign(cell("td", band), { scope: "col" })), cell("td", "unit"));
    table.append(head);
    const add = (name, values, unit) => { if (values) table.append(row(name, ...values.map(number), unitText(unit))); };
    for (const [name, values, change] of rows) add(name, values, (change ?? ((u) => u))(o.units[0]));
    add("Irradiance, front", o.irradiance?.front, o.units[0]);
    add("Irradiance, back", o.irradiance?.back, o.units[0]);
    if (o.sunlit) table.append(row("Sunlit, front / back", text(`${short(o.sunlit.front)} / ${short(o.sunlit.back)}`)));
    return table;
  }
}
