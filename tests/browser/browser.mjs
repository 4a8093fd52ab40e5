// A viewer and a browser for the tests. Settings come from tools/test-browser through the environment.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { createRequire } from "node:module";
import fs from "node:fs";
import path from "node:path";

const { SUNFLECK_PROGRAM, BROWSER_FOLDER, CHROMIUM } = process.env;
export const folder = BROWSER_FOLDER;
export const program = SUNFLECK_PROGRAM;
export const patience = Number(process.env.BROWSER_PATIENCE ?? 120000);  // of one step, on a busy machine
const { chromium } = createRequire(path.join(folder, "package.json"))("playwright-core");

export const shots = path.join(folder, "pictures");
fs.mkdirSync(shots, { recursive: true });

/// Starts `sunfleck view` on files of the folder; its address comes once it is printed.
export function startViewer(files, options = []) {
  const child = spawn(program, ["view", ...files, ...options], { cwd: folder, stdio: ["ignore", "pipe", "pipe"] });
  const ended = new Promise((resolve) => child.once("exit", (code, signal) => resolve(code ?? signal)));
  const url = new Promise((resolve, reject) => {
    let text = "";
    child.stdout.on("data", (data) => {
      text += data;
      if (text.includes("\n")) resolve(text.split("\n")[0]);
    });
    ended.then((code) => reject(new Error(`sunfleck view ended with ${code}`)));
  });
  return { child, url, ended };
}

export async function startBrowser() {
  return chromium.launch({ executablePath: CHROMIUM, args: ["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"] });
}

/// A page with the viewer open and its first picture there; errors on the page fail the test.
export async function openPage(browser, url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1000, height: 640 }, acceptDownloads: true, ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(patience);
  page.errors = [];
  page.hosts = new Set();
  page.pictures = [];  // addresses of the pictures asked for
  page.on("pageerror", (error) => page.errors.push(error.message));
  page.on("console", (message) => { if (message.type() === "error") page.errors.push(message.text()); });
  page.on("request", (request) => {
    if (!request.url().startsWith("blob:")) page.hosts.add(new URL(request.url()).host);
    if (request.url().includes("/api/frame")) page.pictures.push(request.url());
  });
  await page.goto(url);
  await page.waitForFunction(() => document.body.dataset.ready === "1" && Number(document.querySelector("#pane-0 canvas").dataset.frames) > 0);
  return page;
}

export async function closePage(page) {
  const { errors } = page;
  await page.context().close();
  assert.deepEqual(errors, []);
}

/// Waits until the picture shows what was asked for last, at full resolution with a ray a pixel.
export async function settled(page, pane = 0, samples = 1) {
  await page.waitForFunction(([k, wanted]) => {
    const data = document.querySelector(`#pane-${k} canvas`).dataset;
    return data.done === "1" || Number(data.samples) >= wanted;
  }, [pane, samples]);
}

/// A picture of the page to look at; with BROWSER_FINE=1 good enough for the documentation.
export async function shoot(page, name, panes = [0]) {
  for (const pane of panes) await settled(page, pane, process.env.BROWSER_FINE === "1" ? 1e9 : 1);
  await page.screenshot({ path: path.join(shots, name) });
}

/// Mean colour and spread of the picture: enough to tell a picture from a blank, and one picture from another.
export async function look(page, pane = 0) {
  return page.evaluate((k) => {
    const canvas = document.querySelector(`#pane-${k} canvas`), small = document.createElement("canvas");
    small.width = 60, small.height = 40;
    const c = small.getContext("2d");
    c.drawImage(canvas, 0, 0, 60, 40);
    return [...c.getImageData(0, 0, 60, 40).data];
  }, pane);
}

/// Mean difference of two looks, in codes of 255.
export function unlike(a, b) {
  return a.reduce((sum, v, i) => sum + Math.abs(v - b[i]), 0) / a.length;
}

export async function text(page, selector) {
  return (await page.locator(selector).innerText()).trim();
}

/// Saves what a click downloads; returns its name and bytes.
export async function download(page, click) {
  const [file] = await Promise.all([page.waitForEvent("download"), click()]);
  const target = path.join(folder, "downloads", file.suggestedFilename());
  await file.saveAs(target);
  return { name: file.suggestedFilename(), bytes: fs.readFileSync(target) };
}
