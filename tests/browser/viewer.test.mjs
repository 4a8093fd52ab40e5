// The viewer in a browser, on a real result: what a user does, with mouse, touch and keyboard.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { after, before, test } from "node:test";
import { closePage, download, folder, look, openPage, patience, settled, shoot, shots, startBrowser, startViewer, text, unlike } from "./browser.mjs";

const first = "first.h5", second = "second.h5";
let browser, viewer, url;

/// organs.csv as `sunfleck export` wrote it, by organ row.
const table = (() => {
  const [head, ...lines] = fs.readFileSync(path.join(folder, "organs.csv"), "utf8").trim().split(/\r?\n/).map((line) => line.split(","));
  return lines.map((line) => Object.fromEntries(line.map((v, i) => [head[i], v])));
})();
const column = (row, name) => Number(row[Object.keys(row).find((key) => key.startsWith(name))]);

before(async () => {
  viewer = startViewer([first]);
  url = await viewer.url;
  browser = await startBrowser();
});

after(async () => {
  await browser?.close();
  viewer?.child.kill("SIGINT");
  assert.equal(await viewer?.ended, 0);  // Ctrl-C ends it cleanly
});

test("the picture comes, is refined, and nothing is asked of other machines", async () => {
  const page = await openPage(browser, url);
  await settled(page);
  const seen = await look(page);
  assert.ok(new Set(seen).size > 50, "the picture is not blank");
  assert.match(await page.title(), /first\.h5/);
  assert.match(await text(page, "#files"), /facets, clustering/);
  await page.waitForFunction(() => document.querySelector("#summary").dataset.facets > 0);
  await shoot(page, "start.png");
  assert.deepEqual([...page.hosts], [new URL(url).host]);
  await closePage(page);
});

test("mouse, wheel and keys turn, move and zoom", async () => {
  const page = await openPage(browser, url);
  await settled(page);
  const canvas = page.locator("#pane-0 canvas"), box = await canvas.boundingBox();
  const changes = async (what, act) => {
    const before = await look(page), end = Date.now() + 20000;
    await act();
    let change = 0;
    do {  // on a busy machine the next frame may still refine the last view
      await settled(page);
      change = unlike(before, await look(page));
    } while (change <= 1 && Date.now() < end);
    assert.ok(change > 1, `${what} changes the picture`);
  };
  const drag = (button) => async () => {
    await page.mouse.move(box.x + 300, box.y + 300);
    await page.mouse.down({ button });
    for (let i = 1; i <= 10; ++i) await page.mouse.move(box.x + 300 + 12 * i, box.y + 300 + 3 * i);
    await page.mouse.up({ button });
  };
  await changes("a drag", drag("left"));
  await changes("a drag with the right button", drag("right"));
  await changes("the wheel", async () => { await page.mouse.move(box.x + 300, box.y + 300); await page.mouse.wheel(0, -400); });
  await canvas.focus();
  await changes("an arrow key", () => page.keyboard.press("ArrowLeft"));
  await changes("Shift and an arrow key", () => page.keyboard.press("Shift+ArrowUp"));
  await changes("+", () => page.keyboard.press("+"));
  await changes("the Top button", () => page.getByRole("button", { name: "Top" }).click());
  await changes("Parallel", () => page.getByLabel("Parallel").check());
  await closePage(page);
});

test("two fingers zoom, one turns", async () => {
  const page = await openPage(browser, url, { hasTouch: true });
  await settled(page);
  const box = await page.locator("#pane-0 canvas").boundingBox(), cdp = await page.context().newCDPSession(page);
  const touch = (type, ...points) => cdp.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x: box.x + x, y: box.y + y, id })) });
  const start = await look(page);
  await touch("touchStart", [200, 200]);
  for (let i = 1; i <= 8; ++i) await touch("touchMove", [200 + 15 * i, 200]);
  await touch("touchEnd");
  await page.waitForTimeout(300);
  await settled(page);
  const turned = await look(page);
  assert.ok(unlike(start, turned) > 1, "one finger turns");
  await touch("touchStart", [250, 250], [350, 250]);
  for (let i = 1; i <= 8; ++i) await touch("touchMove", [250 - 10 * i, 250], [350 + 10 * i, 250]);
  await touch("touchEnd");
  await page.waitForTimeout(300);
  await settled(page);
  assert.ok(unlike(turned, await look(page)) > 1, "two fingers zoom");
  await closePage(page);
});

