// Which plants and which types of organs are selected.
import { ask } from "./api.js";

/// "0-3,7" from a set of rows.
export function ranges(rows) {
  const sorted = [...rows].sort((a, b) => a - b), out = [];
  for (let i = 0; i < sorted.length; ) {
    let j = i;
    while (j + 1 < sorted.length && sorted[j + 1] === sorted[j] + 1) ++j;
    out.push(i === j ? `${sorted[i]}` : `${sorted[i]}-${sorted[j]}`);
    i = j + 1;
  }
  return out.join(",");
}

export class SelectionPanel {
  constructor({ result, changed }) {
    this.result = result;
    this.changed = changed;
    this.placements = new Set();
    this.types = new Set();
    this.names = new Map();
    const filter = document.getElementById("plants-filter");
    let later;
    filter.addEventListener("input", () => { clearTimeout(later), later = setTimeout(() => this.list(), 150); });
    document.getElementById("select-none").addEventListener("click", () => {
      this.placements.clear(), this.types.clear();
      for (const box of document.querySelectorAll("#plants input, #types input")) box.checked = false;
      this.tell();
    });
  }
  text() {
    const parts = [];
    if (this.placements.size) parts.push(`placement:${ranges(this.placements)}`);
    if (this.types.size) parts.push(`type:${ranges(this.types)}`);
    return parts.length ? parts.join(";") : undefined;
  }
  async load() {
    const about = await ask("describe"), types = about.results[this.result()].types;
    const before = this.knownTypes?.join("\n");
    this.knownTypes = types;
    if (before !== undefined && before !== types.join("\n")) this.types.clear(), this.placements.clear();
    const box = document.getElementById("types");
    box.replaceChildren(box.querySelector("legend"), ...types.map((name, row) => this.choice(name, row, this.types)));
    await this.list();
    this.tell(true);
  }
  choice(name, row, set, small) {
    const label = document.createElement("label"), box = document.createElement("input");
    box.type = "checkbox";
    box.checked = set.has(row);
    box.addEventListener("change", () => {
      if (box.checked) set.add(row); else set.delete(row);
      this.tell();
    });
    label.append(box, ` ${name}`);
    if (small) label.append(Object.assign(document.createElement("small"), { textContent: small }));
    return label;
  }
  async list() {
    const found = await ask("placements", { text: document.getElementById("plants-filter").value.trim(), result: this.result() });
    const list = document.getElementById("plants");
    list.replaceChildren(...found.placements.map((p) => {
      this.names.set(p.row, p.name);
      const line = document.createElement("li");
      line.append(this.choice(p.name, p.row, this.placements, `${p.organs} organs`));
      return line;
    }));
    if (found.total > found.placements.length) list.append(Object.assign(document.createElement("li"), { className: "quiet", textContent: `… and ${found.total - found.placements.length} more: filter by name` }));
  }
  tell(quietly) {
    const plants = [...this.placements].slice(0, 6).map((row) => this.names.get(row)), types = [...this.types].map((row) => this.knownTypes[row]);
    const more = this.placements.size > 6 ? ` and ${this.placements.size - 6} more` : "";
    const text = [types.join(", "), plants.length ? `of ${plants.join(", ")}${more}` : ""].filter(Boolean).join(" ");
    document.getElementById("selection").textContent = text ? `Selected: ${text}` : "Everything but the ground";
    if (!quietly) this.changed();
  }
}
