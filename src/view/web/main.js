// Puts the page together: what is shown, how it is looked at, what is selected.
import { ask, askReload, saveFile } from "./api.js";
import { OrbitCamera } from "./camera.js";
import { Pane } from "./pane.js";
import { listen } from "./pointing.js";
import { short } from "./charts.js";
import { Legend } from "./legend.js";
import { OrganPanel } from "./organ.js";
import { SelectionPanel } from "./selection.js";
import { Statistics } from "./statistics.js";

const element = (id) => document.getElementById(id);
const labels = {
  colour: "natural colour", absorbed: "absorbed", irradiance: "irradiance, side seen", irradiance_front: "irradiance, front", irradiance_back: "irradiance, back",
  sunlit: "sunlit fraction, side seen", sunlit_front: "sunlit fraction, front", sunlit_back: "sunlit fraction, back", organ_absorbed: "absorbed, mean of the organ",
  organ_irradiance: "irradiance, mean of the organ", organ_sunlit: "sunlit fraction, mean of the organ", area: "facet area", height: "height", type: "organ type",
};

let about;          // what the server tells of the results
let camera;
let generation = 0;
const cut = { axis: "", part: 1, flip: false, normal: [0, 0, 1] };
const cross = { x: 0.5, y: 0.5 };

const mode = () => element("compare").value;
const mainResult = () => (mode() === "second" ? 1 : 0);
const isColour = () => element("quantity").value === "colour";
const isDark = () => {
  const theme = document.documentElement.dataset.theme;
  return theme ? theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
};

function fill(select, entries, keep) {
  const before = keep ? select.value : "";
  select.replaceChildren(...entries.map(([value, text]) => new Option(text, value)));
  if (entries.some(([value]) => String(value) === before)) select.value = before;
}

/// Normal and ends of the cut plane's way: it moves through the scene's box.
function cutPlane() {
  const { low, high } = about.results[0];
  const axis = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] }[cut.axis] ?? cut.normal;
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => axis.reduce((sum, a, i) => sum + a * (k & (1 << i) ? high[i] : low[i]), 0));
  const from = Math.min(...corners), to = Math.max(...corners), margin = 1e-3 * (to - from);
  const offset = from - margin + cut.part * (to - from + 2 * margin);
  return { axis, offset, sign: cut.flip ? -1 : 1 };
}

function shownQuantity() {
  return { quantity: element("quantity").value, band: element("band").value, state: element("state").value };
}

/// Parameters of a pane's picture.
function viewOf(pane) {
  const plane = cut.axis ? cutPlane() : null;
  camera.fitTo(panes[0].canvas.clientWidth / Math.max(1, panes[0].canvas.clientHeight));
  return {
    ...shownQuantity(),
    result: mode() === "both" ? pane : mainResult(),
    difference: mode() === "difference" && !isColour(),
    map: element("map").value,
    log: scale.log,
    range: isColour() ? undefined : scale.range,
    exposure: element("exposure").value,
    ...camera.parameters(),
    cut: plane ? [...plane.axis.map((v) => v * plane.sign), plane.offset * plane.sign].join(",") : undefined,
    select: selection.text(), only: element("only").checked,
    ground: element("ground").checked, map_ground: element("map-ground").checked, infinite: element("infinite").checked,
    dark: isDark(), highlight: organ.row ?? undefined,
  };
}

/// The scale that the pictures have.
const scale = { range: undefined, log: false };

function report(frame, quick, problem) {
  const text = element("progress");
  if (problem) {
    text.textContent = problem;
    return;
  }
  const rays = Math.floor(frame.samples), kind = frame.draft && !quick ? ", light being prepared" : "";
  text.textContent = quick ? "" : `${rays < 1 ? "refining" : rays === 1 ? "1 ray a pixel" : `${rays} rays a pixel`}${kind}`;
}

const panes = [0, 1].map((k) => new Pane(element(`pane-${k}`), `pane${k}`, () => viewOf(k), report));
const legend = new Legend(element("legend"));
const organ = new OrganPanel({ state: () => element("state").value, result: mainResult, picked: () => redraw(), went: (low, high) => { camera.goTo(low, high); redraw(); } });
const statistics = new Statistics({
  parameters: () => ({ ...shownQuantity(), result: mainResult(), difference: mode() === "difference" && !isColour(), select: selection.text() }),
});
const selection = new SelectionPanel({ result: mainResult, changed: () => { redraw(); statistics.change(); } });

let waiting = false;
/// The camera or anything else in the pictures has changed; many calls within a frame of the screen become one.
function redraw() {
  if (waiting || !about) return;
  waiting = true;
  requestAnimationFrame(() => {
    waiting = false;
    for (const pane of panes) if (pane.visible) pane.change();
  });
}

