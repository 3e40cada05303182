// What the tests of the mode Edit share: a scene that is edited, and drags on its map.

import assert from "node:assert/strict";
import { openScene, settled } from "./page.mjs";

export const PLATES = `# Two plates.
version = 1

# The lower one.
[[layer]]
name = "left"     # its name
kind = "constant"
region = {x_mm = 10.0, y_mm = 20, width_mm = 30, height_mm = 30} # a box
friction_fraction = 0.5

# The upper one.
[[layer]]
name = "right"
kind = "rings"
region.x_mm = 70
region.y_mm = 20 # from above
region.width_mm = 40
region.height_mm = 40
x_mm = 90
y_mm = 40.0
wavelength_mm = 4
low_fraction = 0
high_fraction = 0.9
`;

/** Opens the scene in the page of all tests, in the mode Edit, and selects the layer at a place of the screen, mm. */
export async function openEditing(text = PLATES, at = undefined) {
  const page = await openScene(text);
  await page.getByRole("button", { name: "Edit", exact: true }).click();
  await settled(page);
  if (at) await page.mouse.click(...(await onPage(page, ...at)));
  return page;
}

/** Where a place of the screen is in the window, CSS pixels. */
export function onPage(page, xMm, yMm) {
  return page.evaluate(
    ([xMm, yMm]) => {
      const { left, top } = document.getElementById("map-finger").getBoundingClientRect();
      const { scale } = studioPage.map;
      return [left + xMm * scale, top + yMm * scale];
    },
    [xMm, yMm],
  );
}

/** Presses the mouse at a place of the screen, mm, and drags to others. */
export async function hold(page, from, ...places) {
  await page.mouse.move(...(await onPage(page, ...from)));
  await page.mouse.down();
  for (const place of places) await page.mouse.move(...(await onPage(page, ...place)), { steps: 6 });
}

/** Drags with the mouse from one place to another, mm, and lifts. */
export async function drag(page, from, to) {
  await hold(page, from, to);
  await page.mouse.up();
}

/** Presses a slider at a part of its width, and drags to others. Returns what drags on. */
export async function holdSlider(page, slider, from, ...parts) {
  const { x, y, width, height } = await slider.boundingBox();
  const dragTo = (part) => page.mouse.move(x + width * part, y + height / 2, { steps: 3 });
  await dragTo(from);
  await page.mouse.down();
  for (const part of parts) await dragTo(part);
  return dragTo;
}

/** Drags a handle of the layer that is selected by so many mm. */
export async function dragHandle(page, side, dx, dy) {
  const { x, y, width, height } = await page.locator(`.layer-handle[data-side=${side}]`).boundingBox();
  assert.ok(width >= 24 && height >= 24, `a handle of ${width} x ${height} pixels`);
  const [left, top] = await onPage(page, 0, 0);
  const [right, bottom] = await onPage(page, dx, dy);
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 2 + right - left, y + height / 2 + bottom - top, { steps: 6 });
  await page.mouse.up();
}

/** Takes the first layer of constant.toml over from the gallery, and returns its name. */
export async function takeLayer(page) {
  await page.click("#open-gallery");
  const card = page.locator("#gallery article", { has: page.locator('h3:text-is("constant")') });
  await card.locator("summary").click();
  const take = card.locator("li button").first();
  await take.click();
  await page.locator("#gallery >> text=Close").click();
  return (await take.getAttribute("aria-label")).replace("Take over ", "");
}

/** Makes the browser's pointer a finger: `touch(type, ...points)` in CSS pixels, until `detach()`. */
export async function touchScreen(page) {
  const client = await page.context().newCDPSession(page);
  await client.send("Emulation.setTouchEmulationEnabled", { enabled: true });
  // Buttons are larger under a finger.
  await settled(page);
  const touch = (type, ...points) =>
    client.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y]) => ({ x, y })) });
  return { touch, detach: () => client.detach() };
}

export const textOf = (page) => page.evaluate(() => studioPage.editor.text);
export const selected = (page) => page.locator(".layer-box[aria-current=true]").getAttribute("aria-label");
export const press = async (page, ...keys) => {
  for (const key of keys) await page.keyboard.press(key);
};
