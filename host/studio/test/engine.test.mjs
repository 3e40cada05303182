// The engine in a browser: it computes the same bits, and its board falls silent with its page.

import assert from "node:assert/strict";
import fs from "node:fs";
import { test } from "node:test";
import { openOnlyEngine, required } from "./harness.mjs";

/** Host timeout of the bundled scenes, ms. */
const HOST_TIMEOUT_MS = 250;
/** A worker keeps its board alive for so long after the page's last animation frame (wasm.js), ms. */
const LIFE_MS = 25;
/** The steps of the test's clock, and those of a frame, by which the silence is known, ms. */
const STEPS_MS = 24;
/** As in examples/seeded_hashes.rs. */
const [SEED, DURATION_MS] = [7, 500];

test("a seeded stroke over every gallery scene has the bits that it has natively", async () => {
  const native = JSON.parse(fs.readFileSync(required("STUDIO_HASHES"), "utf8"));
  assert.ok(Object.keys(native).length >= 12);
  const page = await openOnlyEngine();
  const seeded = async ([name, seed, durationMs]) => {
    const { instance, requestOf } = await instanceOfModule();
    const request = requestOf({ files: await sceneFiles(name), entry: name, seed, durationMs });
    return instance.call("seeded_hash", request).hash;
  };
  for (const [name, expected] of Object.entries(native))
    assert.equal(await page.evaluate(seeded, [name, SEED, DURATION_MS]), expected, name);
});

/** Runs in the page: ms of board time until the board notices `silence`, and whether it drives then. */
async function silenced(silence) {
  const silences = {
    hidden() {
      setVisibility("hidden");
      return wait(700);
    },
    hung: () => hang(700),
  };
  const count = felt.length;
  const silentAtTick = felt.at(-1).tick;
  await silences[silence]();
  const after = felt.slice(count);
  // A finger that stands still ends the output, too: only the board's state says that it has noticed the silence.
  const silent = after.findIndex((frame) => frame.state !== "active");
  if (silent < 0) throw new Error("the board has not noticed the silence");
  // The output falls within a millisecond, which may begin in one frame and end in the next.
  const later = after.slice(silent + 2).filter((frame) => frame.state !== "active");
  return {
    ms: (after[silent].tick - silentAtTick) / 40,
    isDriven: later.some((frame) => frame.voltageV.some((voltage) => voltage > 1)),
  };
}

test("of a page that is hidden or hangs the output is zero within the host timeout, until the page is back", async () => {
  const page = await openOnlyEngine(undefined, { isSimulated: true });
  await page.evaluate(async (name) => {
    await tested.play(await sceneFiles(name), name, {});
    keepSliding();
  }, "constant.toml");
  const isDriven = () => felt.at(-1)?.state === "active" && felt.at(-1).voltageV.some((volts) => volts > 1);
  for (const silence of ["hidden", "hung"]) {
    await page.waitForFunction(isDriven);
    const { ms, isDriven: isDrivenLater } = await page.evaluate(silenced, silence);
    assert.ok(ms > HOST_TIMEOUT_MS / 2, `${silence}: silent after ${ms} ms, before the host timeout`);
    assert.ok(ms <= HOST_TIMEOUT_MS + LIFE_MS + STEPS_MS, `${silence}: silent only after ${ms} ms`);
    assert.ok(!isDrivenLater, `${silence}: the output stays at zero`);
    await page.evaluate(() => setVisibility("visible"));
  }
  await page.waitForFunction(isDriven);
});
