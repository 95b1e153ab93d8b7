// The page of an episode in a real browser, opened from its file as a user would.
import assert from "node:assert/strict";
import {readFileSync, statSync, writeFileSync} from "node:fs";
import {join} from "node:path";
import {after, before, test} from "node:test";
import {pathToFileURL} from "node:url";

import {artefacts, openPage, qsmpc, readJson, sidewaysScroll, source, startBrowser, temporaryFolder,
        until} from "./pages.mjs";

const kSteps = 30;
const kPeriod = 0.1;  // s

let browser;
let folder;

before(async () => {
  folder = temporaryFolder();
  qsmpc("run", "dubins_corridor", "--quiet", "--out", folder,
        "--set", `limit.steps=${kSteps}`, "--set", "video.size=320x180", "--set", "video.fps=10");
  browser = await startBrowser();
});

after(async () => { await browser?.close(); });

const open = (options) => openPage(browser, join(folder, "report.html"), options);

// Moves the slider to a time as a user would.
const slideTo = (page, time) => page.locator("#time").fill(String(Number(time.toFixed(1))));

const vehiclePlace = (page) => page.locator("#vehicle").evaluate((vehicle) => {
  const {e, f} = vehicle.transform.baseVal.consolidate().matrix;
  return [e, f];
});

const now = (page, key) => page.locator(`[data-now="${key}"]`).first().textContent();

test("opens from its file without an error and asks for nothing but its video", async () => {
  const {page, seen, openedIn} = await open();
  await page.locator("#vehicle").waitFor({state: "attached"});
  assert.deepEqual(seen.errors, []);
  const video = pathToFileURL(join(folder, "episode.mp4")).href;
  assert.deepEqual([...new Set(seen.requests)], [video]);
  assert.ok(statSync(join(folder, "report.html")).size < 5e6);
  assert.ok(openedIn < 20_000);  // only catches a page that hangs; speed is measured elsewhere
  await page.close();
});

test("the slider moves the vehicle to where the trace has it", async () => {
  const {page} = await open();
  const at = async (period) => {
    await slideTo(page, period * kPeriod);
    return vehiclePlace(page);
  };
  const expected = (period) => page.evaluate((k) => {
    const {map} = JSON.parse(document.getElementById("episode-data").textContent);
    const poses = new Float32Array(Uint8Array.from(atob(map.poses), (c) => c.charCodeAt(0)).buffer);
    return [(poses[3 * k] - map.xLeft) * map.scale, (map.yTop - poses[3 * k + 1]) * map.scale];
  }, period);
  const start = await at(0);
  for (const period of [0, 7, 19, kSteps]) {
    const place = await at(period);
    const wanted = await expected(period);
    assert.ok(Math.abs(place[0] - wanted[0]) < 0.11, `${place} is not ${wanted}`);
    assert.ok(Math.abs(place[1] - wanted[1]) < 0.11, `${place} is not ${wanted}`);
  }
  const end = await at(kSteps);
  assert.ok(Math.hypot(end[0] - start[0], end[1] - start[1]) > 20);
  await page.close();
});

test("the slider moves particles, ellipses, the charts' mark and the table", async () => {
  const {page} = await open();
  // A chart's canvas as text, which reflects its drawn lines.
  await page.evaluate(() => {
    globalThis.inked = (id) => document.querySelector(`#${id} canvas`).toDataURL();
  });
  const picture = () => page.evaluate(() => ({
    dots: document.querySelector("#layer-particles path:not([d=''])").getAttribute("d"),
    ellipse: document.querySelector("#layer-ellipses ellipse").getAttribute("transform"),
    mark: document.querySelector("#charts .moment").style.left,
    plan: document.querySelector(".planned").getAttribute("d"),
    certificates: inked("stage-certificates"),
    budgets: inked("stage-budgets"),
  }));
  const settled = async () => {
    await page.waitForTimeout(100);  // charts draw after the task that changed them
    return picture();
  };
  await slideTo(page, 0.5);
  const first = await settled();
  assert.match(await now(page, "time"), /0\.50 s, period 6 of 30/);
  await slideTo(page, 2.1);
  const second = await settled();
  assert.match(await now(page, "time"), /2\.10 s, period 22 of 30/);
  for (const part of Object.keys(first)) assert.notEqual(first[part], second[part], part);
  await page.close();
});

