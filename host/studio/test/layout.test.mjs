// The page in windows of eight sizes: what is felt is seen without scrolling, and the map has most of the room.

import assert from "node:assert/strict";
import { after, afterEach, test } from "node:test";
import { cleanUp, endLeftovers } from "./harness.mjs";
import { openStudio } from "./page.mjs";

afterEach(endLeftovers);
after(cleanUp);

/** Width and height of windows, CSS pixels. */
const WINDOWS = [[1366, 657], [1440, 789], [1536, 730], [1920, 969], [2560, 1300], [1024, 768], [820, 1180], [390, 844]];
/** Windows that are too low for all: of a phone whose browser has its bars, and of a laptop at 200 %. */
const LOW_WINDOWS = [[390, 664], [960, 485]];
/**
 * Least part of a window that the screen's picture has, without ruler and scale: on a phone, and otherwise. A screen
 * whose shape leaves it no such part of the window's width has all of that width.
 */
const PART = { phone: 0.4, other: 0.25 };
const PHONE_MAX_PX = 480;
/** What is beside a screen that is as wide as the window, CSS pixels. */
const AROUND_NARROW_PX = 6;
/** Least height of the curves, CSS pixels. */
const PLOT_MIN_PX = 55;
/** Edges of boxes may lie within a pixel beyond those of the window. */
const ROUNDING_PX = 1;

/** In the page: the box of the first element of a selector. */
function boxOf(selector) {
  const { left, top, right, bottom, width, height } = document.querySelector(selector).getBoundingClientRect();
  return { left, top, right, bottom, width, height };
}

/** Boxes on the page, by their selectors. */
async function boxes(page, selectors) {
  const found = {};
  for (const selector of selectors) found[selector] = await page.evaluate(boxOf, selector);
  return found;
}

const isWithin = (inner, outer) =>
  inner.left >= outer.left - ROUNDING_PX && inner.top >= outer.top - ROUNDING_PX &&
  inner.right <= outer.right + ROUNDING_PX && inner.bottom <= outer.bottom + ROUNDING_PX;

const overlap = (one, other) =>
  Math.min(one.right, other.right) - Math.max(one.left, other.left) > ROUNDING_PX &&
  Math.min(one.bottom, other.bottom) - Math.max(one.top, other.top) > ROUNDING_PX;

