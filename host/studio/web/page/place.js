// The place of a layer on the screen, and the changes of the text that move or resize it.
// @ts-check

import { ALONG, PlaceReader, SIDES, bounds } from "./place_reader.js";

export { bounds };

/** @import { Layer, Screen } from "../engine/types" */
/** @import { Length } from "./place_reader.js" */
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

const DECIMALS = 2;
/** Numbers that differ by less are the same, pixels. */
const CLOSE = 1e-6;
/** Smallest side that a hand gives a region, mm. */
export const SIDE_MIN_MM = 1;
const WHOLE_SCREEN = "This layer covers the whole screen: drag a corner inwards to give it a place of its own.";

/**
 * @param {TomlText} toml The file that the layer is in.
 * @param {number} at Number of the layer among those of the file.
 * @param {Layer} layer
 * @param {Screen} screen
 * @returns {Place}
 */
export function placeOf(toml, at, layer, screen) {
  const reader = new PlacedText(toml, at, layer, screen);
  const { copies } = reader;
  const box = reader.box(copies);
  const isWholeScreen = layer.boxMm === null;
  const isMovable = reader.region || reader.anchors.length > 0;
  return {
    box,
    copies,
    isWholeScreen,
    keepsRatio: reader.keepsRatio,
    whyNotMoved: isMovable ? "" : WHOLE_SCREEN,
    whyNotResized: reader.whyNotResized(),
    move: (dxMm, dyMm) => reader.move(dxMm, dyMm, bounds(box, copies)),
    resize: (to) => reader.resize(box, to, isWholeScreen),
  };
}

/** A place in a text that can be changed. */
class PlacedText extends PlaceReader {
  /**
   * @param {number} dxMm
   * @param {number} dyMm
   * @param {Box} all Around all copies: it stays on the screen.
   * @returns {Change[]}
   */
  move(dxMm, dyMm, all) {
    const { widthMm, heightMm } = this.screen;
    const isFree = this.layer.boxMm === null;
    const by = {
      x: isFree ? dxMm : clamp(dxMm, -all.x, widthMm - all.x - all.width),
      y: isFree ? dyMm : clamp(dyMm, -all.y, heightMm - all.y - all.height),
    };
    const sides = /** @type {const} */ (["x", "y"]);
    const added = this.anchors.flatMap(({ side, length }) =>
      by[side] === 0 ? [] : [set(length, length.mm + by[side])],
    );
    if (!this.region) return added;
    const moved = this.isPolygon
      ? this.vertices.flatMap((point) => point.map((each, at) => ({ ...each, side: sides[at] })))
      : sides.map((side) => ({ .../** @type {Length} */ (this.length(side)), side }));
    const changes = moved.flatMap(({ side, ...each }) => (by[side] === 0 ? [] : [set(each, each.mm + by[side])]));
    return [...this.#inOwnRegion(changes), ...added];
  }

  /**
   * @param {Box} from
   * @param {Box} to
   * @param {boolean} isWholeScreen
   * @returns {Change[]}
   */
  resize(from, to, isWholeScreen) {
    if (isWholeScreen && !this.region) {
      const { x, y, width, height } = to;
      const value = { x_mm: x, y_mm: y, width_mm: width, height_mm: height };
      return [{ path: [...this.own, "region"], value, decimals: DECIMALS, after: "kind" }];
    }
    if (this.isPolygon) {
      const scaled = this.vertices.flatMap((point) =>
        point.map((each, at) => {
          const side = at === 0 ? "x" : "y";
          const along = ALONG[side];
          return set(each, to[side] + ((each.mm - from[side]) * to[along]) / from[along]);
        }),
      );
      return this.#inOwnRegion(scaled);
    }
    const changed = SIDES.filter((side) => to[side] !== from[side]);
    const changes = changed.flatMap((side) => {
      const length = this.length(side);
      return length ? [set(length, to[side])] : [];
    });
    return this.region ? this.#inOwnRegion(changes) : changes;
  }

  /**
   * Changes of a region that comes from the defaults, as a region of the layer's own.
   * @param {Change[]} changes
   * @returns {Change[]}
   */
  #inOwnRegion(changes) {
    if (this.hasOwnRegion || changes.length === 0) return changes;
    const value = structuredClone(/** @type {Record<string, any>} */ (this.region));
    const { length } = [...this.own, "region"];
    for (const change of changes) {
      /** @type {any} */
      let at = value;
      for (const key of change.path.slice(length, -1)) at = at[key];
      at[change.path[change.path.length - 1]] = change.value;
    }
    return [{ path: [...this.own, "region"], value, decimals: DECIMALS, after: "kind" }];
  }
}

/**
 * @param {Length} length
 * @param {number} mm
 * @returns {Change}
 */
function set({ path, mm: before, pixelMm }, mm) {
  const value = mm / pixelMm;
  const isFine = pixelMm !== 1 && pixelMm <= 0.5;
  // A pixel finer than a millimetre's half needs no fraction, unless it has one, or a step is finer still.
  const pixels = before / pixelMm;
  const isWhole =
    isFine && Math.abs(pixels - Math.round(pixels)) < CLOSE && Math.abs(value - pixels) > 1 - CLOSE;
  return { path, value, decimals: isWhole ? 0 : DECIMALS };
}

/**
 * @param {number} value
 * @param {number} least
 * @param {number} most
 */
export function clamp(value, least, most) {
  return Math.max(least, Math.min(value, most));
}
