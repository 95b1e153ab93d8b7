// Moving obstacles on the page of an episode: in the map and in 3D.
import assert from "node:assert/strict";
import {join} from "node:path";
import {after, before, test} from "node:test";

import {artefacts, openPage, qsmpc, softwareGl, startBrowser, temporaryFolder, until} from "./pages.mjs";
import {pictureAt, pixelsOf} from "./scene.mjs";

const kPeriod = 0.1;  // s

let browser;
let folder;

before(async () => {
  folder = temporaryFolder();
  qsmpc("run", "dubins_obstacles", "--quiet", "--no-video", "--out", folder, "--fail-on", "none",
        "--set", "limit={steps: 20, stop_when_unsafe: false}", "--set", "plant.kind=analytic",
        "--set", "safe_set.obstacles=[{x: [6, 8], y: [5, 6.5]}, {box: {centre: [5, 1], size: [1.2, 0.6]}, " +
        "motion: {turns: true, path: [[1, 5, 2.5], [2, 3.5, 2.5]], speed_deviation: 0.1, seen_deviation: 0.02}}]");
  browser = await startBrowser(softwareGl);
});

after(async () => { await browser?.close(); });

const open = () => openPage(browser, join(folder, "report.html"));
const slideTo = (page, time) => page.locator("#time").fill(String(Number(time.toFixed(1))));

// Place and turn (degrees, clockwise on the screen) of the only obstacle in the map.
const placeOf = (page) => page.locator("#others path").evaluate((body) => {
  const {a, b, e, f} = body.transform.baseVal.consolidate().matrix;
  return {x: e, y: f, turn: Math.atan2(b, a) * 180 / Math.PI};
});

test("the slider moves them to where the trace has them", async () => {
  const {page, seen} = await open();
  assert.equal(await page.locator("#others path").count(), 1);
  const expected = (period) => page.evaluate((k) => {
    const {map} = JSON.parse(document.getElementById("episode-data").textContent);
    const poses = new Float32Array(Uint8Array.from(atob(map.others.poses), (c) => c.charCodeAt(0)).buffer);
    return {x: (poses[3 * k] - map.xLeft) * map.scale, y: (map.yTop - poses[3 * k + 1]) * map.scale,
            turn: -poses[3 * k + 2] * 180 / Math.PI};
  }, period);
  for (const period of [0, 7, 13, 20]) {
    await slideTo(page, period * kPeriod);
    const [place, wanted] = [await placeOf(page), await expected(period)];
    assert.ok(Math.hypot(place.x - wanted.x, place.y - wanted.y) < 0.2, `period ${period}`);
    const apart = (place.turn - wanted.turn) * Math.PI / 180;
    assert.ok(Math.abs(Math.sin(apart)) < 0.01 && Math.cos(apart) > 0, `period ${period}`);
  }
  assert.deepEqual(seen.errors, []);
  await page.screenshot({path: join(artefacts, "moving_obstacles.png"), fullPage: true});
  await page.close();
});

test("their forecasts grow along the plan, follow the period and can be hidden", async () => {
  const {page} = await open();
  const ellipses = () => page.locator("#layer-forecast ellipse").evaluateAll((all) => all.map((one) =>
    ({place: one.getAttribute("transform"), size: Number(one.getAttribute("rx")), opacity: Number(one.style.opacity)})));
  await slideTo(page, 0.5);
  const first = await ellipses();
  assert.ok(first.length >= 3);
  assert.ok(first.at(-1).size > first[0].size);
  assert.ok(first.at(-1).opacity < first[0].opacity);
  await slideTo(page, 1.5);
  assert.notEqual((await ellipses())[0].place, first[0].place);
  await page.locator('[data-layer="forecast"]').uncheck();
  assert.equal(await page.locator("#layer-forecast").isVisible(), false);
  await page.close();
});

// The number of blue pixels in the 3D view, and their centre.
const blueAt = async (page, time) =>
  pixelsOf(await pictureAt(page, time.toFixed(1)), (r, g, b) => b >= r + 60 && b >= g + 20);

test("they move in three dimensions, too", async () => {
  const {page, seen} = await open();
  await page.locator("#scene").scrollIntoViewIfNeeded();
  await page.locator("#scene canvas").waitFor();
  await page.locator("#scene .whole").click();
  await until(page, () => document.querySelector("#scene canvas").width > 0);
  await page.locator('[data-scene="forecast"]').uncheck();
  const first = await blueAt(page, 0.9);
  const second = await blueAt(page, 2.0);
  assert.ok(first.count > 50 && second.count > 50, `${first.count}, ${second.count} blue pixels`);
  assert.ok(second.x < first.x - 0.03, `from ${first.x} to ${second.x}`);
  assert.deepEqual(seen.errors, []);
  await page.close();
});