/** The page has taken this window. */
async function resize(page, [width, height]) {
  await page.setViewportSize({ width, height });
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

const SEEN = ["header", "#stop", "#map-finger", "#numbers", "#scope .u-wrap", "#scope .u-legend"];

const SCHEMES = { brick: "light", velvet: "dark" };

/** What is cut: words that are longer than their box, and tools that lie over each other or beyond their row. */
function cut() {
  const cells = document.querySelectorAll("#numbers dd, #numbers dt, .u-legend tr, header button, .map-card h2");
  const seen = [...cells].filter((each) => each.checkVisibility());
  const long = seen.filter((each) => each.scrollWidth > each.clientWidth + 1).map((each) => each.outerHTML);
  for (const row of document.querySelectorAll("header, .map-tools, .scope-card > .tools")) {
    const boxes = [...row.children].filter((each) => each.checkVisibility()).map((each) => [each, each.getBoundingClientRect()]);
    const inner = boxes.filter(([, { width }]) => width > 0);
    for (const [at, [tool, { left, right }]] of inner.entries()) {
      const end = at + 1 < inner.length ? inner[at + 1][1].left : row.getBoundingClientRect().right;
      if (right > end + 1 || left < row.getBoundingClientRect().left - 1) long.push(`not in its place: ${tool.outerHTML}`);
    }
  }
  return long;
}

/** Whether anything is wider than the window, or, with `isHigh`, higher. */
function scrolls(isHigh) {
  const over = [document.scrollingElement, document.querySelector("main")];
  const isOver = ({ scrollWidth, clientWidth, scrollHeight, clientHeight }) =>
    scrollWidth > clientWidth || (isHigh && scrollHeight > clientHeight);
  return over.filter(isOver).map(({ tagName, scrollWidth, scrollHeight }) => [tagName, scrollWidth, scrollHeight]);
}

/** Opens a scene of the gallery, and waits until its map is there. */
async function openBundled(page, name) {
  await page.click("#open-gallery");
  await page.click(`text="Open ${name}"`);
  await page.waitForFunction((name) => document.getElementById("scene-name").value === name, name);
  await page.waitForFunction(() => document.getElementById("check").textContent === "plays");
  await page.waitForFunction(() => !document.getElementById("map").dataset.stale);
  await page.evaluate(() => document.querySelector("#notice [aria-label=Dismiss]").click());
}

for (const [scene, colorScheme] of Object.entries(SCHEMES)) {
  test(`map, numbers, scope and legend are seen at eight sizes, ${scene}, ${colorScheme}`, async () => {
    const { page, errors, close } = await openStudio(undefined, { isFirstVisit: true });
    await page.emulateMedia({ colorScheme });
    if (scene !== "brick") await openBundled(page, scene);
    for (const [width, height] of WINDOWS) {
      await resize(page, [width, height]);
      const size = `${width}x${height}`;
      const window = { left: 0, top: 0, right: width, bottom: height };
      const found = await boxes(page, SEEN);
      for (const [name, box] of Object.entries(found)) {
        assert.ok(isWithin(box, window), `${size}: ${name} ${JSON.stringify(box)}`);
        assert.ok(box.width > 0 && box.height > 0, `${size}: ${name} has no size`);
      }
      const { "#map-finger": map, "#numbers": numbers, "#scope .u-wrap": chart, "#scope .u-legend": legend } = found;
      const apart = [map, numbers, chart, legend];
      for (const [at, one] of apart.entries())
        for (const other of apart.slice(at + 1)) assert.ok(!overlap(one, other), `${size}: ${JSON.stringify([one, other])}`);
      const part = (map.width * map.height) / (width * height);
      const least = width <= PHONE_MAX_PX ? PART.phone : PART.other;
      const widest = width - AROUND_NARROW_PX;
      const most = (widest * widest * map.height) / map.width / (width * height);
      if (most >= least) assert.ok(part >= least, `${size}: the map has ${part.toFixed(3)} of the window`);
      else assert.ok(map.width >= widest, `${size}: the map is ${map.width} px wide`);
      if (scene === "brick") assert.ok(most >= least, `${size}: a screen of 120 by 110 mm can have its part`);
      assert.deepEqual(await page.evaluate(scrolls, true), [], `${size}: the page scrolls`);
      assert.deepEqual(await page.evaluate(cut), [], `${size}: cut`);
      const { height: plot } = await page.evaluate(boxOf, "#scope .u-over");
      assert.ok(plot >= PLOT_MIN_PX, `${size}: the curves have ${plot} px`);
    }
    assert.deepEqual(errors, []);
    await close();
  });
}

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
  const { page, errors, close } = await openStudio(undefined, { isFirstVisit: true });
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
  assert.deepEqual(errors, []);
  await close();
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
  const { page, errors, close } = await openStudio(undefined, { isFirstVisit: true });
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
  assert.deepEqual(errors, []);
  await close();
});

test("text and tools are closed at the first visit, and later as they were left", async () => {
  const { page, errors, close } = await openStudio(undefined, { isFirstVisit: true });
  const drawer = page.locator("#drawer");
  const toggle = page.locator("#toggle-drawer");
  assert.ok(await drawer.isHidden());
  assert.match(await toggle.innerText(), /Text and tools/);
  await toggle.click();
  assert.ok(await page.locator("#editor .cm-content").isVisible());
  assert.equal(await toggle.getAttribute("aria-expanded"), "true");
  await page.reload();
  await page.waitForFunction(() => globalThis.studioPage);
  assert.ok(await drawer.isVisible(), "it stays open");
  for (const size of WINDOWS) {
    await resize(page, size);
    const { "#drawer": box, "#map-finger": map } = await boxes(page, ["#drawer", "#map-finger"]);
    const window = { left: 0, top: 0, right: size[0], bottom: size[0] > PHONE_MAX_PX ? size[1] : Infinity };
    assert.ok(isWithin(box, window) && isWithin(map, window) && !overlap(box, map), `${size}: ${JSON.stringify([box, map])}`);
    assert.ok(box.top < size[1] - 200, `${size}: the text is seen, ${JSON.stringify(box)}`);
  }
  await toggle.click();
  await page.reload();
  await page.waitForFunction(() => globalThis.studioPage);
  assert.ok(await drawer.isHidden(), "it stays closed");
  assert.deepEqual(errors, []);
  await close();
});