test("clearance is the same in the table of the moment and in its chart, at the end too", async () => {
  // The charts' times are 32-bit numbers, the current time is not: this matters on a long drive.
  const long = temporaryFolder();
  const kLongPeriod = 1.3;  // s
  qsmpc("run", "double_integrator", "--quiet", "--no-video", "--out", long, "--fail-on", "none",
        "--set", "plant.kind=analytic", "--set", `time_step=${kLongPeriod}`,
        "--set", "limit={steps: 40, stop_when_unsafe: false}", "--set", "target.radius=1e-9");
  const {page} = await openPage(browser, join(long, "report.html"));
  const charted = () => page.evaluate(() => {
    const figure = [...document.querySelectorAll("#charts > figure")]
      .find((one) => one.querySelector("figcaption").textContent.startsWith("Clearance"));
    return figure.querySelectorAll(".u-legend .u-value")[1].textContent;
  });
  const unit = (await now(page, "clearance")).replace(/^\S+ /, "");
  for (let period = 0; period <= 40; ++period) {
    await slideTo(page, period * kLongPeriod);
    await page.waitForTimeout(20);  // legends follow after the task that moved the current time
    assert.equal(await now(page, "clearance"), `${await charted()} ${unit}`,
                 `period ${period}`);
  }
  await page.close();
});

test("what is drawn at the foot of an axis is read as it is", async () => {
  const {page} = await open();
  await slideTo(page, 0.5);
  await page.waitForTimeout(100);
  const read = await page.evaluate(() => {
    const figure = [...document.querySelectorAll("#charts > figure")]
      .find((one) => one.querySelector("figcaption").textContent.startsWith("Expected cost"));
    const rows = [...figure.querySelectorAll(".u-legend .u-series")];
    return rows.find((row) => row.textContent.startsWith("nearness to obstacles")).querySelector(".u-value").textContent;
  });
  assert.equal(read, "0");
  await page.close();
});

// The distance of a plot from its chart's left edge (pixels), and the number of canvas lines with
// text just to the left of the plot.
const axisOf = (page, figure) => page.locator(figure).first().evaluate((one) => {
  const canvas = one.querySelector("canvas");
  const room = one.querySelector(".u-over").getBoundingClientRect().left - canvas.getBoundingClientRect().left;
  const right = Math.floor((room - 14) * devicePixelRatio);  // left of the ticks
  const {data, width} = canvas.getContext("2d").getImageData(right - 12, 0, 12, canvas.height);
  const written = new Set();
  for (let i = 3; i < data.length; i += 4) if (data[i] > 100) written.add(Math.floor(i / 4 / width));
  return {room, written: written.size};
});

test("an axis has room for its numbers, and numbers however far it reaches", async () => {
  const run = async (scenario, ...words) => {
    const out = temporaryFolder();
    qsmpc("run", scenario, "--quiet", "--no-video", "--fail-on", "none", "--out", out, "--set", "limit.steps=6", ...words);
    const {page} = await openPage(browser, join(out, "report.html"));
    await page.waitForTimeout(300);
    return page;
  };
  const input = "#charts > figure:nth-child(3)";
  const plain = await axisOf((await open()).page, input);
  const small = await run("double_integrator", "--set", "initial_state={mean: [2, 3e-5], covariance: [1e-14, 1e-14]}",
                          "--set", "disturbance.covariance=[1e-14, 1e-14]", "--set", "target.radius=1e-9",
                          "--set", "controller.kind=lqr");
  assert.match(await small.locator(`${input} figcaption`).textContent(), /Input/);
  const {room} = await axisOf(small, input);
  assert.ok(room > plain.room + 4, `${plain.room} pixels, then ${room} for powers of ten`);
  // Bounds that grow by decades per stage, beyond the numbers of a linear axis or one of 40
  // decades.
  const budgets = await axisOf(await run("cart_pole"), "#stage-budgets");
  assert.ok(budgets.written > 20, `${budgets.written} lines of numbers`);
});

