// Small pictures of scenes, for dialogs that offer them.
// @ts-check

import { carriedFiles } from "./bundled.js";
import { imageOf } from "./colors.js";
import { contextOf } from "./dom.js";
import { mapSizePx } from "./map.js";

/** @import { Engine } from "../engine/engine.js" */

/**
 * Draws the friction map of a scene that needs nothing but what the page carries. Resolves to its layers.
 * @param {Engine} engine
 * @param {string} text
 * @param {HTMLCanvasElement} canvas
 * @param {number} longSidePx
 */
export async function drawScene(engine, text, canvas, longSidePx) {
  const entry = "offered.toml";
  const files = { ...(await carriedFiles()), [entry]: text };
  const check = await engine.compile(files, entry, {});
  if (!("screen" in check)) throw new Error(check.problems.map(({ message }) => message).join("\n"));
  const size = mapSizePx(check.screen, longSidePx);
  Object.assign(canvas, { width: size.widthPx, height: size.heightPx });
  const map = await engine.map(files, entry, {}, { ...size, speedMmPerS: 100 });
  contextOf(canvas).putImageData(imageOf(map), 0, 0);
  return check.layers;
}