test("values in the legend are whole, and neither they nor a tab change the size of anything", async () => {
  const { page, errors, close } = await openStudio();
  const parts = ["#scope .u-wrap", "#scope .u-legend", "#numbers", "#map-finger", "#editor", ".side", "#drawer"];
  for (const size of WINDOWS.filter(([width]) => width > PHONE_MAX_PX)) {
    await resize(page, size);
    const before = await boxes(page, parts);
    await page.evaluate(async () => {
      await slide(15, 60, 40, 90);
      await wait(100);
      lift(60, 40);
    });
    const { left, top, width, height } = await page.evaluate(boxOf, "#scope .u-over");
    // Somewhere on the stroke, which is in the last second of the chart.
    const hasValues = () => /felt.*mN/.test(document.querySelector(".u-legend").textContent);
    for (let part = 0.75; part < 1 && !(await page.evaluate(hasValues)); part += 0.01)
      await page.mouse.move(left + part * width, top + 0.4 * height);
    assert.ok(await page.evaluate(hasValues), "the legend has values");
    const cut = await page.evaluate(() => {
      const rows = [...document.querySelectorAll(".u-legend tr")];
      const isCut = (row) => row.scrollWidth > row.clientWidth + 1 || row.lastChild.getBoundingClientRect().right > row.getBoundingClientRect().right + 1;
      return rows.filter(isCut).map((row) => row.textContent);
    });
    assert.deepEqual(cut, [], `${size}`);
    for (const tab of ["sound", "compare", "pictures", "report", "layers"]) {
      await page.click(`#tab-${tab}`);
      assert.deepEqual(await boxes(page, parts), before, `${size}: ${tab}`);
    }
  }
  assert.deepEqual(errors, []);
  await close();
});

test("Arm has its place, and Stop is red and stays where it is", async () => {
  const { page, errors, close } = await openStudio(undefined, { isFirstVisit: true });
  const parts = ["#stop", "#toggle-drawer", "#open-gallery", "#map-finger", "#numbers"];
  for (const size of WINDOWS) {
    await resize(page, size);
    await page.waitForFunction(() => document.documentElement.dataset.state === "active");
    const before = await boxes(page, parts);
    const shown = await page.evaluate(async () => {
      const { engine } = studioPage;
      const show = engine.onState;
      engine.onState = () => {};
      const driving = "board NUCLEO-G474RE with an electrode, up to 220 V peak";
      const seen = [];
      for (const state of ["disarmed", "faulted", "active"]) {
        const fault = state === "faulted" ? "the amplifier reported a fault while it was driven" : undefined;
        show({ link: "serial", state, fault, needsArm: state === "disarmed", driving });
        const button = document.getElementById(state === "disarmed" ? "arm" : "clear-fault");
        const box = ({ left, top, right, bottom }) => [left, top, right, bottom];
        seen.push({ state, isShown: button.checkVisibility(), box: box(button.getBoundingClientRect()) });
        seen.at(-1).parts = Object.fromEntries(
          ["#stop", "#toggle-drawer", "#open-gallery", "#map-finger", "#numbers"].map((selector) => {
            const { left, top, right, bottom, width, height } = document.querySelector(selector).getBoundingClientRect();
            return [selector, { left, top, right, bottom, width, height }];
          }),
        );
      }
      const [red, green, blue] = getComputedStyle(document.getElementById("stop")).backgroundColor.match(/\d+/g).map(Number);
      show(engine.state);
      engine.onState = show;
      return { seen, isRed: red > 150 && green < 80 && blue < 80 };
    });
    assert.ok(shown.isRed, "Stop is red");
    for (const { state, isShown, box, parts: found } of shown.seen) {
      assert.deepEqual(found, before, `${size}: ${state} moves the page`);
      assert.equal(isShown, state !== "active", `${size}: ${state}`);
      if (isShown) assert.ok(box[2] <= before["#stop"].left && box[0] >= 0, `${size}: ${state} ${box}`);
    }
  }
  assert.deepEqual(errors, []);
  await close();
});
