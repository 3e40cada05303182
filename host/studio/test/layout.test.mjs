// The page in windows of eight sizes: what is felt is seen without scrolling, and the map has most of the room.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  AROUND_NARROW_PX, PART, PHONE_MAX_PX, PLOT_MIN_PX, SCHEMES, WINDOWS, boxOf, boxes, cut, isWithin, openBundled, overlap, scrolls,
} from "./layout.mjs";
import { openStudio, resize } from "./page.mjs";

const SEEN = ["header", "#stop", "#map-finger", "#numbers", "#scope .u-wrap", "#scope .u-legend"];

/** In the page: the boxes of the words over the map: of the first visit, what is left of them, and of a slow replay. */
function boxesOver() {
  const [first, lens] = ["first-words", "lens-words"].map((id) => document.getElementById(id));
  const boxes = [first.getBoundingClientRect()];
  first.classList.add("taken");
  boxes.push(first.getBoundingClientRect());
  first.classList.remove("taken");
  lens.hidden = false;
  boxes.push(lens.getBoundingClientRect());
  lens.hidden = true;
  return boxes.map((box) => box.toJSON());
}

for (const [scene, colorScheme] of Object.entries(SCHEMES)) {
  test(`map, numbers, scope and legend are seen at eight sizes, ${scene}, ${colorScheme}`, async () => {
    const page = await openStudio(undefined, { isFirstVisit: true });
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
      const words = await page.evaluate(boxesOver);
      for (const box of words) assert.ok(isWithin(box, map) && box.width > 0, `${size}: over the ruler, ${JSON.stringify(box)}`);
    }
  });
}

test("text and tools are closed at the first visit, and later as they were left", async () => {
  const page = await openStudio(undefined, { isFirstVisit: true });
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
});

test("values in the legend are whole, and neither they nor a tab change the size of anything", async () => {
  const page = await openStudio();
  const marks = page.locator("#scope .u-marker");
  const drawn = await marks.evaluateAll((all) => all.map((mark) => getComputedStyle(mark).borderTopStyle));
  assert.deepEqual(drawn.slice(1), ["dashed", "solid", "solid"], "as the curves of reference, felt and voltage");
  const parts = ["#scope .u-wrap", "#scope .u-legend", "#numbers", "#map-finger", "#editor", ".side", "#drawer"];
  for (const size of WINDOWS.filter(([width]) => width > PHONE_MAX_PX)) {
    await resize(page, size);
    const before = await boxes(page, parts);
    await page.evaluate(() => stroke(15, 60, 40, 90));
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
});

test("Arm has its place, and Stop is red and stays where it is", async () => {
  const page = await openStudio(undefined, { isFirstVisit: true });
  const parts = ["#stop", "#toggle-drawer", "#open-gallery", "#map-finger", "#numbers"];
  for (const size of WINDOWS) {
    await resize(page, size);
    await page.waitForFunction(() => document.documentElement.dataset.state === "active");
    const before = await boxes(page, parts);
    for (const state of ["disarmed", "faulted", "active"]) {
      const shown = await page.evaluate((state) => {
        const { engine } = studioPage;
        globalThis.show ??= engine.onState;
        engine.onState = () => {};
        const fault = state === "faulted" ? "the amplifier reported a fault while it was driven" : undefined;
        const driving = "board NUCLEO-G474RE with an electrode, up to 220 V peak";
        show({ link: "serial", state, fault, needsArm: state === "disarmed", driving });
        const button = document.getElementById(state === "disarmed" ? "arm" : "clear-fault");
        const { left, right } = button.getBoundingClientRect();
        const isCut = button.scrollHeight > button.clientHeight + 1;
        const stop = getComputedStyle(document.getElementById("stop")).backgroundColor;
        return { isShown: button.checkVisibility(), isCut, left, right, stop: stop.match(/\d+/g).map(Number) };
      }, state);
      const where = `${size}: ${state} ${JSON.stringify(shown)}`;
      assert.deepEqual(await boxes(page, parts), before, `${where} moves the page`);
      assert.equal(shown.isShown, state !== "active", where);
      assert.ok(!shown.isCut, `${where}: words are cut`);
      if (shown.isShown) assert.ok(shown.right <= before["#stop"].left && shown.left >= 0, where);
      const [red, green, blue] = shown.stop;
      assert.ok(red > 150 && green < 80 && blue < 80, `${where}: Stop is red`);
    }
    await page.evaluate(() => {
      const { engine } = studioPage;
      show(engine.state);
      engine.onState = show;
    });
  }
});
