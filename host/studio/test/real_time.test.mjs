// The page in a browser, on the machine's clock: it starts soon, plays a change soon, and simulates fast.

import assert from "node:assert/strict";
import { test } from "node:test";
import { openOnlyEngine, openPage } from "./harness.mjs";
import { WHOLE_SCREEN_GRATING, openStudio, writeScene } from "./page.mjs";

/** For the speed: so many stretches, of which a few are so short that nothing else runs meanwhile, ms. */
const SPEED = { stretches: 100, stretchMs: 48 };
/** So many square roots, each of the result of the last one, take milliseconds: the clock shows tenths of one. */
const ROOTS = { stretches: 20, roots: 1_000_000 };
const ROOTS_PER_TICK_MAX = 260;
const TICKS_PER_S = 40_000;
/** A mended scene plays on after a pause of so many ms, in which a person may type on, and its load. */
const PAUSE_MS = 60;
/** The least times of so many mends and loads are compared, and how much longer a mend may take than a load. */
const TIMES = 5;
const LOADS_MAX = 5;

test("from a file it plays within 10 s, without an error", async () => {
  const page = await openPage();
  await page.waitForFunction(() => document.documentElement.dataset.state === "active", null, { timeout: 10_000 });
});

/** Runs in the page. The time of a square root, the least of some stretches, s. */
function rootTime({ stretches, roots }) {
  let x = 2;
  const times = Array.from({ length: stretches }, () => {
    const beginMs = performance.now();
    for (let at = 0; at < roots; at += 1) x = Math.sqrt(x + at);
    return performance.now() - beginMs;
  });
  // A result that nobody read would not be computed.
  return x < 0 ? 0 : Math.min(...times) / roots / 1000;
}

/**
 * Runs in the page: the simulator as fast as it goes. Returns how many times faster than real time that is: the fastest
 * of some stretches, because other programs on the machine only slow it.
 */
async function timesRealTime({ stretches, stretchMs }) {
  const { instance, requestOf } = await instanceOfModule();
  instance.call("simulator_start", null, 1);
  instance.call("simulator_play", requestOf({ files: await sceneFiles("grating.toml"), entry: "grating.toml" }));
  const times = Array.from({ length: stretches }, () => {
    const begin = performance.now();
    for (let ms = 0; ms < stretchMs; ms += 8) {
      const tick = instance.plain("simulator_tick");
      instance.plain("simulator_pointer", tick + 320, 65 + (30 * ms) / stretchMs, 30, 1, 0);
      instance.callForBytes("simulator_run", null, 320, 1);
    }
    return performance.now() - begin;
  });
  return stretchMs / Math.min(...times);
}

test("a tick takes as long as 260 square roots at most", async (context) => {
  const page = await openOnlyEngine();
  const speed = await page.evaluate(timesRealTime, SPEED);
  const rootS = await page.evaluate(rootTime, ROOTS);
  const roots = 1 / (speed * TICKS_PER_S * rootS);
  context.diagnostic(`${speed.toFixed(0)} times real time; ${roots.toFixed(0)} square roots a tick`);
  assert.ok(roots <= ROOTS_PER_TICK_MAX, `${roots} square roots a tick`);
});

/** Deletes the letter before the cursor, which is the scene's mistake. Returns ms until the scene plays. */
async function msToMend(page) {
  await page.evaluate(() => {
    globalThis.mended = new Promise((resolve) => {
      const { player, editor } = studioPage;
      const before = player.onPlay;
      let changedMs;
      document.addEventListener("keydown", () => (changedMs = performance.now()), { capture: true, once: true });
      player.onPlay = (text) => {
        before(text);
        if (text !== editor.text) return;
        player.onPlay = before;
        resolve(performance.now() - changedMs);
      };
    });
  });
  await page.keyboard.press("Backspace");
  return page.evaluate(() => mended);
}

/** Ms that a compile of the scene and its load take. */
const msToLoad = (page) =>
  page.evaluate(async (text) => {
    const beginMs = performance.now();
    const scene = [{ "scene.toml": text }, "scene.toml", {}];
    await studioPage.engine.compile(...scene);
    await studioPage.engine.play(...scene);
    return performance.now() - beginMs;
  }, WHOLE_SCREEN_GRATING);

test("a mended scene plays on soon: at its load, whatever is still judged of it", async (context) => {
  const page = await openStudio(undefined, { isSimulated: false });
  await writeScene(page, WHOLE_SCREEN_GRATING);
  await page.evaluate(() => studioPage.editor.goTo(undefined, 4));
  await page.keyboard.press("End");
  await page.keyboard.press("ArrowLeft");
  const [mendsMs, loadsMs] = [[], []];
  for (let time = 0; time < TIMES; time += 1) {
    await page.keyboard.type("x");
    await page.locator("#problems li.error").waitFor();
    loadsMs.push(await msToLoad(page));
    mendsMs.push(await msToMend(page));
  }
  const [mendMs, loadMs] = [Math.min(...mendsMs), Math.min(...loadsMs)];
  context.diagnostic(`plays on ${mendMs.toFixed(0)} ms after the key, a load takes ${loadMs.toFixed(0)}`);
  assert.ok(mendMs <= PAUSE_MS + LOADS_MAX * loadMs, `${mendMs} ms of ${loadMs} for a load`);
});
