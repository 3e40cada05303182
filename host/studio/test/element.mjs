// What the tests of <frixel-scene> share: its line, and a finger that slides over it.

import assert from "node:assert/strict";

/** Duration of a stroke, ms. */
const STROKE_MS = 1000;

/** Waits until the element shows a map, and returns the line under it. */
export async function lineOf(page, selector) {
  await page.locator(selector).scrollIntoViewIfNeeded();
  const line = page.locator(`${selector} .line`);
  await page.waitForFunction(
    (selector) => document.querySelector(selector).shadowRoot?.querySelector(".line")?.textContent,
    selector,
  );
  return line.textContent();
}

/** Slides over an element; returns felt friction and voltage at each sample. */
export async function slideOver(page, selector) {
  await page.locator(`${selector} #map-finger`).scrollIntoViewIfNeeded();
  return page.evaluate(slideOn, [selector, [0.2, 0.8], STROKE_MS]);
}

/** Runs in the page. */
async function slideOn([selector, [from, to], durationMs]) {
  const element = document.querySelector(selector);
  const canvas = element.shadowRoot.querySelector("#map-finger");
  const send = (type, part) => {
    const { left, top, width, height } = canvas.getBoundingClientRect();
    const place = { clientX: left + part * width, clientY: top + 0.5 * height };
    canvas.dispatchEvent(new PointerEvent(type, { ...place, pointerId: 1, button: 0, bubbles: true }));
  };
  const samples = { feltN: [], voltageV: [] };
  let isPlaying = false;
  const feel = ({ detail }) => {
    isPlaying ||= detail.state === "active" && detail.feltN.length > 0;
    for (const name of ["feltN", "voltageV"]) samples[name].push(...detail[name]);
  };
  element.addEventListener("feel", feel);
  // The scene under the pointer is the one that plays.
  send("pointerenter", from);
  while (!isPlaying) await wait(8);
  send("pointerdown", from);
  for (let ms = 8; ms <= durationMs; ms += 8) {
    await wait(8);
    send("pointermove", from + ((to - from) * ms) / durationMs);
  }
  // What is felt comes 40 ms later.
  await wait(100);
  send("pointerup", to);
  element.removeEventListener("feel", feel);
  return samples;
}

/** The finger has felt a friction that changes, of a drive. */
export function assertFelt({ feltN, voltageV }) {
  const touched = feltN.filter((felt) => felt > 0.05);
  assert.ok(touched.length > 200, `${touched.length} samples under the finger`);
  assert.ok(Math.max(...touched) - Math.min(...touched) > 0.02, "the friction changes");
  assert.ok(Math.max(...voltageV) > 50, "there is a drive");
}
