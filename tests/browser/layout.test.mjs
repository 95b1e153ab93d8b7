// Every kind of page on a desktop and a phone screen, in light and dark mode: nothing overlaps,
// nothing is clipped, no panel is empty. Judged from boxes, not from pictures.
import assert from "node:assert/strict";
import {writeFileSync} from "node:fs";
import {join} from "node:path";
import {after, before, test} from "node:test";

import {emptyColumns, layoutProblems, lonelyTiles} from "./layout.mjs";
import {artefacts, openPage, qsmpc, softwareGl, startBrowser, temporaryFolder} from "./pages.mjs";

const screens = {
  desktop: {viewport: {width: 1440, height: 900}},
  telephone: {viewport: {width: 390, height: 844}, deviceScaleFactor: 2, isMobile: true},
};

let browser;
const folders = {};

before(async () => {
  const run = (name, scenario, ...words) => {
    folders[name] = temporaryFolder();
    qsmpc("run", scenario, "--quiet", "--fail-on", "none", "--out", folders[name], ...words);
  };
  run("episode", "dubins_corridor", "--set", "limit.steps=30", "--set", "video.size=320x180",
      "--set", "video.fps=10");
  run("episode_without_video", "dubins_obstacles", "--no-video", "--set", "limit.steps=30");
  run("episode_without_plan", "dubins_obstacles", "--no-video", "--set", "controller.kind=lqr",
      "--set", "risk={}", "--set", "limit.steps=30");
  run("episode_without_plane", "double_integrator", "--no-video", "--set", "limit.steps=10");
  run("episode_of_a_cart", "cart_pole_balance", "--no-video", "--set", "limit.steps=10");
  folders.comparison = temporaryFolder();
  qsmpc("compare", "bicycle_obstacles", "--plant", "analytic", "--plant", "mujoco", "--quiet", "--episodes", "2",
        "--paths", "40", "--set", "limit.steps=8", "--out", folders.comparison);
  folders.comparison_of_one = temporaryFolder();
  qsmpc("compare", "cart_pole_balance", "--plant", "mujoco", "--quiet", "--episodes", "2", "--paths", "40",
        "--set", "limit.steps=8", "--out", folders.comparison_of_one);
  const campaign = (name, text) => {
    const file = join(temporaryFolder(), `${name}.yaml`);
    writeFileSync(file, `name: ${name}\n${text}`);
    folders[name] = temporaryFolder();
    qsmpc("campaign", file, "--quiet", "--out", folders[name]);
  };
  campaign("campaign", "scenario: dubins_obstacles\nvariants: {closed: {}, open: {controller.policy: open_loop}, " +
    "greedy: {controller.horizon: 3}}\nseeds: {count: 6}\ngrid: {limit.steps: [60], controller.quantisation: [auto]}\n" +
    "plants: [analytic]\ntraces: none\n");
  campaign("campaign_without_plane", "scenario: cart_pole_balance\nseeds: {count: 4}\ntraces: none\n");
  campaign("campaign_of_one", "scenario: dubins_corridor\nseeds: {count: 6}\ntraces: none\n");
  campaign("campaign_rare", "scenario: dubins_corridor\nvariants: {lqr: {controller.kind: lqr, controller.lqr.about: " +
    "target, initial_state.mean: [0, 1, 0], safe_set.bounds: {x: [-1, 14], y: [-0.15, 2.15]}, limit.steps: 40}}\n" +
    "seeds: {count: 4}\nrare: {particles: 20}\nuntil: {rate_halfwidth: 0.2}\ntraces: none\n");
  folders.contest = temporaryFolder();
  const contest = join(temporaryFolder(), "contest.yaml");
  writeFileSync(contest, "description: Three ways to drive\n" +
    "controllers: {quantised: {controller.quantisation: auto}, nominal: {controller.kind: nominal, risk: {}}, " +
    "lqr: {controller.kind: lqr, risk: {}}}\nscenarios: [dubins_obstacles, dubins_alley]\n" +
    "plants: [analytic]\nseeds: {count: 4}\ntiming: {seeds: 1}\ntuning: {seeds: [9], " +
    "budget: 2, search: {lqr: {controller.lqr.about: [path, target]}}}\n");
  qsmpc("contest", contest, "--quiet", "--out", folders.contest);
  browser = await startBrowser(softwareGl);
});

after(async () => { await browser?.close(); });

const pages = ["episode", "episode_without_video", "episode_without_plan", "episode_without_plane", "episode_of_a_cart",
               "comparison", "comparison_of_one", "campaign", "campaign_of_one", "campaign_without_plane",
               "campaign_rare", "contest"];
const pageOf = (name) => join(folders[name], name === "contest" ? "contest.html" : "report.html");

