// The place of a layer on the screen, and the changes of the text that move or resize it, by the engine's module.
// @ts-check

/** @import { Layer, Screen } from "../engine/types" */
/** @import { Change, TomlText } from "./toml_text.js" */
/** @typedef {{ x: number, y: number, width: number, height: number }} Box In mm. */
/** @typedef {"x" | "y" | "width" | "height"} Side */
/**
 * Where a layer is, with the offsets of its copies; and what each move and each size changes. Where it cannot be moved
 * or resized, a sentence says why.
 * @typedef {object} Place
 * @property {Box} box Of the first copy.
 * @property {[number, number][]} copies
 * @property {boolean} isWholeScreen
 * @property {boolean} keepsRatio Whether its height follows from its width.
 * @property {string} whyNotMoved
 * @property {string} whyNotResized
 * @property {(dxMm: number, dyMm: number) => Change[]} move
 * @property {(box: Box) => Change[]} resize
 */

/** Smallest side that a hand gives a region, mm. */
export const SIDE_MIN_MM = 1;

/**
 * @param {TomlText} toml The file that the layer is in.
 * @param {number} at Number of the layer among those of the file.
 * @param {Layer} layer
 * @param {Screen} screen
 * @returns {Place}
 */
export function placeOf(toml, at, { kind, boxMm }, screen) {
  const ask = (/** @type {object | null} */ act = null) => toml.place(at, { kind, boxMm, screen, act });
  return { ...ask(), move: (dxMm, dyMm) => ask({ move: [dxMm, dyMm] }), resize: (box) => ask({ resize: box }) };
}

/**
 * The rectangle around all copies of a box.
 * @param {Box} box
 * @param {[number, number][]} copies
 * @returns {Box}
 */
export function bounds({ x, y, width, height }, copies) {
  const [dx, dy] = [copies.map(([each]) => each), copies.map(([, each]) => each)];
  const [left, top] = [Math.min(...dx), Math.min(...dy)];
  const size = { width: width + Math.max(...dx) - left, height: height + Math.max(...dy) - top };
  return { x: x + left, y: y + top, ...size };
}

/**
 * @param {number} value
 * @param {number} least
 * @param {number} most
 */
export function clamp(value, least, most) {
  return Math.max(least, Math.min(value, most));
}