test("what is no bound is not called one", async () => {
  const noisy = temporaryFolder();
  qsmpc("run", "dubins_corridor", "--quiet", "--no-video", "--out", noisy, "--set", "limit.steps=3",
        "--set", "disturbance.sensor=[0.01, 0.01, 0.001]");
  const {page, seen} = await openPage(browser, join(noisy, "report.html"));
  assert.deepEqual(seen.errors, []);
  assert.match(await page.locator("#no-bound").textContent(), /No certificate is a bound here/);
  assert.match(await page.locator("#now").textContent(), /Certified, next step: not a bound/);
  assert.doesNotMatch(await page.locator("#now").textContent(), /P\(unsafe\)/);
  await page.close();
});

test("the video seeks with the slider", async () => {
  const {page} = await open();
  await until(page, () => document.querySelector("video").readyState >= 1);
  for (const time of [1.5, 0.4]) {
    await slideTo(page, time);
    await until(page, (t) => {
      const video = document.querySelector("video");
      return !video.seeking && Math.abs(video.currentTime - t) < 0.02;
    }, time);
  }
  await page.close();
});

test("the page follows when the video is moved by its own controls, and when it plays", async () => {
  const {page} = await open();
  await until(page, () => document.querySelector("video").readyState >= 1);
  await page.evaluate(() => { document.querySelector("video").currentTime = 2.0; });
  await until(page, () => Math.abs(Number(document.getElementById("time").value) - 2) < 0.06);
  await page.locator("#play").click();
  await until(page, () => Number(document.getElementById("time").value) > 2.25);
  assert.equal(await page.locator("#play").textContent(), "Pause");
  await page.locator("#play").click();
  assert.equal(await page.evaluate(() => document.querySelector("video").paused), true);
  await page.close();
});

test("without its video the page plays by its own clock", async () => {
  const alone = temporaryFolder();
  const page_text = readFileSync(join(folder, "report.html"), "utf8")
    .replace(/<figure class="card">\n<figcaption>Video[\s\S]*?<\/figure>/, "");
  writeFileSync(join(alone, "report.html"), page_text);
  const {page, seen} = await openPage(browser, join(alone, "report.html"));
  await page.locator("#play").click();
  await until(page, () => Number(document.getElementById("time").value) > 0.3);
  assert.deepEqual(seen.errors, []);
  assert.deepEqual(seen.requests, []);
  await page.close();
});