test("a leaf that is found by name, and picked in the picture, has the numbers of the file", async () => {
  const page = await openPage(browser, url);
  const row = table.findIndex((r) => r.type === "leaf" && r.plant === "maize" && Number(r.area_m2) > 0.02);
  const wanted = table[row];
  await page.getByLabel("Find by name").fill(`${wanted.placement}/${wanted.name}`);
  await page.locator("#found button").first().click();
  const organ = page.locator("#organ");
  await page.waitForFunction((o) => document.getElementById("organ").dataset.organ === String(o), row);
  // The camera went to it. Where in the picture it can be seen is asked first, then clicked; other leaves may hide it from some sides.
  await page.locator("#pane-0 canvas").focus();
  await page.keyboard.press("Escape");
  assert.match(await organ.innerText(), /Click a leaf/);
  const box = await page.locator("#pane-0 canvas").boundingBox();
  let met = null;
  for (let side = 0; side < 6 && !met; ++side) {
    await settled(page);
    met = await page.evaluate(async ([view, wantedRow]) => {
      const pick = new URL(view);
      pick.pathname = "/api/pick";
      for (let i = 0; i < 32 * 32; ++i) {
        const x = 0.3 + (0.4 * (i % 32)) / 31, y = 0.3 + (0.4 * Math.floor(i / 32)) / 31;
        pick.searchParams.set("x", x), pick.searchParams.set("y", y);
        if ((await (await fetch(pick)).json()).organ === wantedRow) return [x, y];
      }
      return null;
    }, [page.pictures.at(-1), row]);
    if (!met) for (let k = 0; k < 8; ++k) await page.keyboard.press("ArrowRight");
  }
  assert.ok(met, `${wanted.name} can be seen`);
  const answer = page.waitForResponse((response) => response.url().includes("/api/pick"));
  await page.mouse.click(box.x + box.width * met[0], box.y + box.height * met[1]);
  const found = await (await answer).json();
  assert.equal(found.organ, row);
  for (const [i, band] of ["PAR", "NIR"].entries()) {
    // The table has the file's float32 in decimal: equal to the last digit of a float.
    assert.equal(Math.fround(found.absorbed[i]), Math.fround(column(wanted, `absorbed_W_${band}`)));
    assert.equal(Math.fround(found.irradiance.front[i]), Math.fround(column(wanted, `irradiance_front_${band}`)));
    assert.equal(Math.fround(found.irradiance.back[i]), Math.fround(column(wanted, `irradiance_back_${band}`)));
  }
  assert.equal(Math.fround(found.area), Math.fround(Number(wanted.area_m2)));
  await page.waitForFunction((o) => document.getElementById("organ").dataset.organ === String(o), row);
  const shown = await organ.innerText();
  assert.ok(shown.includes(wanted.name) && shown.includes(wanted.placement) && shown.includes("Irradiance, front"));
  const titles = await organ.locator("td[title]").evaluateAll((cells) => cells.map((cell) => Number(cell.title)));
  assert.ok(titles.some((v) => Math.fround(v) === Math.fround(column(wanted, "absorbed_W_PAR"))), "the page shows the number itself");
  await settled(page);
  await shoot(page, "leaf.png");
  await closePage(page);
});

