// The 3D view of an episode's page, rendered in software by Chromium.
import assert from "node:assert/strict";
import {readFileSync, statSync} from "node:fs";
import {join} from "node:path";
import {after, before, test} from "node:test";

import {artefacts, openPage, qsmpc, sidewaysScroll, softwareGl, source, startBrowser, temporaryFolder,
        until} from "./pages.mjs";
import {pictureAt, pixelsOf} from "./scene.mjs";

let browser;
let folder;

before(async () => {
  folder = temporaryFolder();
  qsmpc("run", "dubins_alley", "--quiet", "--no-video", "--out", folder, "--set", "limit.steps=30");
  browser = await startBrowser(softwareGl);
});

after(async () => { await browser?.close(); });

async function open(options) {
  const opened = await openPage(browser, join(folder, "report.html"), options);
  await opened.page.locator("#scene").scrollIntoViewIfNeeded();
  await opened.page.locator("#scene canvas").waitFor();
  return opened;
}

const whole = (page) => page.locator("#scene .whole").click();

// What is visible at a time (s): the number of pixels similar to the first one, the number with the
// car's paint and their centre, the number of coloured pixels, of the warm ones among them, and of
// those with the colour of an obstacle's top.
async function seenAt(page, time) {
  const picture = await pictureAt(page, time);
  const [red, green, blue] = picture.data;
  const paint = pixelsOf(picture, (r, g, b) => r >= 150 && g <= 0.62 * r && b <= 0.25 * r);
  const count = (holds) => pixelsOf(picture, holds).count;
  return {
    all: picture.width * picture.height, paint: paint.count, x: paint.x, y: paint.y,
    ground: count((r, g, b) => r === red && g === green && b === blue),
    coloured: count((r, g, b) => Math.max(r, g, b) - Math.min(r, g, b) > 60),
    warm: count((r, g, b) => r > g && g > b && r - b > 60),
    tops: count((r, g, b) => r > 130 && r < 160 && b - r > 8 && b - r < 30 && g > r && g < b),
  };
}

test("draws the vehicle from its file without an error and asks for nothing", async () => {
  const {page, seen} = await open();
  const drawn = await seenAt(page, 1);
  assert.ok(drawn.ground < 0.9 * drawn.all, `${drawn.ground} of ${drawn.all} pixels are empty`);
  assert.ok(drawn.paint > 300, `${drawn.paint} pixels of the car`);
  assert.ok(Math.hypot(drawn.x - 0.5, drawn.y - 0.5) < 0.1, "the car is not in the middle");
  assert.deepEqual(seen.errors, []);
  assert.deepEqual(seen.requests, []);
  await page.close();
});

test("the slider moves the vehicle", async () => {
  const {page} = await open();
  await whole(page);
  const first = await seenAt(page, 0.2);
  const second = await seenAt(page, 2.9);
  assert.ok(first.paint > 10 && second.paint > 10);
  // The alley leads to larger x, which is to the right in the full view.
  assert.ok(second.x > first.x + 0.05, `from ${first.x} to ${second.x}`);
  await page.locator('[data-scene="follow"]').check();
  const begin = await seenAt(page, 0.2);
  const end = await seenAt(page, 0.8);
  assert.ok(Math.hypot(end.x - begin.x, end.y - begin.y) < 0.02, "the view does not follow");
  await page.close();
});

test("an obstacle before the vehicle is seen through", async () => {
  const out = temporaryFolder();
  qsmpc("run", "point_mass", "--quiet", "--no-video", "--out", out);
  const {page} = await openPage(browser, join(out, "report.html"));
  await page.locator("#scene").scrollIntoViewIfNeeded();
  await page.locator("#scene canvas").waitFor();
  for (const layer of ["particles", "plan", "way", "ghost"]) {
    await page.locator(`[data-scene="${layer}"]`).uncheck();
  }
  for (const time of [0.1, 0.7, 1.4, 2]) {  // beside the block, and behind it
    const {warm} = await seenAt(page, time);
    assert.ok(warm > 300, `${time} s: ${warm} pixels of the vehicle`);
  }
  await page.close();
});

// The view's polygon geometry, as a module without imports.
const polygons = () => import("data:text/javascript," +
  encodeURIComponent(readFileSync(join(source, "harness/report/web/scene_polygon.js"), "utf8")));

