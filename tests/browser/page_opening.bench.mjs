// How long an episode's page takes to open and to follow its slider: medians of several times, each
// in a new window. Fails if a page has 5 MB or more, or takes 2 s or more.
import {statSync} from "node:fs";
import {join} from "node:path";

import {openPage, qsmpc, startBrowser, temporaryFolder} from "./pages.mjs";

const kTimes = 7;
const kMostBytes = 5e6;
const kMostMilliseconds = 2000;

const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

// Time from the request to the first complete picture, and time of one slider move.
async function measure(browser, file) {
  const {page, context} = await openPage(browser, file);
  const times = await page.evaluate(() => new Promise((resolve) => {
    requestAnimationFrame(() => requestAnimationFrame(() => {
      const opened = performance.now();
      const slider = document.getElementById("time");
      const slides = 100;
      for (let i = 0; i < slides; ++i) {
        slider.value = Number(slider.max) * i / slides;
        slider.dispatchEvent(new Event("input"));
      }
      resolve({opened, slide: (performance.now() - opened) / slides});
    }));
  }));
  await context.close();
  return times;
}

const browser = await startBrowser();
let kept = true;
for (const [scenario, ...settings] of [
  ["dubins_obstacles"],
  ["dubins_obstacles", "--set", "controller.horizon=18", "--set", "target.radius=0.01", "--set", "limit.steps=400"],
]) {
  const folder = temporaryFolder();
  qsmpc("run", scenario, "--quiet", "--no-video", "--out", folder, ...settings);
  const file = join(folder, "report.html");
  const times = [];
  for (let i = 0; i < kTimes; ++i) times.push(await measure(browser, file));
  const opened = median(times.map((time) => time.opened));
  const bytes = statSync(file).size;
  console.log(`${[scenario, ...settings].join(" ")}: ${(bytes / 1e6).toFixed(2)} MB, opens in ` +
              `${opened.toFixed(0)} ms, follows the slider in ` +
              `${median(times.map((time) => time.slide)).toFixed(1)} ms (medians of ${kTimes})`);
  kept &&= bytes < kMostBytes && opened < kMostMilliseconds;
}
await browser.close();
process.exitCode = kept ? 0 : 1;