test("quantity, range, colour map and state change picture and legend", async () => {
  const page = await openPage(browser, url);
  assert.ok(await page.locator("#legend").isHidden());
  await page.getByLabel("Quantity").selectOption("absorbed");
  await page.locator("#legend").waitFor({ state: "visible" });
  assert.match(await text(page, "#legend"), /absorbed PAR \[W m⁻²\]/);
  await settled(page);
  const linear = await look(page);
  await page.getByLabel("From", { exact: true }).fill("0");
  await page.getByLabel("To", { exact: true }).fill("40");
  await page.getByLabel("To", { exact: true }).press("Enter");
  await page.waitForFunction(() => document.getElementById("legend").getAttribute("aria-label").includes("from 0 to 40"));
  await page.waitForTimeout(300);
  await settled(page);
  const narrow = await look(page);
  assert.ok(unlike(linear, narrow) > 1, "the range changes the picture");
  await page.getByLabel("Colour map", { exact: true }).selectOption("inferno");
  await page.waitForFunction(() => document.getElementById("legend").getAttribute("aria-label").includes("inferno"));
  await page.waitForTimeout(300);
  await settled(page);
  assert.ok(unlike(narrow, await look(page)) > 1, "the colour map changes the picture");
  await page.getByRole("button", { name: "Automatic range" }).click();
  await page.getByLabel("Band").selectOption({ label: "NIR [W m⁻²]" });
  await page.waitForFunction(() => document.getElementById("legend").innerText.includes("absorbed NIR"));
  const morning = await text(page, "#summary");
  await page.getByLabel("State").selectOption({ label: "12:00" });
  await page.waitForFunction((before) => document.getElementById("summary").innerText !== before, morning);
  await page.getByLabel("Quantity").selectOption("type");
  await page.waitForFunction(() => document.querySelectorAll("#legend li").length >= 3);
  // A range that cannot be is said, and the picture stays.
  await page.getByLabel("Quantity").selectOption("absorbed");
  await page.getByLabel("Logarithmic").check();
  await page.getByLabel("From", { exact: true }).fill("-1");
  await page.getByLabel("To", { exact: true }).fill("40");
  await page.getByLabel("To", { exact: true }).press("Enter");
  await page.waitForFunction(() => document.getElementById("status").innerText.includes("numbers above zero"));
  assert.ok(new Set(await look(page)).size > 50, "the picture stays");
  page.errors = page.errors.filter((error) => !error.includes("400"));
  await closePage(page);
});

test("the cut plane is dragged", async () => {
  const page = await openPage(browser, url);
  await page.getByLabel("Quantity").selectOption("irradiance");
  await settled(page);
  const whole = await look(page);
  await page.getByLabel("Cut plane").selectOption("x");
  const slider = page.getByLabel("Position");
  await page.waitForTimeout(300);
  await settled(page);
  const half = await look(page);
  assert.ok(unlike(whole, half) > 1, "the plane cuts");
  await slider.scrollIntoViewIfNeeded();
  const box = await slider.boundingBox(), before = await slider.inputValue();
  await page.mouse.move(box.x + box.width * 0.5, box.y + box.height / 2);
  await page.mouse.down();
  for (let i = 1; i <= 8; ++i) await page.mouse.move(box.x + box.width * (0.5 - 0.03 * i), box.y + box.height / 2);
  await page.mouse.up();
  assert.ok(Number(await slider.inputValue()) < Number(before) - 0.1, "the slider follows the pointer");
  assert.match(await text(page, "#cut-value"), /m$/);
  await page.waitForTimeout(300);
  await settled(page);
  await shoot(page, "cut.png");
  assert.ok(unlike(half, await look(page)) > 0.5, "the picture follows");
  await page.locator("#pane-0 canvas").focus();
  const now = await slider.inputValue();
  await page.keyboard.press("PageDown");
  assert.notEqual(await slider.inputValue(), now);
  await closePage(page);
});

