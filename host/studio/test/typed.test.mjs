// The page in a browser: what a person types in the panel of layers is taken, whatever comes next.

import assert from "node:assert/strict";
import { test } from "node:test";
import { PLATES, onPage, openEditing, press, textOf } from "./editing.mjs";
import { plays, settled } from "./page.mjs";

/** Opens the page in the mode Edit with the left layer selected, and types a name for it. */
async function openTypingName() {
  const page = await openEditing(PLATES, [20, 30]);
  await press(page, "F2");
  await page.keyboard.type("edge");
  return page;
}

test("the press that ends a name does what it says", async () => {
  const page = await openTypingName();
  await page.getByRole("button", { name: "Duplicate", exact: true }).click();
  const text = await textOf(page);
  assert.ok(text.includes('name = "edge"     # its name') && text.includes('name = "edge 2"'), text);
  await plays(page);
});

test("Tab leads on from a name", async () => {
  const page = await openTypingName();
  await press(page, "Tab");
  assert.match(await textOf(page), /name = "edge" /);
  await plays(page);
  const focused = await page.evaluate(() => document.activeElement.getAttribute("aria-label"));
  assert.equal(focused, "Deselect");
  assert.ok(await page.getByLabel("left of edge, mm", { exact: true }).isVisible());
});

test("a press on another layer takes the name for the one that was selected", async () => {
  const page = await openTypingName();
  await page.mouse.click(...(await onPage(page, 100, 50)));
  const text = await textOf(page);
  assert.ok(text.includes('name = "edge" ') && text.includes('name = "right"'), text);
  assert.equal(await page.getByLabel("Name of right", { exact: true }).inputValue(), "right");
});

/** Gives the page events of fingers: `touch(type, selector, id)`, at a place and with a value for a slider. */
function touches(page) {
  return page.evaluate(() => {
    globalThis.touch = (type, target, pointerId, clientX = 0) => {
      const about = { pointerId, pointerType: "touch", isPrimary: pointerId === 1, bubbles: true };
      target.dispatchEvent(new PointerEvent(type, { ...about, clientX, clientY: 0 }));
    };
    globalThis.slider = document.querySelector("[aria-label='friction of left, of reach']");
    globalThis.set = (value) => {
      slider.value = value;
      slider.dispatchEvent(new Event("input", { bubbles: true }));
    };
  });
}

test("a finger that scrolls the panel takes back nothing that was typed before", async () => {
  const page = await openEditing(PLATES, [20, 30]);
  const left = page.getByLabel("left of left, mm", { exact: true });
  await left.click();
  await press(page, "Control+a");
  await page.keyboard.type("25");
  assert.match(await textOf(page), /x_mm = 25(\.0)?, y_mm = 20/);
  await touches(page);
  await page.evaluate(() => {
    touch("pointerdown", slider, 1);
    touch("pointercancel", slider, 1);
  });
  assert.match(await textOf(page), /x_mm = 25(\.0)?, y_mm = 20/);
  assert.equal(await left.inputValue(), "25");
});

test("a second finger elsewhere ends nothing that the first does on a slider", async () => {
  const page = await openEditing(PLATES, [20, 30]);
  await settled(page);
  const before = await textOf(page);
  await touches(page);
  await page.evaluate(() => {
    touch("pointerdown", slider, 1);
    set("0.9");
    touch("pointerup", document.body, 2, 100);
    touch("pointercancel", slider, 1);
  });
  assert.equal(await textOf(page), before);
  assert.equal(await page.evaluate(() => slider.value), "0.5");
});
