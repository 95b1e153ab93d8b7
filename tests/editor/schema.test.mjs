// An editor with the YAML language server accepts every file that qsmpc accepts, and marks the line
// of each error in a file that qsmpc refuses.
import assert from "node:assert/strict";
import {mkdtempSync, readdirSync, readFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {after, before, test} from "node:test";
import {LanguageServer, qsmpc, source} from "./language_server.mjs";

const shipped = (folder) =>
  readdirSync(join(source, folder))
    .filter((name) => name.endsWith(".yaml"))
    .map((name) => ({name, text: readFileSync(join(source, folder, name), "utf8")}));

const server = new LanguageServer();
before(() => server.start());
after(() => server.stop());

const corridor = readFileSync(join(source, "models/scenarios/dubins_corridor.yaml"), "utf8");
const policies = readFileSync(join(source, "models/campaigns/dubins_policies.yaml"), "utf8");

test("every shipped scenario is taken as it is", async () => {
  const scenarios = shipped("models/scenarios");
  assert.ok(scenarios.length > 10);
  for (const {name, text} of scenarios) {
    assert.deepEqual(await server.diagnose("scenario", text), [], name);
  }
});

test("a system of the user's is taken, by equations and from a library", async () => {
  for (const example of ["lag_unicycle", "planar_quadrotor"]) {
    for (const file of ["scenario.yaml", "scenario_cpp.yaml"]) {
      const text = readFileSync(join(source, "examples", example, file), "utf8");
      assert.deepEqual(await server.diagnose("scenario", text), [], `${example}/${file}`);
    }
  }
});

test("a wrong key of a user's system is marked", async () => {
  const text = readFileSync(join(source, "examples/lag_unicycle/scenario.yaml"), "utf8");
  const found = await server.diagnose("scenario", text.replace("  define:", "  defines:"));
  assert.match(found.map((one) => one.message).join("\n"), /Valid values: "system", "library"/);
});

test("every shipped campaign is taken as it is", async () => {
  const campaigns = shipped("models/campaigns");
  assert.ok(campaigns.length > 3);
  for (const {name, text} of campaigns) {
    assert.deepEqual(await server.diagnose("campaign", text), [], name);
  }
});

test("every shipped contest is taken as it is, and a wrong key of one is marked", async () => {
  const contests = shipped("models/contests");
  assert.ok(contests.length > 0);
  for (const {name, text} of contests) {
    assert.deepEqual(await server.diagnose("contest", text), [], name);
    const found = await server.diagnose("contest", text.replace(/^ {2}budget:/m, "  budgets:"));
    assert.match(found.map((one) => one.message).join("\n"), /budget/);
  }
});

test("the scenario that an episode leaves is taken", async () => {
  const folder = mkdtempSync(join(tmpdir(), "qsmpc_resolved_"));
  for (const {name} of shipped("models/scenarios")) {
    const scenario = name.replace(".yaml", "");
    qsmpc("run", scenario, "--no-video", "--set", "limit.steps=1", "--out", join(folder, scenario));
    const resolved = readFileSync(join(folder, scenario, "scenario.yaml"), "utf8");
    assert.deepEqual(await server.diagnose("scenario", resolved), [], name);
  }
});

// Replacements of a piece of a shipped scenario, and the editor's message at that line.
for (const [right, wrong, says] of [
  ["  horizon: 8", "  horzon: 8", /horzon is not allowed/],
  ["solver: lbfgs", "solver: lbfgz", /Value is not accepted.*lbfgs.*slsqp/s],
  ["noise: 100", "quantiser: loyd", /Value is not accepted.*lloyd/s],
  ["propagate_noise: true", "propagate_noise: maybe", /Incorrect type/],
  ["max_iterations: 100", "deadline: soon", /Incorrect type/],
  ["max_iterations: 100", "deadline: 0", /exclusive minimum of 0/],
  ["max_iterations: 100", "threads: 1.5", /Incorrect type/],
  ["steps: 200", "steps: 0", /minimum of 1/],
  // Names and sizes of another system.
  ["y: [-1, 3]", "z: [-1, 3]", /Valid values: "x", "y", "heading"/],
  ["y: [-1, 3]", "pole_angle: [-1, 3]", /Valid values: "x", "y", "heading"/],
  ["speed: 1.5", "gravity: 9.8", /Valid values: "system", "speed"/],
  ["covariance: [0.01, 0.01, 0.001]", "covariance: [0.01, 0.01]", /too few items/],
]) {
  test(`"${wrong.trim()}" is marked at its line`, async () => {
    assert.equal(corridor.split(right).length, 2, `"${right}" is in the scenario once`);
    const text = corridor.replace(right, wrong);
    const found = await server.diagnose("scenario", text);
    const line = text.split("\n").findIndex((one) => one.includes(wrong)) + 1;
    assert.deepEqual([...new Set(found.map((one) => one.line))], [line]);
    assert.match(found.map((one) => one.message).join("\n"), says);
  });
}

const passage = readFileSync(join(source, "models/scenarios/narrow_passage.yaml"), "utf8");
for (const [right, wrong, says] of [
  ["{disc: {centre", "{disk: {centre", /Valid values: "x", "y", "heading", "disc", "ellipse"/],
  ["radius: 0.4}", "radius: -1}", /minimum of/],
  ["radius: 0.4}", "raduis: 0.4}", /raduis is not allowed/],
  ["[[7.5, 7], [9.5, 7], ", "[[7.5, 7], ", /too few items/],
]) {
  test(`"${wrong.trim()}" of a shape is marked at its line`, async () => {
    assert.equal(passage.split(right).length, 2, `"${right}" is in the scenario once`);
    const text = passage.replace(right, wrong);
    const found = await server.diagnose("scenario", text);
    const line = text.split("\n").findIndex((one) => one.includes(wrong)) + 1;
    assert.deepEqual([...new Set(found.map((one) => one.line))], [line]);
    assert.match(found.map((one) => one.message).join("\n"), says);
  });
}

test("a scenario without what it needs is marked", async () => {
  const found = await server.diagnose("scenario", corridor.replace(/^target: .*$/m, ""));
  assert.match(found.map((one) => one.message).join("\n"), /Missing property "target"/);
});

test("an infinite bound is taken", async () => {
  const text = corridor.replace("y: [-1, 3]", "y: [-.inf, .inf]");
  assert.notEqual(text, corridor);
  assert.deepEqual(await server.diagnose("scenario", text), []);
});

test("a wrong key of a campaign is marked at its line", async () => {
  const text = policies.replace("plants:", "plnats:");
  const found = await server.diagnose("campaign", text);
  assert.deepEqual(found.map((one) => text.split("\n")[one.line - 1]), ["plnats: [analytic]"]);
  assert.match(found[0].message, /plnats is not allowed/);
});

test("a campaign needs one of scenario and scenarios", async () => {
  const found = await server.diagnose("campaign", policies.replace(/^scenarios: .*$/m, ""));
  assert.equal(found.length, 1);
});

test("the editor shows a key's words, range, unit and default", async () => {
  const lines = corridor.split("\n");
  const line = lines.findIndex((one) => one.startsWith("time_step:"));
  const shown = await server.hover("scenario", corridor, line + 1, 2);
  assert.match(shown.replaceAll("\\", ""), /control period, 0\.0001 to 10 \[s\]; default: 0\.1/);
});