/// Asks for the scale that the controls want. One that cannot be is said, and the pictures keep the last that could.
async function showScale() {
  const low = element("low").valueAsNumber, high = element("high").valueAsNumber, before = { ...scale };
  scale.log = element("log").checked && mode() !== "difference";
  scale.range = !isColour() && (Number.isFinite(low) && Number.isFinite(high)) ? `${low},${high}` : undefined;
  try {
    const answer = await ask("legend", { ...viewOf(0), width: 64, height: 64 });
    legend.show(answer, element("map").value);
    // Side by side, both pictures have one scale: that of the first.
    if (mode() === "both" && answer.kind === "numbers") scale.range = `${answer.low},${answer.high}`;
    element("low").placeholder = element("high").placeholder = "automatic";
    if (answer.kind === "numbers") element("low").placeholder = short(answer.low), element("high").placeholder = short(answer.high);
    say("");
  } catch (error) {
    Object.assign(scale, before);
    say(error.message);
    return;
  }
  redraw();
}

function say(text) {
  element("status").textContent = text;
}

function changeQuantity() {
  const numbers = !isColour();
  for (const id of ["map", "low", "high", "log", "auto", "map-ground"]) element(id).disabled = !numbers;
  element("exposure").disabled = numbers;
  element("log").disabled = !numbers || mode() === "difference";
  showScale();
  statistics.change();
}

function changeCompare() {
  const both = mode() === "both";
  element("pane-1").hidden = !both;
  for (const k of [0, 1]) element(`pane-${k}`).querySelector("figcaption").textContent = both ? about.results[k].file : "";
  if (mode() === "difference" && isColour()) element("quantity").value = about.results[0].quantities.find((q) => q !== "colour");
  fill(element("quantity"), about.results[mainResult()].quantities.map((q) => [q, labels[q] ?? q.replaceAll("_", " ")]), true);
  selection.load();
  changeQuantity();
}

function showCut() {
  const slider = element("cut-at");
  slider.disabled = !cut.axis;
  slider.value = cut.part;
  const plane = cut.axis ? cutPlane() : null;
  const text = plane ? `${short(plane.offset)} m` : "";
  element("cut-value").textContent = text;
  slider.setAttribute("aria-valuetext", text || "no cut plane");
  redraw();
}

function moveCut(by) {
  if (!cut.axis) {
    cut.axis = element("cut-axis").value = "z";
    cut.part = 1;
  }
  cut.part = Math.min(1, Math.max(0, cut.part + by));
  showCut();
}

function placeCross() {
  for (const pane of panes) {
    const mark = pane.figure.querySelector(".cross");
    mark.style.left = `${cross.x * 100}%`, mark.style.top = `${cross.y * 100}%`;
  }
}

async function pick(k, x, y) {
  const box = panes[k].canvas.getBoundingClientRect();
  try {
    organ.show(await ask("pick", { ...viewOf(k), x, y, width: Math.max(16, Math.round(box.width)), height: Math.max(16, Math.round(box.height)) }), legend.title);
  } catch (error) {
    say(error.message);
  }
}

panes.forEach((pane, k) => listen(pane.canvas, {
  turn: (around, up) => { camera.turn(around, up); redraw(); },
  move: (right, up) => { camera.move(right, up); redraw(); },
  zoom: (factor, right, up) => { camera.zoom(factor, right, up); redraw(); },
  home: () => { camera.reset(); redraw(); },
  cut: moveCut,
  cross: (dx, dy) => { cross.x = Math.min(1, Math.max(0, cross.x + dx)), cross.y = Math.min(1, Math.max(0, cross.y + dy)); placeCross(); },
  pick: (x, y) => pick(k, x, y),
  pickAtCross: () => pick(k, cross.x, cross.y),
  forget: () => organ.forget(),
  step: (by) => organ.step(by, about.results[mainResult()].organs),
  goTo: () => organ.goTo(),
}));

