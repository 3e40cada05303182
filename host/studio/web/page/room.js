// The room of the map in the page: the columns stand before the engine is ready, and stay where they are then.
// @ts-check

import { byId, settings } from "./dom.js";
import { FrictionMap } from "./map.js";

/** @import { Screen } from "../engine/types" */

/** Setting that keeps the size of the last scene's screen. */
const SETTING = "screen";
/** The screen of the scene that the page begins with. layout.css has its ratio, too. @type {Screen} */
const FIRST_SCREEN = { widthMm: 120, heightMm: 110 };

/** Makes the map, which says how wide its column is; nothing is drawn on it yet. */
export function makeMap() {
  const map = new FrictionMap(byId("map"), byId("map-picture"));
  /** @type {HTMLElement | null} */
  const grid = document.querySelector(".feel-grid");
  let kept = settings.get(SETTING) ?? "";
  map.screen = screenIn(kept) ?? FIRST_SCREEN;
  map.onRoom = (widthPx, heightPx) => {
    grid?.style.setProperty("--map-width", `${Math.ceil(widthPx) + 2}px`);
    grid?.style.setProperty("--map-height", `${Math.ceil(heightPx) + 1}px`);
    const now = `${map.screen.widthMm} ${map.screen.heightMm}`;
    if (now !== kept) settings.set(SETTING, now);
    kept = now;
  };
  map.layout();
  return map;
}

/**
 * @param {string} text
 * @returns {Screen | undefined}
 */
function screenIn(text) {
  const [widthMm, heightMm] = text.split(" ").map(Number);
  return widthMm > 0 && heightMm > 0 ? { widthMm, heightMm } : undefined;
}
