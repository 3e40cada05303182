// The place of a layer on the screen, as the fields of the layer say it.
// @ts-check

/** @import { Layer, Screen } from "../engine/types" */
/** @import { Box, Side } from "./place.js" */
/** @import { Fields, Path, TomlText } from "./toml_text.js" */
/** @typedef {{ path: Path, mm: number, pixelMm: number }} Length */

/** Kinds that have a place besides their region. */
const PLACED = ["rings", "spokes", "edge", "bitmap"];
/** @type {Side[]} */
export const SIDES = ["x", "y", "width", "height"];
/** @type {Record<Side, "width" | "height">} */
export const ALONG = { x: "width", width: "width", y: "height", height: "height" };

export class PlaceReader {
  layer;
  screen;
  /** @type {Path} */
  own;
  #fields;

  /**
   * @param {TomlText} toml
   * @param {number} at
   * @param {Layer} layer
   * @param {Screen} screen
   */
  constructor(toml, at, layer, screen) {
    this.layer = layer;
    this.screen = screen;
    this.own = ["layer", at];
    this.#fields = toml.fields(at);
    this.hasOwnRegion = toml.value([...this.own, "region"]) !== undefined;
  }

  get region() {
    return /** @type {Fields | undefined} */ (this.#fields.region);
  }

  get isPolygon() {
    return this.region?.shape === "polygon";
  }

  /**
   * Millimetres of a pixel of the design along a side; 1 for millimetres.
   * @param {string} field
   * @param {Side} side
   */
  #pixelMm(field, side) {
    return field.endsWith("_px") ? (this.screen.pixelMm?.[ALONG[side] === "width" ? 0 : 1] ?? 1) : 1;
  }

  /**
   * A length of the region, or of the layer itself, in either unit.
   * @param {Side} side
   * @param {Fields} table
   * @param {Path} path
   * @returns {Length | undefined}
   */
  #length(side, table, path) {
    const field = [`${side}_mm`, `${side}_px`].find((name) => name in table);
    if (!field) return undefined;
    const pixelMm = this.#pixelMm(field, side);
    return { path: [...path, field], mm: Number(table[field]) * pixelMm, pixelMm };
  }

  /**
   * A length of the region, or of a layer without one.
   * @param {Side} side
   */
  length(side) {
    const { region } = this;
    return region ? this.#length(side, region, [...this.own, "region"]) : this.#length(side, this.#fields, this.own);
  }

  /** Lengths of a place besides the region: a middle, a point of a line, or a picture's corner. */
  get anchors() {
    if (!PLACED.includes(this.layer.kind)) return [];
    const sides = /** @type {const} */ (["x", "y"]);
    return sides.flatMap((side) => {
      const length = this.#length(side, this.#fields, this.own);
      return length ? [{ side, length }] : [];
    });
  }

  /** The vertices of a polygon. */
  get vertices() {
    const field = this.region && "points_px" in this.region ? "points_px" : "points_mm";
    const points = /** @type {number[][]} */ (this.region?.[field]);
    const sides = /** @type {const} */ (["x", "y"]);
    return points.map((point, at) =>
      sides.map((side, along) => {
        const pixelMm = this.#pixelMm(field, side);
        return { path: [...this.own, "region", field, at, along], mm: point[along] * pixelMm, pixelMm };
      }),
    );
  }

  /** How far each copy is from the first. */
  get copies() {
    const repeat = /** @type {Fields} */ (this.#fields.repeat ?? {});
    const offsets = (/** @type {string} */ name, /** @type {"x" | "y"} */ side) => {
      const field = `d${side}_mm` in repeat ? `d${side}_mm` : `d${side}_px`;
      const stepMm = Number(repeat[field] ?? 0) * this.#pixelMm(field, side);
      return Array.from({ length: Number(repeat[name] ?? 1) }, (_, at) => at * stepMm);
    };
    const columns = offsets("columns", "x");
    return offsets("rows", "y").flatMap((y) => columns.map((x) => /** @type {[number, number]} */ ([x, y])));
  }

  /**
   * The box of the first copy: as the text says it, or the check where only that knows.
   * @param {[number, number][]} copies
   * @returns {Box}
   */
  box(copies) {
    const { boxMm } = this.layer;
    if (!boxMm) return { x: 0, y: 0, width: this.screen.widthMm, height: this.screen.heightMm };
    if (this.isPolygon) return around(this.vertices);
    if (this.region) {
      const [x, y, width, height] = SIDES.map((side) => this.length(side)?.mm ?? 0);
      return { x, y, width, height };
    }
    const [x, y, width, height] = boxMm;
    const offsets = bounds({ x: 0, y: 0, width: 0, height: 0 }, copies);
    return { x: x - offsets.x, y: y - offsets.y, width: width - offsets.width, height: height - offsets.height };
  }

  whyNotResized() {
    const isTurned = Number(this.#fields.angle_deg ?? 0) !== 0;
    if (this.layer.kind !== "bitmap" || this.region || this.layer.boxMm === null) return "";
    return isTurned ? "A turned picture has no side to drag: change its width in the text." : "";
  }

  get keepsRatio() {
    return this.layer.boxMm !== null && this.layer.kind === "bitmap" && !this.region && !this.length("height");
  }
}

/**
 * @param {Length[][]} points
 * @returns {Box}
 */
function around(points) {
  const [xs, ys] = [0, 1].map((along) => points.map((point) => point[along].mm));
  const [x, y] = [Math.min(...xs), Math.min(...ys)];
  return { x, y, width: Math.max(...xs) - x, height: Math.max(...ys) - y };
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