test("a selection has its distribution, and both are saved", async () => {
  const page = await openPage(browser, url);
  await page.getByLabel("Quantity").selectOption("absorbed");
  await page.waitForFunction(() => document.querySelector("#summary").dataset.facets > 0);
  const all = Number(await page.locator("#summary").getAttribute("data-facets"));
  await page.getByLabel(/maize\[1\]/).check();
  await page.getByRole("group", { name: "Organ types" }).getByLabel("leaf", { exact: true }).check();
  await page.waitForFunction((n) => Number(document.querySelector("#summary").dataset.facets) < n, all);
  assert.match(await text(page, "#selection"), /leaf of maize\[1\]/);
  await page.getByLabel("Hide the rest").check();
  const leaves = table.filter((r) => r.placement === "maize[1]" && r.type === "leaf");
  const area = leaves.reduce((sum, r) => sum + Number(r.area_m2), 0);
  await page.getByRole("button", { name: "Profile CSV" }).scrollIntoViewIfNeeded();
  for (const name of ["Histogram", "Profile"]) {
    const csv = await download(page, () => page.getByRole("button", { name: `${name} CSV` }).click());
    const [head, ...lines] = csv.bytes.toString("utf8").trim().split("\r\n").map((line) => line.split(","));
    const at = head.indexOf("area_m2"), sum = lines.reduce((s, line) => s + Number(line[at]), 0);
    assert.ok(Math.abs(sum - area) < 1e-5 * area, `${csv.name} adds up to the leaves' area: ${sum} and ${area}`);  // sums of float32
    const png = await download(page, () => page.getByRole("button", { name: `${name} PNG` }).click());
    assert.deepEqual([...png.bytes.subarray(1, 4)], [0x50, 0x4e, 0x47]);
    assert.ok(png.bytes.length > 5000);
    fs.copyFileSync(path.join(folder, "downloads", png.name), path.join(shots, png.name));
  }
  await settled(page);
  await shoot(page, "selection.png");
  const picture = await download(page, () => page.getByRole("button", { name: "Save the picture" }).click());
  assert.equal(picture.name, "sunfleck.png");
  assert.deepEqual([...picture.bytes.subarray(1, 4)], [0x50, 0x4e, 0x47]);
  await closePage(page);
});

test("everything can be reached and named without a mouse", async () => {
  const page = await openPage(browser, url);
  await settled(page);
  const unnamed = await page.evaluate(() => [...document.querySelectorAll("input, select, button, canvas, [role=img]")].filter((node) => {
    const name = node.getAttribute("aria-label") || node.getAttribute("aria-labelledby") || [...(node.labels ?? [])].map((l) => l.innerText).join("") || node.textContent.trim();
    return !name;
  }).map((node) => node.outerHTML));
  assert.deepEqual(unnamed, []);
  await page.keyboard.press("Tab");
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.tagName), "CANVAS");
  await shoot(page, "keyboard.png");
  await page.keyboard.press("n");
  await page.waitForFunction(() => document.getElementById("organ").dataset.organ === "0");
  await page.keyboard.press("n");
  await page.waitForFunction(() => document.getElementById("organ").dataset.organ === "1");
  await page.keyboard.press("f");
  await settled(page);
  await page.keyboard.press("Home");
  // Some place of the cross meets the ground or a plant.
  const answer = page.waitForResponse((response) => response.url().includes("/api/pick"));
  for (let i = 0; i < 12; ++i) await page.keyboard.press("Alt+ArrowDown");
  await page.keyboard.press("Enter");
  assert.notEqual((await (await answer).json()).organ, null);
  assert.equal(await page.locator("#organ").getAttribute("aria-live"), "polite");
  await closePage(page);
});

test("light and dark", async () => {
  const shade = async (page) => page.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/\d+/g).slice(0, 3).reduce((s, v) => s + Number(v), 0) / 3);
  const light = await openPage(browser, url, { colorScheme: "light" });
  assert.ok((await shade(light)) > 200);
  await closePage(light);
  const dark = await openPage(browser, url, { colorScheme: "dark" });
  assert.ok((await shade(dark)) < 60);
  await dark.getByLabel("Quantity").selectOption("absorbed");
  await dark.waitForTimeout(300);
  await settled(dark);
  const corner = (await look(dark)).slice(0, 3);
  assert.ok(Math.max(...corner) < 80, `the paper behind a map is dark: ${corner}`);
  await shoot(dark, "dark.png");
  await dark.getByLabel("Theme").selectOption("light");
  assert.ok((await shade(dark)) > 200);
  await closePage(dark);
});