// What is wrong with a page's layout, with a picture of it if anything is.
async function checkLayout(page, name, screen, colorScheme) {
  try {
    assert.deepEqual(await page.evaluate(layoutProblems, {wide: screen === "desktop"}), []);
    assert.deepEqual(await page.evaluate(lonelyTiles), []);
    if (!name.startsWith("campaign") && name !== "contest") assert.deepEqual(await page.evaluate(emptyColumns), []);
  } catch (problem) {
    await page.screenshot({path: join(artefacts, `layout-${name}-${screen}-${colorScheme}.png`), fullPage: true});
    throw problem;
  }
}

for (const name of pages) {
  for (const [screen, size] of Object.entries(screens)) {
    test(`${name}: ${screen}: no overlap, no clipping, no empty panel, be it light or dark`, async () => {
      const {page, seen} = await openPage(browser, pageOf(name), {...size, colorScheme: "light"});
      await page.waitForTimeout(300);  // charts draw after the page has loaded
      if (await page.locator("#scene").isVisible()) {  // drawn only when scrolled into view
        await page.locator("#scene").scrollIntoViewIfNeeded();
        await page.locator("#scene canvas").waitFor();
        await page.evaluate(() => window.scrollTo(0, 0));
      }
      await page.locator("details").evaluateAll((all) => all.forEach((one) => { one.open = true; }));
      await checkLayout(page, name, screen, "light");
      await page.emulateMedia({colorScheme: "dark"});
      await page.waitForTimeout(100);  // charts draw again
      await checkLayout(page, name, screen, "dark");
      assert.deepEqual(seen.errors, []);
      await page.close();
    });
  }
}

test("the layout's check sees what it is for", async () => {
  const {page} = await openPage(browser, join(folders.campaign, "report.html"), screens.desktop);
  const problemsAfter = (change) => page.evaluate(change).then(() => page.evaluate(layoutProblems, {wide: true}));
  assert.deepEqual(await problemsAfter(() => {}), []);
  const has = (problems, words) => assert.ok(problems.some((problem) => problem.startsWith(words)), words);
  has(await problemsAfter(() => {
    const drawing = document.querySelector("figure.card svg[role=img]");
    drawing.querySelectorAll("text")[1].setAttribute("x", drawing.querySelectorAll("text")[0].getAttribute("x"));
  }), "texts overlap");
  has(await problemsAfter(() => {
    document.querySelector("figure.card").replaceChildren(document.createElement("figcaption"));
  }), "empty panel");
  has(await problemsAfter(() => { document.querySelector("tbody td").textContent = "x".repeat(400); }), "clipped");
  const cards = () => {
    const [first, second] = document.querySelectorAll(".grid > figure");
    second.style.cssText = "position: relative";
    second.style.top = `${first.getBoundingClientRect().top - second.getBoundingClientRect().top}px`;
    second.style.left = `${first.getBoundingClientRect().left - second.getBoundingClientRect().left}px`;
  };
  has(await problemsAfter(cards), "overlaps another panel");
  has(await problemsAfter(() => { document.querySelector("h1").style.cssText = "width: 3000px"; }), "beyond the screen");
  await page.close();
});

test("on a telephone the player stands before the numbers, with the drive on the first screen", async () => {
  const {page} = await openPage(browser, join(folders.episode, "report.html"), screens.telephone);
  const boxOf = (part) => page.locator(part).first().boundingBox();
  const tops = {};
  for (const part of [".outcome", ".player", "video", "#live-map", ".tile", "#now"]) tops[part] = (await boxOf(part)).y;
  assert.ok(tops[".outcome"] < tops[".player"]);
  assert.ok(tops[".player"] < tops.video);
  assert.ok(tops.video < tops["#live-map"]);
  assert.ok(tops["#live-map"] < tops["#now"]);
  assert.ok(tops["#now"] < tops[".tile"]);
  const video = await boxOf("video");
  assert.ok(video.y + video.height < screens.telephone.viewport.height);
  await page.close();
});

test("the near view has axes that follow the vehicle", async () => {
  const {page} = await openPage(browser, join(folders.episode_without_video, "report.html"), screens.desktop);
  await page.locator("#near-view").check();
  const numbers = async (time) => {
    await page.locator("#time").fill(time);
    return page.locator(".near-axes text.middle").allTextContents();
  };
  const start = await numbers("0");
  const end = await numbers("3");
  assert.ok(start.length >= 3, String(start));
  assert.notDeepEqual(start, end);
  for (const text of [...start, ...end]) assert.match(text, /^−?\d+(\.\d+)?$/);
  await page.locator("#near-view").uncheck();
  assert.equal(await page.locator(".near-axes text").count(), 0);
  await page.close();
});

test("a contest's figure, words and table are on a desktop's first screen", async () => {
  const {page} = await openPage(browser, pageOf("contest"), screens.desktop);
  for (const part of [".contest figure", ".rivals li:last-child", ".results"]) {
    const box = await page.locator(part).first().boundingBox();
    assert.ok(box.y + box.height <= screens.desktop.viewport.height, part);
  }
  assert.equal(await page.locator(".rivals li").count(), 3);
  await page.close();
});