test("polygons are cut to what is shown", async () => {
  const {cornersOf, cut, within} = await polygons();
  const corner = [[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]];
  assert.deepEqual(within(corner, [1, 3, 1, 3]), [[3, 1], [3, 2], [2, 2], [2, 3], [1, 3], [1, 1]]);
  assert.deepEqual(cut(cornersOf([0, 10, 0, 10]), [1, 1, 15]), [[10, 5], [10, 10], [5, 10]]);
  assert.equal(within(corner, [5, 6, 5, 6]).length, 0);
});

test("a prism stands between what it stands between", async () => {
  const {isBetween} = await polygons();
  const corner = [[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]];
  const between = (...ends) =>
    isBetween(corner, 1, ...ends.map(([x, y, z]) => ({x, y, z})));
  assert.ok(between([-3, 1, 0.5], [6, 1, 0.5]), "through it");
  assert.ok(between([-3, 1, 2], [3, 3, 0.2]), "from above, down into the corner behind it");
  assert.ok(!between([-3, 1, 50], [3, 3, 0.2]), "over it");
  assert.ok(!between([5, 5, 2], [3, 3, 0.2]), "into the corner from its open side");
  assert.ok(between([5, 5, 0.5], [1, 1, 0.2]), "to what is in it");
  assert.ok(!between([-3, 1, 2], [6, 1, 1.5]), "above it");
});

test("obstacles of any outline are drawn, and leave the vehicle visible", async () => {
  const out = temporaryFolder();
  const shapes = "[{disc: {centre: [3.5, 0.9], radius: 0.6}}, " +
    "{polygon: [[6, -1.5], [8, -1.5], [8, -1.1], [6.5, -1.1], [6.5, -0.6], [6, -0.6]]}, " +
    "{half_plane: {normal: [1, 1], offset: 15}}]";
  const drive = ["run", "dubins_alley", "--quiet", "--no-video", "--set", "limit.steps=25"];
  qsmpc(...drive, "--out", out, "--set", `safe_set.obstacles=${shapes}`);
  const {page, seen} = await openPage(browser, join(out, "report.html"));
  await page.locator("#scene").scrollIntoViewIfNeeded();
  await page.locator("#scene canvas").waitFor();
  for (const layer of ["particles", "plan", "way", "ghost"]) {
    await page.locator(`[data-scene="${layer}"]`).uncheck();
  }
  for (const time of [1, 1.8, 2.4]) {  // before, beside and past the disc
    const drawn = await seenAt(page, time);
    assert.ok(drawn.paint > 300, `${time} s: ${drawn.paint} pixels of the car`);
  }
  await whole(page);
  await page.waitForTimeout(100);
  // Tops are the only large areas of their colour.
  const {tops} = await seenAt(page, 2.4);
  assert.ok(tops > 2000, `${tops} pixels of the obstacles' tops`);
  await page.locator("#scene").screenshot({path: join(artefacts, "scene-shapes.png")});
  assert.deepEqual(seen.errors, []);
  await page.close();
});

test("what is not wanted is not drawn", async () => {
  const {page} = await open();
  let before = (await seenAt(page, 1.1)).coloured;
  for (const layer of ["particles", "plan", "way"]) {
    await page.locator(`[data-scene="${layer}"]`).uncheck();
    const now = (await seenAt(page, 1.1)).coloured;
    assert.ok(now < before, `${layer}: ${before}, then ${now}`);
    before = now;
  }
  await page.close();
});

test("is turned by pointer and keys, and brought nearer by plus", async () => {
  const {page} = await open();
  const straight = await seenAt(page, 1);
  await page.locator("#scene canvas").focus();
  for (let i = 0; i < 4; ++i) await page.keyboard.press("+");
  const near = await seenAt(page, 1);
  assert.ok(near.paint > 1.5 * straight.paint, `${straight.paint}, then ${near.paint}`);
  const turned = async (act) => {
    const before = await seenAt(page, 1);
    await act();
    const now = await seenAt(page, 1);
    assert.ok(Math.abs(now.paint - before.paint) > 10, `${before.paint}, then ${now.paint}`);
  };
  await turned(async () => { for (let i = 0; i < 9; ++i) await page.keyboard.press("ArrowLeft"); });
  await turned(async () => {
    const {x, y, width, height} = await page.locator("#scene canvas").boundingBox();
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    await page.mouse.move(x + width / 2 + 160, y + height / 2 + 40, {steps: 5});
    await page.mouse.up();
  });
  await page.close();
});