test("two results side by side, and their difference", async () => {
  const pair = startViewer([first, second]);
  const page = await openPage(browser, await pair.url);
  assert.ok(await page.locator("#doubts").isHidden());
  await page.getByLabel("Quantity").selectOption("absorbed");
  await page.getByLabel("Compare").selectOption("both");
  await page.locator("#pane-1").waitFor({ state: "visible" });
  await page.waitForFunction(() => Number(document.querySelector("#pane-1 canvas").dataset.frames) > 0);
  await page.waitForTimeout(300);
  await settled(page, 0);
  await settled(page, 1);
  assert.match(await text(page, "#pane-1 figcaption"), /second\.h5/);
  const left = await look(page, 0);
  assert.ok(unlike(left, await look(page, 1)) > 0.3, "the results differ");
  await shoot(page, "compare.png", [0, 1]);
  await page.locator("#pane-1 canvas").focus();
  await page.keyboard.press("ArrowRight");
  await page.waitForTimeout(400);
  await settled(page, 0);
  assert.ok(unlike(left, await look(page, 0)) > 1, "both cameras move together");
  await page.getByLabel("Compare").selectOption("difference");
  await page.waitForFunction(() => document.getElementById("legend").innerText.includes("difference of absorbed PAR"));
  const [low, high] = (await page.locator("#legend").getAttribute("aria-label")).match(/from (\S+) to (\S+),/).slice(1).map(Number);
  assert.equal(low, -high);
  await page.waitForTimeout(300);
  await settled(page);
  await shoot(page, "difference.png");
  await closePage(page);
  pair.child.kill("SIGTERM");
  assert.equal(await pair.ended, 0);
});

test("what is to be known before a result is believed is said", async () => {
  const context = await browser.newContext(), page = await context.newPage();
  page.setDefaultTimeout(patience);
  await page.route("**/api/describe", async (route) => {
    const answer = await route.fetch(), about = await answer.json();
    about.results[0].status = "inaccurate";
    about.notes = ["their light differs: sun of state noon"];
    await route.fulfill({ response: answer, json: about });
  });
  await page.goto(url);
  await page.locator("#doubts").waitFor({ state: "visible" });
  assert.match(await text(page, "#doubts"), /first\.h5 is inaccurate: .*certificate.*light differs: sun of state noon/);
  assert.match(await text(page, "#files"), /, inaccurate/);
  await context.close();
});

test("a result that is replaced is noticed and read again", async () => {
  const file = path.join(folder, "changing.h5"), next = path.join(folder, "next.h5");
  fs.copyFileSync(path.join(folder, first), file);
  const own = startViewer(["changing.h5"]);
  const page = await openPage(browser, await own.url);
  assert.ok(await page.locator("#notice").isHidden());
  fs.copyFileSync(path.join(folder, second), next);
  fs.renameSync(next, file);
  await page.locator("#notice").waitFor({ state: "visible" });
  assert.match(await text(page, "#notice"), /changing\.h5 was replaced/);
  await page.getByRole("button", { name: "Read it again" }).click();
  await page.locator("#notice").waitFor({ state: "hidden" });
  await page.waitForFunction(() => document.getElementById("files").innerText.includes("direct"));
  await settled(page);
  await closePage(page);
  own.child.kill("SIGINT");
  assert.equal(await own.ended, 0);
});

test("with a token, only who knows it", async () => {
  const own = startViewer([first], ["--token", "new"]);
  const address = await own.url, bare = address.split("?")[0];
  const context = await browser.newContext(), stranger = await context.newPage();
  assert.equal((await stranger.goto(bare)).status(), 401);
  await context.close();
  const page = await openPage(browser, address);
  assert.equal(page.url(), bare);  // the token does not stay in the address
  await closePage(page);
  own.child.kill("SIGINT");
  await own.ended;
});
