// The page in a browser: in windows of all sizes, and whatever is open, nothing is cut and nothing lies over another.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  LOW_WINDOWS, PLOT_MIN_PX, ROUNDING_PX, SCHEMES, WINDOWS, boxOf, boxes, cut, isWithin, openBundled, overlap, scrolls,
} from "./layout.mjs";
import { openStudio, resize } from "./page.mjs";

/** The panel of Edit follows what is scrolled, lies beside the map, and is reached down to its last button. */
async function assertPanelScrolls(page, where, [, height]) {
  await page.evaluate(() => document.querySelector("main").scrollTo(0, 0));
  await page.click("text='Edit'");
  await page.locator(".layer-box").first().focus();
  const places = async () => {
    const { "#map-finger": map, ".layer-panel": panel } = await boxes(page, ["#map-finger", ".layer-panel"]);
    assert.ok(!overlap(map, panel), `${where}: the panel over the map, ${JSON.stringify([map, panel])}`);
    return panel.top - map.top;
  };
  const before = await places();
  await page.evaluate(() => document.querySelector("main").scrollTo(0, 10_000));
  assert.ok(Math.abs((await places()) - before) <= ROUNDING_PX, `${where}: the panel stays behind`);
  await page.locator(".layer-add button").last().focus();
  const bottom = await page.evaluate(() => document.activeElement.getBoundingClientRect().bottom);
  assert.ok(bottom <= height, `${where}: the panel's last button is at ${bottom}`);
  await page.click("text='Feel'");
}

test("in a low window the page scrolls below its header, and nothing lies over another", async () => {
  const page = await openStudio(undefined, { isFirstVisit: true });
  const parts = ["#map-finger", "#numbers", "#scope .u-wrap", "#scope .u-legend", "#editor", ".side"];
  for (const scene of Object.keys(SCHEMES)) {
    if (scene !== "brick") await openBundled(page, scene);
    for (const isOpen of [false, true]) {
      if (isOpen !== (await page.locator("#drawer").isVisible())) await page.click("#toggle-drawer");
      for (const [width, height] of [...LOW_WINDOWS, [390, 844]]) {
        const where = `${scene}, ${width}x${height}${isOpen ? " with the text" : ""}`;
        await resize(page, [width, height]);
        await page.evaluate(() => document.querySelector("main").scrollTo(0, 0));
        const stop = await page.evaluate(boxOf, "#stop");
        const found = Object.entries(await boxes(page, parts)).filter(([, box]) => box.width > 0);
        for (const [at, [name, box]] of found.entries()) {
          assert.ok(box.left >= 0 && box.right <= width + ROUNDING_PX, `${where}: ${name} ${JSON.stringify(box)}`);
          for (const [other, its] of found.slice(at + 1)) assert.ok(!overlap(box, its), `${where}: ${name} and ${other}`);
        }
        const { "#map-finger": map, "#scope .u-wrap": chart, ".side": side } = Object.fromEntries(found);
        assert.ok(map.width >= 200 && map.bottom <= height, `${where}: the map ${JSON.stringify(map)}`);
        if (chart) {
          const { height: plot } = await page.evaluate(boxOf, "#scope .u-over");
          assert.ok(plot >= PLOT_MIN_PX, `${where}: the curves have ${plot} px`);
        }
        if (isOpen) assert.ok(side.height >= 280, `${where}: the tools have ${side.height} px`);
        assert.deepEqual(await page.evaluate(cut), [], `${where}: cut`);
        assert.deepEqual(await page.evaluate(scrolls, false), [], where);
        await page.evaluate(() => document.querySelector("main").scrollTo(0, 10_000));
        const last = await page.evaluate(boxOf, isOpen ? ".side" : "#scope");
        assert.ok(last.bottom <= height + ROUNDING_PX, `${where}: the end is reached, ${JSON.stringify(last)}`);
        assert.deepEqual(await page.evaluate(boxOf, "#stop"), stop, `${where}: Stop keeps its place`);
        await assertPanelScrolls(page, where, [width, height]);
        assert.deepEqual(await page.evaluate(boxOf, "#stop"), stop, `${where}: Stop keeps its place beside the panel`);
      }
    }
  }
});

/** What can be opened: how, what has to be within the window then, and how it is closed. */
const OPENED = {
  options: [(page) => page.click("#options summary"), "#options > div", (page) => page.keyboard.press("Escape")],
  "the scope's menu": [
    (page) => page.click("#scope-options summary"), "#scope-options > div", (page) => page.keyboard.press("Escape"),
  ],
  "the menu": [
    async (page) => (await page.locator("#toggle-menu").isVisible()) && page.click("#toggle-menu"), "#menu",
    (page) => page.evaluate(() => document.body.click()),
  ],
  "a notice": [
    // Bad news, which stays until it is measured.
    (page) => page.evaluate(async () => {
      const { notify } = await import(await studio.moduleUrl("page/notices.js"));
      notify("A long sentence about what went wrong. ".repeat(6), undefined, { beside: document.getElementById("share") });
    }), "#notice",
    (page) => page.evaluate(() => document.querySelector("#notice [aria-label=Dismiss]").click()),
  ],
  gallery: [
    async (page) => {
      await page.click("#open-gallery");
      await page.locator("#gallery article button").first().waitFor();
    }, "#gallery", (page) => page.keyboard.press("Escape"),
  ],
  lag: [(page) => page.click("#open-lag"), "#lag", (page) => page.click("#open-lag")],
  "Edit's panel": [
    async (page) => {
      await page.click("text='Edit'");
      await page.locator(".layer-box").first().focus();
      await page.locator(".layer-add button").last().focus();
    }, ".layer-panel",
    async (page) => {
      await page.click("text='Feel'");
      await page.evaluate(() => document.querySelector("main").scrollTo(0, 0));
    },
  ],
  "text and tools": [(page) => page.click("#toggle-drawer"), "#editor", (page) => page.click("#toggle-drawer")],
};

test("whatever is open, nothing is wider than the window", async () => {
  const page = await openStudio(undefined, { isFirstVisit: true });
  for (const scene of Object.keys(SCHEMES)) {
    if (scene !== "brick") await openBundled(page, scene);
    for (const [width, height] of [...WINDOWS, ...LOW_WINDOWS]) {
      await resize(page, [width, height]);
      const window = { left: 0, top: 0, right: width, bottom: height };
      for (const [name, [open, what, shut]] of Object.entries(OPENED)) {
        const where = `${scene}, ${width}x${height}, ${name}`;
        await open(page);
        await page.locator(what).waitFor();
        await resize(page, [width, height]);
        const { top } = await page.evaluate(boxOf, "header");
        assert.equal(top, 0, `${where}: the header leaves the window`);
        const box = await page.evaluate(boxOf, what);
        assert.ok(isWithin(box, window), `${where}: ${JSON.stringify(box)}`);
        assert.deepEqual(await page.evaluate(scrolls, false), [], where);
        if (name === "lag") {
          const { height: plot } = await page.evaluate(boxOf, "#scope .u-over");
          assert.ok(plot >= PLOT_MIN_PX, `${where}: the curves have ${plot} px`);
        }
        await shut(page);
      }
    }
  }
});
