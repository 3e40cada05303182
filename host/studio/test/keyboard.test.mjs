// The page in a browser, by keys alone: what Tab reaches in the mode Edit, and where the focus is seen.

import assert from "node:assert/strict";
import { test } from "node:test";
import { PLATES, hold, onPage, openEditing, press, selected, textOf } from "./editing.mjs";
import { plays, resize } from "./page.mjs";

const focusOptions = (page) => page.evaluate(() => document.querySelector("#options summary").focus());
const focusedName = (page) =>
  page.evaluate(() => document.activeElement.getAttribute("aria-label") ?? document.activeElement.textContent);

test("a name in the tab Layers selects its layer on the map, where the keys act then, and shows its text", async () => {
  const page = await openEditing();
  const name = page.locator("#panel-layers").getByRole("button", { name: "right", exact: true });
  await name.focus();
  await press(page, "Enter");
  assert.match(await selected(page), /^right, /);
  assert.equal(await page.locator(".cm-activeLine").textContent(), "[[layer]]");
  await press(page, "ArrowDown");
  assert.match(await textOf(page), /region\.y_mm = 21 /);
  await page.getByRole("button", { name: "Feel", exact: true }).click();
  await plays(page);
  await name.focus();
  await press(page, "Enter");
  await page.waitForFunction(() => document.activeElement.classList.contains("cm-content"));
});

test("no focus is behind the panel in the mode Edit, and it is seen on the map, too", async () => {
  const page = await openEditing();
  await page.click("#toggle-drawer");
  for (const size of [[1280, 800], [1000, 760]]) {
    await resize(page, size);
    await page.mouse.click(...(await onPage(page, 20, 30)));
    await focusOptions(page);
    const hidden = [];
    for (let presses = 0; presses < 60; presses += 1) {
      await press(page, "Tab");
      const seen = await page.evaluate(() => {
        const { activeElement } = document;
        if (activeElement === document.body) return undefined;
        const { left, top, width, height } = activeElement.getBoundingClientRect();
        const found = document.elementFromPoint(left + width / 2, top + height / 2);
        const isPanel = activeElement.closest(".layer-panel") !== null;
        const name = activeElement.id || activeElement.getAttribute("aria-label") || activeElement.textContent;
        return { name, isBehind: !isPanel && found?.closest(".layer-panel") !== null };
      });
      if (seen === undefined) break;
      if (seen.isBehind) hidden.push(seen.name);
    }
    assert.deepEqual(hidden, [], JSON.stringify(size));
  }
  await page.mouse.click(...(await onPage(page, 20, 30)));
  await press(page, "Delete");
  assert.ok(await page.evaluate(() => document.activeElement.classList.contains("hands")));
  assert.notEqual(await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle), "none");
  await page.getByRole("button", { name: "Feel", exact: true }).click();
  // The panel is gone, and what it covered is free at the next picture.
  await page.waitForFunction(() => !document.querySelector("#open-lag").closest("[inert]"));
});

test("keys that move do nothing while the pointer holds the layer", async () => {
  const page = await openEditing();
  await hold(page, [20, 30], [30, 30]);
  const dragged = PLATES.replace("x_mm = 10.0", "x_mm = 20.0");
  await press(page, "ArrowDown", "PageDown");
  assert.equal(await textOf(page), dragged);
  await page.mouse.move(...(await onPage(page, 32, 30)), { steps: 3 });
  await page.mouse.up();
  assert.equal(await textOf(page), PLATES.replace("x_mm = 10.0", "x_mm = 22.0"));
  await press(page, "ArrowDown", "Control+z");
  assert.match(await selected(page), /^left, /);
  await press(page, "Control+z");
  assert.equal(await textOf(page), PLATES, "the drag is one step");
});

test("Escape closes the options wherever the focus is, and so does Tab past their end", async () => {
  const page = await openEditing();
  const menu = page.locator("#screen");
  await page.click("#options summary");
  await page.evaluate(() => document.activeElement.blur());
  await press(page, "Escape");
  assert.ok(await menu.isHidden());
  assert.ok(await page.evaluate(() => document.activeElement.matches("#options summary")));
  await press(page, "Enter");
  assert.ok(await menu.isVisible());
  await page.focus("#full-screen");
  await press(page, "Tab");
  assert.ok(await menu.isHidden(), "the focus has left it");
  assert.match(await selected(page), /^left, /);
});

test("F2 leads to the name of a layer, Enter gives it, and Escape and a name that is taken leave it", async () => {
  const page = await openEditing(PLATES, [20, 30]);
  await press(page, "F2");
  await page.keyboard.type("door bell");
  await press(page, "Enter");
  assert.equal(await textOf(page), PLATES.replace('"left" ', '"door bell" '));
  assert.match(await selected(page), /^door bell, constant, /);
  await plays(page);
  await press(page, "ArrowRight", "F2");
  assert.equal(await focusedName(page), "Name of door bell");
  await page.keyboard.type("x");
  await press(page, "Escape", "F2");
  await page.keyboard.type("right");
  await press(page, "Enter");
  assert.equal(await page.locator(".layer-panel .note").textContent(), "Another layer is called right.");
  assert.match(await textOf(page), /name = "door bell" .*\n.*\n.*x_mm = 11\.0/);
  await press(page, "Control+z", "Control+z");
  assert.equal(await textOf(page), PLATES);
  await page.locator("[aria-current=true][aria-label^='left, ']").waitFor();
  await press(page, "Control+y");
  await page.locator("[aria-current=true][aria-label^='door bell, ']").waitFor();
});
