// The page in a browser: its first seconds say nothing that is wrong, and a file takes no more memory than is stated.

import assert from "node:assert/strict";
import { test } from "node:test";
import { openPage, pageUrl } from "./harness.mjs";
import { give, openStudio, plays, writeScene } from "./page.mjs";
import { pageModule } from "./page_module.mjs";

const BARE_GLASS = "version = 1\n";

/** Collects, in the page, what the numbers say at each frame until `stop()`; returns the texts of friction and Weber steps. */
function watchNumbers() {
  const texts = [];
  // A hidden unit is not said.
  const visibleText = (each) =>
    [...each.children].filter(({ hidden }) => !hidden).map(({ textContent }) => textContent).join(" ").trim();
  const leave = eachFrame(() => {
    const shown = [...document.querySelectorAll("#numbers dd.felt")].map((each) => visibleText(each));
    texts.push(...shown);
  });
  globalThis.stopWatching = () => {
    leave();
    return [...new Set(texts)];
  };
}

/** A number of at most three digits with its unit, no number, or what to do to get one. */
const SENSIBLE = /^(\d{1,3} mN|\d{1,2}\.\d steps|– (mN|steps)|slide to feel)$/;

test("press and hold, bare glass and standstill say no negative number, but slide to feel", async () => {
  const page = await openStudio();
  const textsOf = async (toMm, restMs) => {
    await page.evaluate(watchNumbers);
    return page.evaluate(
      async ([toMm, restMs]) => {
        await slide(15, toMm, 30, 80);
        await wait(restMs);
        const texts = stopWatching();
        lift(toMm, 30);
        await wait(300);
        return texts;
      },
      [toMm, restMs],
    );
  };
  const held = await textsOf(15, 1500);
  assert.ok(held.includes("slide to feel"), held.join(", "));
  assert.deepEqual(held.filter((text) => !SENSIBLE.test(text)), []);

  await writeScene(page, BARE_GLASS);
  const slid = await textsOf(105, 1000);
  assert.ok(slid.includes("slide to feel"), "the finger rests at the end");
  assert.ok(slid.some((text) => /^\d+ mN$/.test(text)), "friction is felt on the way");
  assert.deepEqual(slid.filter((text) => !SENSIBLE.test(text)), []);
});

test("the map of a long screen has as many pixels along its longer side as any", async () => {
  const { mapSizePx } = await pageModule("map.js");
  assert.deepEqual(mapSizePx({ widthMm: 120, heightMm: 80 }, 960), { widthPx: 960, heightPx: 640 });
  assert.deepEqual(mapSizePx({ widthMm: 5, heightMm: 2000 }, 960), { widthPx: 8, heightPx: 960 });
  assert.deepEqual(mapSizePx({ widthMm: 2000, heightMm: 5 }, 960), { widthPx: 960, heightPx: 8 });
});

test("the columns stand before the engine is ready, and where they are then, also at the next visit", async () => {
  const init = () => {
    globalThis.widths = [];
    const look = () => {
      const card = document.querySelector(".map-card");
      const hasRoom = document.querySelector(".feel-grid")?.style.getPropertyValue("--map-width");
      // The scripts have begun once the map has its room.
      if (card && hasRoom) {
        const said = document.getElementById("map-hint").textContent;
        widths.push({ width: Math.round(card.getBoundingClientRect().width), isStarting: said === "starting…" });
      }
      requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
    // The engine is ready after a picture of the page without it, however fast the machine is.
    const compile = WebAssembly.compile;
    WebAssembly.compile = async (bytes) => {
      while (!widths.some(({ isStarting }) => isStarting)) await new Promise(requestAnimationFrame);
      return compile(bytes);
    };
  };
  const page = await openPage(pageUrl, { init });
  const seen = async () => {
    await plays(page);
    await page.waitForFunction(() => widths.some(({ isStarting }) => !isStarting));
    const all = await page.evaluate(() => widths);
    assert.ok(all.some(({ isStarting }) => isStarting), "the columns were there before");
    return [...new Set(all.map(({ width }) => width))];
  };
  assert.equal((await seen()).length, 1);
  await page.waitForFunction(() => globalThis.studioPage);
  await give(page, ["wide.toml", "version = 1\n[screen]\nwidth_mm = 150\nheight_mm = 60\n"]);
  await page.waitForFunction(() => studioPage.map.screen.widthMm === 150);
  await page.reload();
  const again = await seen();
  assert.equal(again.length, 1, `${again}`);
  assert.equal(await page.evaluate(() => studioPage.map.screen.widthMm), 150);
});