test("the wheel scrolls the page until the view is clicked", async () => {
  const {page} = await open();
  const middle = page.locator("#scene canvas");
  const scrolled = () => page.evaluate(() => scrollY);
  await middle.hover();
  const begin = await scrolled();
  await page.mouse.wheel(0, 60);
  await until(page, (from) => scrollY > from, begin);
  const before = await seenAt(page, 1);
  await middle.click();
  const at = await scrolled();
  for (let i = 0; i < 3; ++i) await page.mouse.wheel(0, -120);
  await page.waitForTimeout(200);
  assert.equal(await scrolled(), at);
  assert.ok((await seenAt(page, 1)).paint > before.paint);
  await page.close();
});

test("without WebGL it says so, and the page works", async () => {
  const plain = await startBrowser(["--disable-3d-apis"]);
  const {page, seen} = await openPage(plain, join(folder, "report.html"));
  await page.locator("#scene").scrollIntoViewIfNeeded();
  await until(page, () => /no WebGL/.test(document.getElementById("scene").textContent));
  assert.equal(await page.locator("#scene canvas").count(), 0);
  assert.equal(await page.locator("#scene .layers").isVisible(), false);
  await page.locator("#time").fill("1.1");
  assert.match(await page.locator('[data-now="time"]').textContent(), /^1\.10 s/);
  assert.deepEqual(seen.errors, []);
  await plain.close();
});

test("pages without a vehicle's file do not carry it", async () => {
  const out = temporaryFolder();
  qsmpc("run", "dubins_corridor", "--quiet", "--no-video", "--out", out, "--set", "limit.steps=5",
        "--set", "plant.kind=analytic", "--set", "plant.mjcf=''");
  const page_text = readFileSync(join(out, "report.html"), "utf8");
  assert.ok(!page_text.includes("three.js"));
  assert.ok(statSync(join(out, "report.html")).size < statSync(join(folder, "report.html")).size - 5e5);
});

for (const [scenario, plant] of [["cart_pole_balance", "mujoco"], ["cart_pole_balance", "analytic"],
                                  ["double_integrator", "analytic"]]) {
  test(`a model without a place in the plane is drawn alone: ${scenario}, ${plant}`, async () => {
    const out = temporaryFolder();
    qsmpc("run", scenario, "--quiet", "--no-video", "--out", out, "--set", "limit.steps=10",
          "--set", `plant.kind=${plant}`);
    const {page, seen} = await openPage(browser, join(out, "report.html"));
    await page.locator("#scene").scrollIntoViewIfNeeded();
    await page.locator("#scene canvas").waitFor();
    const drawn = await seenAt(page, 0.2);
    assert.ok(drawn.coloured > 200, `${drawn.coloured} pixels of what moves`);
    assert.equal(await page.locator('[data-scene="way"]').count(), 0);
    assert.deepEqual(seen.errors, []);
    await page.close();
  });
}

for (const [name, options] of Object.entries({
  light: {colorScheme: "light", viewport: {width: 1440, height: 900}},
  dark: {colorScheme: "dark", viewport: {width: 1440, height: 900}},
  narrow: {colorScheme: "dark", viewport: {width: 390, height: 844}, deviceScaleFactor: 2, isMobile: true},
})) {
  test(`fits its page: ${name}`, async () => {
    const {page, seen} = await open(options);
    const drawn = await seenAt(page, 1.2);
    assert.ok(drawn.paint > 300, `${drawn.paint} pixels of the car`);
    assert.equal(await sidewaysScroll(page), 0);
    const inside = await page.evaluate(() => {
      const box = (selector) => document.querySelector(selector).getBoundingClientRect();
      const canvas = box("#scene canvas");
      const card = box("#scene");
      return canvas.left >= card.left && canvas.right <= card.right && canvas.bottom <= card.bottom &&
        canvas.width > 250 && canvas.height > 250;
    });
    assert.ok(inside);
    await page.locator("#scene").screenshot({path: join(artefacts, `scene-${name}.png`)});
    assert.deepEqual(seen.errors, []);
    await page.close();
  });
}
