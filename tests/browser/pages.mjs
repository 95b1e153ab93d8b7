// Shared by the tests of pages: the program, folders of results, and a browser that records
// everything a page does.
//
// The environment gives the paths: QSMPC_PROGRAM, QSMPC_SOURCE, QSMPC_NODE_MODULES, and
// QSMPC_ARTEFACTS, where screenshots are kept.
import {execFileSync} from "node:child_process";
import {existsSync, mkdirSync, mkdtempSync, readFileSync} from "node:fs";
import {createRequire} from "node:module";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {pathToFileURL} from "node:url";

const required = (name) => {
  if (!process.env[name]) throw new Error(`${name} is not set`);
  return process.env[name];
};

const {chromium} = createRequire(join(required("QSMPC_NODE_MODULES"), "x.js"))("playwright-core");

export const artefacts = required("QSMPC_ARTEFACTS");
export const source = required("QSMPC_SOURCE");
mkdirSync(artefacts, {recursive: true});

export const temporaryFolder = () => mkdtempSync(join(tmpdir(), "qsmpc_browser_"));

export function qsmpc(...words) {
  return execFileSync(required("QSMPC_PROGRAM"), words, {encoding: "utf8", stdio: ["ignore", "pipe", "pipe"]});
}

export const readJson = (path) => JSON.parse(readFileSync(path, "utf8"));

// Software WebGL, for the 3D view.
export const softwareGl = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

// `more`: further Chromium options.
export function startBrowser(more = []) {
  const executablePath = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"]
    .find(existsSync);
  if (!executablePath) throw new Error("no Chromium; install the package chromium");
  // Tests may run as root, where Chromium's sandbox does not work.
  return chromium.launch({executablePath, args: ["--no-sandbox", "--disable-gpu", ...more]});
}

// Opens a page from its file. `seen` collects its logged errors, exceptions, requests (except for
// itself) and dialogs.
export async function openPage(browser, file, options = {}) {
  const context = await browser.newContext({viewport: {width: 1280, height: 900}, ...options});
  const page = await context.newPage();
  const seen = {errors: [], requests: [], dialogs: []};
  page.on("console", (message) => {
    if (message.type() === "error") seen.errors.push(message.text());
  });
  page.on("pageerror", (error) => seen.errors.push(String(error)));
  page.on("dialog", (dialog) => {
    seen.dialogs.push(dialog.message());
    dialog.dismiss();
  });
  const url = pathToFileURL(file).href;
  page.on("request", (request) => {
    if (request.url() !== url) seen.requests.push(request.url());
  });
  const begin = performance.now();
  await page.goto(url, {waitUntil: "load"});
  return {page, seen, context, openedIn: performance.now() - begin};
}

// Waits until `holds(argument)`, evaluated in the page, is true. (Playwright's own function
// evaluates text in the page, which the page's policy forbids.)
export async function until(page, holds, argument) {
  const patience = performance.now() + 20_000;
  while (!(await page.evaluate(holds, argument))) {
    if (performance.now() > patience) throw new Error(`it never came true: ${holds}`);
    await page.waitForTimeout(20);
  }
}

// By how many pixels the page is wider than the screen: phone readers would have to scroll
// sideways.
export const sidewaysScroll = (page) =>
  page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
