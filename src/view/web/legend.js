// What the colours mean, over the picture.

export class Legend {
  constructor(box) {
    this.box = box;
    this.title = "";
  }
  show(legend, map) {
    this.box.hidden = legend.kind === "colour";
    this.box.replaceChildren();
    this.title = "";
    if (legend.kind === "colour") return;
    const unit = legend.title.length > 1 ? ` [${legend.title.at(-1)}]` : "";
    const notes = legend.title.slice(1, -1).join(", ");
    this.title = `${legend.title[0]}${unit}`;
    const heading = document.createElement("div");
    heading.textContent = this.title + (notes ? `, ${notes}` : "") + (legend.log ? ", logarithmic" : "");
    this.box.append(heading);
    if (legend.kind === "names") {
      const list = document.createElement("ul");
      legend.names.slice(0, 60).forEach((name, i) => {
        const row = document.createElement("li"), square = document.createElement("i");
        square.style.background = legend.colours[i];
        row.append(square, name);
        list.append(row);
      });
      if (legend.names.length > 60) list.append(Object.assign(document.createElement("li"), { textContent: `… and ${legend.names.length - 60} more` }));
      this.box.append(list);
      this.box.setAttribute("aria-label", `Legend: ${legend.title[0]}: ${legend.names.slice(0, 20).join(", ")}`);
      return;
    }
    const bar = document.createElement("div"), ticks = document.createElement("div");
    bar.className = "bar", ticks.className = "ticks";
    bar.style.background = `linear-gradient(to right, ${legend.colours.join(", ")})`;
    for (const tick of legend.ticks ?? []) {
      const label = document.createElement("span");
      label.textContent = tick.label;
      label.style.left = `${tick.at * 100}%`;
      ticks.append(label);
    }
    this.box.append(bar, ticks);
    this.box.setAttribute("aria-label", `Legend: ${heading.textContent}, from ${legend.low} to ${legend.high}, colour map ${map}`);
  }
}
