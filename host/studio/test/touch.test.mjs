// The page in a browser, on a phone: the panel of layers makes room for the text, and fingers scroll and slide.

import assert from "node:assert/strict";
import { test } from "node:test";
import { onPage, openEditing, textOf, touchScreen } from "./editing.mjs";
import { plays, resize, settled } from "./page.mjs";

const PHONE = [390, 844];

/** Opens the page with a scene on a phone, in the mode Edit, with a layer that is selected. */
async function openPhone() {
  const page = await openEditing();
  await resize(page, PHONE);
  await page.mouse.click(...(await onPage(page, 20, 30)));
  return page;
}

/** Whether a place in the middle of an element shows it, and no other lies over it. */
const isOnTop = (page, selector) =>
  page.evaluate((selector) => {
    const found = document.querySelector(selector);
    const { left, top, width, height } = found.getBoundingClientRect();
    return found.contains(document.elementFromPoint(left + width / 2, top + height / 2));
  }, selector);

test("on a phone the panel gives way to the text, and a press on a layer brings it back", async () => {
  const page = await openPhone();
  const panel = page.locator(".layer-panel");
  await panel.getByRole("button", { name: "Text", exact: true }).click();
  await page.waitForFunction(() => document.activeElement.classList.contains("cm-content"));
  assert.ok(await isOnTop(page, ".cm-activeLine"), "the line of the layer is seen");
  await page.keyboard.type("zz");
  await page.locator("#problems li.error").first().waitFor();
  assert.ok(await isOnTop(page, "#problems li.error"), "what a person types breaks nothing unseen");
  for (let times = 0; times < 2; times += 1) await page.keyboard.press("Backspace");
  await plays(page);
  await page.mouse.click(...(await onPage(page, 20, 30)));
  assert.ok(await panel.isVisible());
  await page.click("#toggle-drawer");
  assert.ok(await panel.isVisible(), "there is no text to give way to");
  await page.click("#toggle-drawer");
  assert.ok(await isOnTop(page, ".cm-line"), "the first line, too");
});

test("a swipe up that begins on a slider scrolls and changes nothing; one along it does", async () => {
  const page = await openPhone();
  const { touch, detach } = await touchScreen(page);
  const panel = page.locator(".layer-panel");
  const slider = page.getByLabel("friction of left, of reach", { exact: true });
  const swipe = async (dx, dy) => {
    await slider.scrollIntoViewIfNeeded();
    await settled(page);
    const { x, y, width, height } = await slider.boundingBox();
    const [fromX, fromY] = [x + width * 0.2, y + height / 2];
    await touch("touchStart", [fromX, fromY]);
    for (let part = 0.1; part <= 1 && dx + dy !== 0; part += 0.1)
      await touch("touchMove", [fromX + dx * part, fromY + dy * part]);
    await touch("touchEnd");
  };
  const before = await textOf(page);
  const [value, top] = [await slider.inputValue(), await panel.evaluate((each) => each.scrollTop)];
  await swipe(0, -120);
  await page.waitForFunction((top) => document.querySelector(".layer-panel").scrollTop !== top, top);
  assert.equal(await textOf(page), before);
  assert.equal(await slider.inputValue(), value);
  await swipe(60, 4);
  const slid = Number(await slider.inputValue());
  assert.ok(slid > 0.2 && (await textOf(page)).includes(`friction_fraction = ${slid}\n`), `${slid}`);
  await swipe(0, 0);
  await detach();
  const tapped = Number(await slider.inputValue());
  assert.ok(tapped < slid && (await textOf(page)).includes(`friction_fraction = ${tapped}\n`), `${tapped}`);
  await plays(page);
});
