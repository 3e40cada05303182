// The engine in a browser: it plays, it computes the same bits, its board falls silent with its page, and it is fast.

import assert from "node:assert/strict";
import fs from "node:fs";
import { after, afterEach, test } from "node:test";
import { cleanUp, endLeftovers, openOnlyEngine, openPage, required } from "./harness.mjs";

/** Host timeout of the bundled scenes, ms. */
const HOST_TIMEOUT_MS = 250;
/** Samples of a frame, and steps of the worker under way: by so much a time read in the page may be off, ms. */
const PAGE_ERROR_MS = 30;
/** A worker keeps its board alive for so long after the page's last animation frame (wasm.js), ms. */
const LIFE_MS = 25;
/** A frame is late when it comes so much later after its tick than others, ms. */
const LATE_MS = 5;
/** A board that is not held up sends a frame for each 8 ms; the step under way may be of two. */
const FRAME_MAX_MS = 16;
/** A silence is caused so often. */
const TRIES_MAX = 8;
/** For the speed: so many stretches, of which a few are so short that nothing else runs meanwhile, ms. */
const SPEED = { stretches: 100, stretchMs: 48 };
/** As in examples/seeded_hashes.rs. */
const [SEED, DURATION_MS] = [7, 500];

afterEach(endLeftovers);
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
  const { page, close } = await openOnlyEngine();
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
  const { page, close } = await openOnlyEngine();
  const speed = await page.evaluate(
    async (options) => tested.speed(await sceneFiles("grating.toml"), "grating.toml", options),
    SPEED,
  );
  context.diagnostic(`${speed.toFixed(0)} times real time`);
  assert.ok(speed >= 20, `${speed} times real time`);
  await close();
});

test("the page has at most 2 MB", (context) => {
  const { size } = fs.statSync(required("STUDIO_PAGE"));
  context.diagnostic(`${size} bytes`);
  assert.ok(size <= 2_000_000, `${size} bytes`);
});

/**
 * Plays under a moving finger, and causes `silence` in the page. Returns ms of board time until the board has noticed
 * it, and whether it drives then. Where the board's worker is held up at either moment, the time between is not known:
 * then it is tried again.
 */
async function msToZeroAfter(page, silence) {
  await page.evaluate(async (name) => {
    await tested.play(await sceneFiles(name), name, {});
    keepSliding();
  }, "constant.toml");
  for (let tries = 0; tries < TRIES_MAX; tries += 1) {
    const found = await page.evaluate(silenced, [silence, { LATE_MS, FRAME_MAX_MS }]);
    if (!found.isHeldUp) return found;
  }
  throw new Error(`the machine is too busy: the board was held up in each of ${TRIES_MAX} tries`);
}

/** Runs in the page. */
async function silenced([silence, { LATE_MS, FRAME_MAX_MS }]) {
  const silences = {
    hidden: () => setVisibility("hidden"),
    hung() {
      const begin = performance.now();
      while (performance.now() - begin < 700);
    },
  };
  setVisibility("visible");
  const drives = (frame) => frame.voltageV.some((voltage) => voltage > 1);
  const take = tested.onFrames;
  const lagsMs = [];
  const silentAtTick = await new Promise((resolve) => {
    tested.onFrames = (frame) => {
      take(frame);
      // On a busy page, frames wait until it takes them: the tick of a late one is not that of this moment.
      const lagMs = performance.now() - frame.tick / 40;
      lagsMs.push(lagMs);
      const isLate = lagsMs.length < 100 || lagMs > Math.min(...lagsMs.slice(-100)) + LATE_MS;
      // Where the samples of the pointer come late, the finger stands still and feels no drive.
      if (isLate || frame.state !== "active" || !drives(frame)) return;
      tested.onFrames = take;
      resolve(frame.tick);
      silences[silence]();
    };
  });
  const endMs = performance.now() + 5000;
  while (felt.at(-1).tick < silentAtTick + 600 * 40) {
    // A board that was held up for long rests.
    if (performance.now() > endMs) return { isHeldUp: true };
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
  const after = felt.filter((frame) => frame.tick > silentAtTick);
  // A finger that stands still ends the output, too: only the board's state says that it has noticed the silence.
  const silent = after.findIndex((frame) => frame.state !== "active");
  if (silent < 0) throw new Error("the board has not noticed the silence");
  const later = after.slice(silent + 1).filter((frame) => frame.state !== "active");
  return {
    ms: (after[silent].tick - silentAtTick) / 40,
    isDriven: later.some(drives),
    isHeldUp: [after[0], after[silent]].some((frame) => (frame.tick - frame.firstTick) / 40 > FRAME_MAX_MS),
  };
}

function assertTimeout({ ms, isDriven }) {
  assert.ok(ms > HOST_TIMEOUT_MS / 2, `silent after ${ms} ms, before the host timeout`);
  assert.ok(ms <= HOST_TIMEOUT_MS + LIFE_MS + PAGE_ERROR_MS, `silent only after ${ms} ms`);
  assert.ok(!isDriven, "the output stays at zero");
}

test("a hidden page: the output is zero within the host timeout, and plays on when the page is back", async () => {
  const { page, close } = await openOnlyEngine();
  const found = await msToZeroAfter(page, "hidden");
  assertTimeout(found);
  await page.evaluate(() => {
    felt.length = 0;
    setVisibility("visible");
  });
  await page.waitForFunction(() => felt.some((frame) => frame.voltageV.some((voltage) => voltage > 1)));
  await close();
});

test("a page that hangs: the output is zero within the host timeout", async () => {
  const { page, close } = await openOnlyEngine();
  const found = await msToZeroAfter(page, "hung");
  assertTimeout(found);
  await close();
});
