// The engine in a browser: it plays, it computes the same bits, its board falls silent with its page, and it is fast.

import assert from "node:assert/strict";
import fs from "node:fs";
import { after, test } from "node:test";
import { cleanUp, openEngine, openPage, required } from "./harness.mjs";

/** Host timeout of the bundled scenes, ms. */
const HOST_TIMEOUT_MS = 250;
/** Samples of a frame, and the steps of the worker that are under way: by so much a time read in the page may be off, ms. */
const PAGE_ERROR_MS = 30;
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
      async ([name, seed, durationMs]) => engine.seeded(await sceneFiles(name), name, seed, durationMs, {}),
      [name, SEED, DURATION_MS],
    );
    assert.equal(found, expected, name);
  }
  await close();
});

test("in a worker it runs at least 20 times as fast as real time", async (context) => {
  const { page, close } = await openEngine();
  const speed = await page.evaluate(async () => engine.speed(await sceneFiles("grating.toml"), "grating.toml"));
  context.diagnostic(`${speed.toFixed(0)} times real time`);
  assert.ok(speed >= 20, `${speed} times real time`);
  await close();
});

test("the page has at most 2 MB", (context) => {
  const { size } = fs.statSync(required("STUDIO_PAGE"));
  context.diagnostic(`${size} bytes`);
  assert.ok(size <= 2_000_000, `${size} bytes`);
});

/** Plays under a moving finger, and does `silence` in the page. Returns ms of board time until the output is zero. */
async function msToZeroAfter(page, silence) {
  await page.evaluate(async (name) => {
    await engine.play(await sceneFiles(name), name, {});
    globalThis.isSliding = true;
    slideUntil(() => !isSliding);
  }, "constant.toml");
  return page.evaluate(async (silence) => {
    const drives = (frame) => frame.voltageV.some((voltage) => voltage > 1);
    // On a busy machine the samples of the pointer come late, and a finger that stands still feels no drive.
    while (!felt.length || !drives(felt.at(-1))) await new Promise((resolve) => setTimeout(resolve, 5));
    const silentAtTick = felt.at(-1).tick;
    await eval(silence)();
    while (felt.at(-1).tick < silentAtTick + 600 * 40) await new Promise((resolve) => setTimeout(resolve, 20));
    const after = felt.filter((frame) => frame.tick > silentAtTick);
    const zero = after.findIndex((frame) => !drives(frame));
    if (zero < 0) throw new Error("the output is never zero");
    const last = after[zero];
    const samples = [...after.slice(0, zero + 1)].flatMap((frame) => {
      return [...frame.voltageV].map((voltage, index) => [frame.firstTick + 40 * (index + 1), voltage]);
    });
    const zeroAtTick = Math.max(...samples.filter(([, voltage]) => voltage > 1).map(([tick]) => tick));
    return { ms: (zeroAtTick - silentAtTick) / 40, isBack: after.slice(zero).some(drives), isTouched: last.contact };
  }, silence);
}

function assertTimeout({ ms, isTouched }) {
  assert.ok(isTouched, "the finger is still down: the host's silence is what ends the output");
  assert.ok(ms > HOST_TIMEOUT_MS / 2, `zero after ${ms} ms, before the host timeout`);
  assert.ok(ms <= HOST_TIMEOUT_MS + PAGE_ERROR_MS, `zero only after ${ms} ms`);
}

test("a hidden page: the output is zero within the host timeout, and plays on when the page is back", async () => {
  const { page, close } = await openEngine();
  const found = await msToZeroAfter(
    page,
    `async () => {
      Object.defineProperty(document, "visibilityState", { value: "hidden", configurable: true });
      document.dispatchEvent(new Event("visibilitychange"));
    }`,
  );
  assertTimeout(found);
  assert.ok(!found.isBack, "it stays at zero");
  await page.evaluate(() => {
    felt.length = 0;
    Object.defineProperty(document, "visibilityState", { value: "visible", configurable: true });
  });
  await page.waitForFunction(() => felt.some((frame) => frame.voltageV.some((voltage) => voltage > 1)));
  await close();
});

test("a page that hangs: the output is zero within the host timeout", async () => {
  const { page, close } = await openEngine();
  const found = await msToZeroAfter(
    page,
    `async () => {
      const begin = performance.now();
      while (performance.now() - begin < 700);
    }`,
  );
  assertTimeout(found);
  await close();
});
