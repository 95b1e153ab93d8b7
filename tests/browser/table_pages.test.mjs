// The pages of a comparison and of a campaign in a real browser.
import assert from "node:assert/strict";
import {existsSync, writeFileSync} from "node:fs";
import {join} from "node:path";
import {after, before, test} from "node:test";
import {fileURLToPath} from "node:url";

import {artefacts, openPage, qsmpc, readJson, sidewaysScroll, startBrowser, temporaryFolder}
  from "./pages.mjs";

const attack = "<script>alert(1)</script>";

let browser;
const folders = {};

before(async () => {
  folders.comparison = temporaryFolder();
  qsmpc("compare", "dubins_corridor", "--plant", "analytic", "--plant", "mujoco_planar", "--quiet",
        "--episodes", "2", "--paths", "40", "--set", "limit.steps=8", "--out", folders.comparison);
  folders.campaign = temporaryFolder();
  const file = join(temporaryFolder(), "attack.yaml");
  writeFileSync(file, `name: ${JSON.stringify(attack)}\nscenario: dubins_corridor\n` +
    "variants: {closed: {}, \"<b>open</b>\": {controller.policy: open_loop}}\n" +
    "grid: {limit.steps: [8]}\nseeds: {count: 3}\nplants: [analytic]\ntraces: all\n");
  qsmpc("campaign", file, "--quiet", "--out", folders.campaign);
  qsmpc("report", folders.campaign, "--worst", "1", "--quiet");
  browser = await startBrowser();
});

after(async () => { await browser?.close(); });

for (const kind of ["comparison", "campaign"]) {
  for (const [name, options] of Object.entries({
    light: {colorScheme: "light"},
    dark: {colorScheme: "dark"},
    narrow: {viewport: {width: 390, height: 844}, deviceScaleFactor: 2, isMobile: true},
  })) {
    test(`${kind}: ${name}: opens without an error, asks for nothing, fits the screen`, async () => {
      const {page, seen} = await openPage(browser, join(folders[kind], "report.html"), options);
      assert.deepEqual(seen, {errors: [], requests: [], dialogs: []});
      assert.equal(await sidewaysScroll(page), 0);
      // Its style is applied: the policy allows it by its hash.
      const ground = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
      assert.equal(ground, name === "dark" ? "rgb(16, 21, 26)" : "rgb(244, 246, 248)");
      assert.ok(await page.locator("figure svg[role=img]").count() > 2);
      await page.screenshot({path: join(artefacts, `${kind}-${name}.png`), fullPage: true});
      await page.close();
    });
  }

  test(`${kind}: its tables are scrolled with the keyboard alone`, async () => {
    const {page} = await openPage(browser, join(folders[kind], "report.html"),
                                  {viewport: {width: 390, height: 844}});
    const wide = await page.evaluate(() => {
      const tables = [...document.querySelectorAll("[role=region][tabindex='0']")];
      const table = tables.find((region) => region.scrollWidth > region.clientWidth + 20);
      table?.focus();
      table?.setAttribute("id", "wide");
      return table?.getAttribute("aria-label");
    });
    assert.ok(wide);
    for (let i = 0; i < 3; ++i) await page.keyboard.press("ArrowRight");
    await page.waitForTimeout(300);
    assert.ok(await page.evaluate(() => document.getElementById("wide").scrollLeft) > 0);
    await page.close();
  });
}

test("a comparison's page shows the numbers of comparison.json", async () => {
  const numbers = readJson(join(folders.comparison, "comparison.json"));
  const {page} = await openPage(browser, join(folders.comparison, "report.html"));
  const text = await page.locator("body").innerText();
  for (const [plant, values] of Object.entries(numbers.plants)) {
    const row = text.split("\n").find((line) => line.startsWith(plant));
    assert.ok(row, plant);
    const {cost} = values.closed_loop;
    const shown = row.split(/\s+/).map(Number);
    assert.ok(shown.some((number) => Math.abs(number - cost) < 0.005 * cost), `${cost}: ${row}`);
  }
  await page.close();
});

test("a campaign's page shows the numbers of campaign.json, and names that are markup as text", async () => {
  const numbers = readJson(join(folders.campaign, "campaign.json"));
  const {page} = await openPage(browser, join(folders.campaign, "report.html"));
  assert.match(await page.locator(".kicker").first().textContent(), new RegExp(`${numbers.done} of ${numbers.episodes}`));
  assert.equal(await page.locator("h1").textContent(), attack);
  assert.equal(await page.locator("table b").count(), 0);
  await page.close();
});

test("a campaign's worst episode is one click away, with its video", async () => {
  const {page} = await openPage(browser, join(folders.campaign, "report.html"));
  const links = await page.locator("a[href]").evaluateAll((all) => all.map((link) => link.href));
  assert.ok(links.length > 0);
  for (const link of links) assert.ok(existsSync(fileURLToPath(link)), link);
  assert.ok(links.some((link) => link.endsWith(".mp4")));
  await page.locator("a[href$='report.html']").first().click();
  await page.locator("#vehicle").waitFor({state: "attached"});
  assert.ok(await page.locator("video").isVisible());
  await page.close();
});
