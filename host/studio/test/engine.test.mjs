// The engine in a browser: it plays, it computes the same bits, its board falls silent with its page, and it is fast.

import assert from "node:assert/strict";
import fs from "node:fs";
import { after, test } from "node:test";
import { cleanUp, openEngine, openPage, required } from "./harness.mjs";

/** Host timeout of the bundled scenes, ms. */
const HOST_TIMEOUT_MS = 250;
/** Samples of a frame, and the steps of the worker that are under way: by so much a time read in the page may be off, ms. */
const PAGE_ERROR_MS = 30;
/** A worker keeps its board alive for so long after the page's last animation frame (board.js), ms. */
const LIFE_MS = 25;
/** As in examples/seeded_hashes.rs. */
const [SEED, DURATION_MS] = [7, 500];

after(cleanUp);

test("from a file it plays within 10 s, without an error", async () => {
  const { page, errors, close } = await openPage();
  await page.waitForFunction(() => document.documentElement.dataset.state === "active", null, { timeout: 10_000 });
  assert.deepEqual(errors, []);
  await close();
});

test("a seeded stroke over every gallery scene has the bits that it has natively", async () => {
  const native = JSON.parse(fs.readFileSync(required("STUDIO_HASHES"), "utf8"));
  assert.ok(Object.keys(native).length >= 12);
  const { page, close } = await openEngine();
  for (const [name, expected] of Object.entries(native)) {
    const found = await page.evaluate(
      async ([name, seed, durationMs]) => tested.seeded(await sceneFiles(name), name, seed, durationMs, {}),
      [name, SEED, DURATION_MS],
    );
    assert.equal(found, expected, name);
  }
  await close();
});

test("in a worker it runs at least 20 times as fast as real time", async (context) => {
  const { page, close } = await openEngine();
  const speed = await page.evaluate(async () => tested.speed(await sceneFiles("grating.toml"), "grating.toml"));
  context.diagnostic(`${speed.toFixed(0)} times real time`);
  assert.ok(speed >= 20, `${speed} times real time`);
  await close();
});

test("the page has at most 2 MB", (context) => {
  const { size } = fs.statSync(required("STUDIO_PAGE"));
  context.diagnostic(`${size} bytes`);
  assert.ok(size <= 2_000_000, `${size} bytes`);
});

/** Plays under a moving finger, and does `silence` in the page. Returns ms of board time until the board ends the output. */
async function msToZeroAfter(page, silence) {
  await page.evaluate(async (name) => {
    await tested.play(await sceneFiles(name), name, {});
    globalThis.isSliding = true;
    slideUntil(() => !isSliding);
  }, "constant.toml");
  await page.evaluate(() => {
    globalThis.silences = {
      hidden() {
        Object.defineProperty(document, "visibilityState", { value: "hidden", configurable: true });
        document.dispatchEvent(new Event("visibilitychange"));
      },
      hung() {
        const begin = performance.now();
        while (performance.now() - begin < 700);
      },
    };
  });
  return page.evaluate(async (silence) => {
    const drives = (frame) => frame.voltageV.some((voltage) => voltage > 1);
    // On a busy machine the samples of the pointer come late, and a finger that stands still feels no drive.
    while (!felt.length || !drives(felt.at(-1))) await new Promise((resolve) => setTimeout(resolve, 5));
    const silentAtTick = felt.at(-1).tick;
    await silences[silence]();
    while (felt.at(-1).tick < silentAtTick + 600 * 40) await new Promise((resolve) => setTimeout(resolve, 20));
    const after = felt.filter((frame) => frame.tick > silentAtTick);
    // A finger that stands still ends the output, too: only the board's state says that it has noticed the silence.
    const silent = after.findIndex((frame) => frame.state !== "active");
    if (silent < 0) throw new Error("the board has not noticed the silence");
    return { ms: (after[silent].tick - silentAtTick) / 40, isDriven: after.some((frame) => frame.state !== "active" && frame !== after[silent] && drives(frame)) };
  }, silence);
}

function assertTimeout({ ms, isDriven }) {
  assert.ok(ms > HOST_TIMEOUT_MS / 2, `silent after ${ms} ms, before the host timeout`);
  assert.ok(ms <= HOST_TIMEOUT_MS + LIFE_MS + PAGE_ERROR_MS, `silent only after ${ms} ms`);
  assert.ok(!isDriven, "the output stays at zero");
}

test("a hidden page: the output is zero within the host timeout, and plays on when the page is back", async () => {
  const { page, close } = await openEngine();
  const found = await msToZeroAfter(page, "hidden");
  assertTimeout(found);
  await page.evaluate(() => {
    felt.length = 0;
    Object.defineProperty(document, "visibilityState", { value: "visible", configurable: true });
  });
  await page.waitForFunction(() => felt.some((frame) => frame.voltageV.some((voltage) => voltage > 1)));
  await close();
});

test("a page that hangs: the output is zero within the host timeout", async () => {
  const { page, close } = await openEngine();
  const found = await msToZeroAfter(page, "hung");
  assertTimeout(found);
  await close();
});