function wire() {
  for (const id of ["quantity", "band", "state", "map", "log"]) element(id).addEventListener("change", changeQuantity);
  element("state").addEventListener("change", () => organ.refresh());
  for (const id of ["low", "high"]) element(id).addEventListener("change", showScale);
  element("auto").addEventListener("click", () => { element("low").value = element("high").value = ""; showScale(); });
  element("exposure").addEventListener("input", redraw);
  element("compare").addEventListener("change", changeCompare);
  for (const id of ["ground", "map-ground", "infinite", "only"]) element(id).addEventListener("change", redraw);
  element("orthographic").addEventListener("change", (event) => { camera.orthographic = event.target.checked; redraw(); });
  for (const button of document.querySelectorAll("[data-view]")) button.addEventListener("click", () => { camera.look(button.dataset.view); redraw(); });
  element("cut-axis").addEventListener("change", (event) => {
    cut.axis = event.target.value;
    if (cut.axis === "camera") cut.normal = camera.axes().out;
    if (cut.part > 0.98 || cut.part < 0.02) cut.part = 0.5;
    showCut();
  });
  element("cut-at").addEventListener("input", (event) => { cut.part = event.target.valueAsNumber; showCut(); });
  element("cut-flip").addEventListener("change", (event) => { cut.flip = event.target.checked; showCut(); });
  element("save").addEventListener("click", async () => {
    for (const k of mode() === "both" ? [0, 1] : [0]) await saveFile(mode() === "both" ? `sunfleck-${k + 1}.png` : "sunfleck.png", "frame", await panes[k].picture());
  });
  const theme = element("theme");
  theme.value = localStorage.getItem("sunfleck-theme") ?? "";
  const setTheme = () => {
    if (theme.value) document.documentElement.dataset.theme = theme.value; else delete document.documentElement.dataset.theme;
    localStorage.setItem("sunfleck-theme", theme.value);
    redraw();
    statistics.draw();
  };
  theme.addEventListener("change", setTheme);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", setTheme);
  setTheme();
  element("reload").addEventListener("click", async () => {
    element("reload").disabled = true;
    try {
      await askReload();
      await load();
      element("notice").hidden = true;
    } catch (error) {
      element("notice-text").textContent = `The file cannot be read: ${error.message}`;
    }
    element("reload").disabled = false;
  });
}

/// What is to be known before the pictures are believed.
function doubts() {
  const reasons = {
    not_converged: "the solution did not converge, or missed the error that was asked for",
    inaccurate: "its own certificate finds an error above three times what its quality aims at",
  };
  const lines = about.results.filter((r) => r.status !== "converged").map((r) => `${r.file} is ${r.status.replaceAll("_", " ")}: ${reasons[r.status] ?? "see sunfleck info"}.`);
  if (about.notes?.length) lines.push(`Of the two results, ${about.notes.join("; ")}.`);
  element("doubts").textContent = lines.join(" ");
  element("doubts").hidden = lines.length === 0;
}

/// Reads what the results are; a camera that is already there stays.
async function load() {
  about = await ask("describe");
  const first = about.results[0], two = about.results.length === 2;
  document.title = `${about.results.map((r) => r.file.split("/").at(-1)).join(" and ")} – Sunfleck`;
  element("files").textContent = about.results.map((r) => `${r.file} (${r.facets.toLocaleString("en")} facets, ${r.method}${r.status === "converged" ? "" : `, ${r.status.replaceAll("_", " ")}`})`).join("  |  ");
  doubts();
  for (const node of document.querySelectorAll(".compare")) node.hidden = !two;
  element("compare").querySelector("[value=difference]").disabled = !about.difference;
  fill(element("band"), first.bands.map((name, i) => [i, `${name} [${first.units[i]}]`]), true);
  fill(element("state"), first.states.map((name, i) => [i, name || `state ${i + 1}`]), true);
  for (const node of document.querySelectorAll(".states")) node.hidden = first.states.length < 2;
  for (const node of document.querySelectorAll(".grounds")) node.hidden = !first.ground;
  for (const node of document.querySelectorAll(".periodic")) node.hidden = !first.periodic;
  fill(element("map"), about.maps.map((name) => [name, name]), true);
  if (!camera) camera = new OrbitCamera(first.camera);
  organ.refresh();
  changeCompare();
  showCut();
  placeCross();
  document.body.dataset.ready = "1";
}

async function watch() {
  try {
    const now = await ask("status");
    if (now.ready && !about) {
      generation = now.generation;
      say("");
      await load();
    } else if (about && now.generation !== generation) {  // read again from another window
      generation = now.generation;
      await load();
    }
    const changed = now.changed.map((c) => c.file + (c.missing ? " is gone" : " was replaced"));
    element("notice").hidden = changed.length === 0;
    if (changed.length && !element("notice-text").textContent.startsWith("The file cannot")) element("notice-text").textContent = `${changed.join("; ")}. What you see is what was read before.`;
    element("reload").hidden = now.changed.some((c) => c.missing);
    if (element("status").textContent === "The viewer does not answer") say("");
  } catch (error) {
    say(error.status ? error.message : "The viewer does not answer");
  }
  setTimeout(watch, about ? 2000 : 60);
}

wire();
watch();