test("shows the numbers of summary.json", async () => {
  const summary = readJson(join(folder, "summary.json"));
  const {page} = await open();
  const tiles = new Map(await page.locator(".tile").evaluateAll((all) =>
    all.map((tile) => [tile.querySelector("dt").textContent, tile.querySelector(".value").textContent])));
  // "1.2 × 10⁻⁵" and "−3.4 m" as numbers.
  const number = (text) => Number(text.replace("−", "-")
    .replace(/ × 10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)/, (_, power) => "e" + power.replace("⁻", "-")
      .replace(/[⁰¹²³⁴⁵⁶⁷⁸⁹]/g, (d) => "⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(d)))
    .split(" ")[0]);
  // Three digits are shown, with upper bounds rounded up.
  const near = (text, value) => assert.ok(
    Math.abs(number(text) - value) <= 0.011 * Math.abs(value), `${text} is not ${value}`);
  near(tiles.get("Minimum clearance"), summary.min_clearance);
  near(tiles.get("Largest next-step certificate"), summary.certificate.next_step.max);
  near(tiles.get("Largest plan certificate"), summary.certificate.horizon.max);
  near(tiles.get("Published method, largest"), summary.certificate.thesis.max);
  near(tiles.get("Closed-loop cost"), summary.cost.closed_loop);
  const [median, p99] = tiles.get("Solve time, median / 99th percentile").split(" / ");
  near(median, summary.ocp_ms.median);
  near(p99, summary.ocp_ms.p99);
  assert.equal(tiles.get("Deadline misses"), `${summary.deadline_misses} of ${summary.steps}`);
  assert.equal(tiles.get("Entered the unsafe set"), summary.collision ? "yes" : "no");
  await page.close();
});

test("the near view follows the vehicle", async () => {
  const {page} = await open();
  await page.locator("#near-view").check();
  for (const time of [0.3, 2.4]) {
    await slideTo(page, time);
    const off = await page.evaluate(() => {
      const middle = (element) => {
        const {left, right, top, bottom} = element.getBoundingClientRect();
        return [(left + right) / 2, (top + bottom) / 2];
      };
      const vehicle = middle(document.getElementById("vehicle"));
      const frame = middle(document.querySelector("#live-map .frame"));
      return Math.hypot(vehicle[0] - frame[0], vehicle[1] - frame[1]);
    });
    assert.ok(off < 8, `${off} pixels from the middle`);
  }
  await page.close();
});

test("is used with the keyboard alone", async () => {
  const {page} = await open();
  await page.locator("#time").focus();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  assert.match(await now(page, "time"), /^0\.20 s/);
  await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");  // one period on
  assert.match(await now(page, "time"), /^0\.30 s/);
  await page.locator('[data-layer="particles"]').focus();
  await page.keyboard.press("Space");
  assert.equal(await page.locator("#layer-particles").isVisible(), false);
  await page.close();
});

test("a scenario's name that is a script does nothing", async () => {
  const attack = "<script>alert(1)</script>";
  const file = join(temporaryFolder(), "attack.yaml");
  const text = readFileSync(join(source, "models/scenarios/dubins_corridor.yaml"), "utf8");
  writeFileSync(file, text.replace(/^name:.*$/m, `name: ${JSON.stringify(attack)}`)
    .replace(/^description:.*$/m, `description: ${JSON.stringify(attack + "<img src=x onerror=alert(2)>")}`));
  const out = temporaryFolder();
  qsmpc("run", file, "--quiet", "--no-video", "--out", out, "--set", "limit.steps=3");
  const {page, seen} = await openPage(browser, join(out, "report.html"));
  await slideTo(page, 0.2);
  assert.deepEqual(seen.dialogs, []);
  assert.deepEqual(seen.errors, []);
  assert.deepEqual(seen.requests, []);
  assert.equal(await page.locator("img").count(), 0);
  assert.match(await page.locator(".kicker").textContent(), /<script>alert\(1\)<\/script>/);
  assert.match(await page.title(), /^<script>alert\(1\)<\/script>/);
  await page.close();
});

test("its policy stops a script that is put into it", async () => {
  const out = temporaryFolder();
  const page_text = readFileSync(join(folder, "report.html"), "utf8");
  writeFileSync(join(out, "report.html"), page_text.replace("<body>", "<body><script>alert(3)</script>"));
  const {page, seen} = await openPage(browser, join(out, "report.html"));
  assert.deepEqual(seen.dialogs, []);
  assert.match(seen.errors.join("\n"), /Content Security Policy/);
  await page.close();
});

test("a system without a place in the plane has its charts, and a map of two states", async () => {
  const out = temporaryFolder();
  qsmpc("run", "double_integrator", "--quiet", "--no-video", "--out", out, "--set", "limit.steps=5");
  const {page, seen} = await openPage(browser, join(out, "report.html"));
  await slideTo(page, 0.2);
  assert.deepEqual(seen.errors, []);
  assert.ok(await page.locator("#live-map").isVisible());
  assert.match(await page.locator("#live-map svg").first().textContent(), /velocity \(m\/s\)/);
  assert.ok(await page.locator("#live-map .dots[d]:not([d=''])").count() > 0);
  assert.ok(await page.locator("#charts .plot").count() >= 6);
  await page.close();
});

for (const [name, options] of Object.entries({
  light: {colorScheme: "light"},
  dark: {colorScheme: "dark"},
  narrow: {colorScheme: "light", viewport: {width: 390, height: 844}, deviceScaleFactor: 2, isMobile: true},
})) {
  test(`looks as it should: ${name}`, async () => {
    const {page, seen} = await open(options);
    await slideTo(page, 1.5);
    await page.waitForTimeout(300);
    assert.deepEqual(seen.errors, []);
    assert.equal(await sidewaysScroll(page), 0);
    const ground = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    assert.equal(ground, name === "dark" ? "rgb(16, 21, 26)" : "rgb(244, 246, 248)");
    await page.screenshot({path: join(artefacts, `episode-${name}.png`), fullPage: true});
    await page.close();
  });
}

test("without scripts there are the drawings, the tables and the video", async () => {
  const {page, seen} = await open({javaScriptEnabled: false});
  assert.deepEqual(seen.errors, []);
  assert.equal(await page.locator(".player").isVisible(), false);
  assert.ok(await page.locator("#charts svg[role=img]").first().isVisible());
  assert.ok(await page.locator("video").isVisible());
  await page.close();
});
