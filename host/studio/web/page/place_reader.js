// The place of a layer on the screen, as the text of its scene says it.
// @ts-check

/** @import { Layer, Screen } from "../engine/types" */
/** @import { Box, Side } from "./place.js" */
/** @import { Path, TomlText, Value } from "./toml_text.js" */
/** @typedef {{ path: Path, mm: number, pixelMm: number }} Length */

/** Kinds that have a place besides their region. */
const PLACED = ["rings", "spokes", "edge", "bitmap"];
/** @type {Side[]} */
export const SIDES = ["x", "y", "width", "height"];
/** @type {Record<Side, "width" | "height">} */
export const ALONG = { x: "width", width: "width", y: "height", height: "height" };
const FROM_OTHER_DEFAULTS =
  "The place of this layer comes from [defaults] of an included file: write it into the layer to move it.";

export class PlaceReader {
  toml;
  layer;
  screen;
  /** @type {Path} */
  own;
  #kind;

  /**
   * @param {TomlText} toml
   * @param {number} at
   * @param {Layer} layer
   * @param {Screen} screen
   */
  constructor(toml, at, layer, screen) {
    this.toml = toml;
    this.layer = layer;
    this.screen = screen;
    this.own = ["layer", at];
    this.#kind = layer.kind;
  }

  /**
   * The path of the value that counts for a field of the layer: its own, or the default of its file.
   * @param {string} field
   */
  #pathOf(field) {
    const paths = [
      [...this.own, field],
      ["defaults", field],
    ];
    return paths.find((path) => this.toml.value(path) !== undefined);
  }

  get region() {
    return this.#pathOf("region");
  }

  get hasRegion() {
    return this.region !== undefined;
  }

  get isPolygon() {
    const region = this.region;
    return region !== undefined && this.toml.value([...region, "shape"]) === "polygon";
  }

  /**
   * Millimetres of a pixel of the design along a side; 1 for millimetres.
   * @param {string} field
   * @param {Side} side
   */
  #pixelMm(field, side) {
    if (!field.endsWith("_px")) return 1;
    const along = ALONG[side];
    const design = Number(this.toml.value(["design", `${along}_px`]));
    return this.screen[`${along}Mm`] / design;
  }

  /**
   * A length in a table, in either unit, or that of the layer itself or its defaults.
   * @param {Path | undefined} table
   * @param {Side} side
   * @returns {Length | undefined}
   */
  length(table, side) {
    for (const within of table ? [table] : [this.own, ["defaults"]]) {
      for (const field of [`${side}_mm`, `${side}_px`]) {
        const value = this.toml.value([...within, field]);
        if (typeof value !== "number") continue;
        const pixelMm = this.#pixelMm(field, side);
        return { path: [...(table ?? this.own), field], mm: value * pixelMm, pixelMm };
      }
    }
    return undefined;
  }

  /** Lengths of a place besides the region: a middle, a point of a line, or a picture's corner. */
  get anchors() {
    if (!PLACED.includes(this.#kind)) return [];
    const sides = /** @type {const} */ (["x", "y"]);
    return sides.flatMap((side) => {
      const length = this.length(undefined, side);
      return length ? [{ side, length }] : [];
    });
  }

  /**
   * The vertices of a polygon.
   * @param {Path} region
   */
  vertices(region) {
    const field = ["points_mm", "points_px"].find((name) => this.toml.value([...region, name]) !== undefined);
    const points = field && this.toml.value([...region, field]);
    if (!field || !Array.isArray(points)) return [];
    const sides = /** @type {const} */ (["x", "y"]);
    return points.map((point, at) =>
      sides.map((side, along) => {
        const pixelMm = this.#pixelMm(field, side);
        const value = Number(/** @type {Value[]} */ (point)[along]);
        return { path: [...region, field, at, along], mm: value * pixelMm, pixelMm };
      }),
    );
  }

  /**
   * How far a copy is from the one before, in x and y.
   * @param {Path | undefined} repeat
   */
  #steps(repeat) {
    return (/** @type {const} */ (["x", "y"])).map((side) => {
      const fields = repeat ? [`d${side}_mm`, `d${side}_px`] : [];
      const field = fields.find((name) => this.toml.value([...(repeat ?? []), name]) !== undefined);
      return repeat && field ? Number(this.toml.value([...repeat, field])) * this.#pixelMm(field, side) : 0;
    });
  }

  /** @returns {[number, number][]} */
  copies() {
    const repeat = this.#pathOf("repeat");
    // Where this file does not say the size of a pixel, the box of the check is around all copies.
    if (!repeat || this.#isInForeignPixels) return [[0, 0]];
    const count = (/** @type {string} */ name) => Number(this.toml.value([...repeat, name]) ?? 1);
    const [dx, dy] = this.#steps(repeat);
    const rows = Array.from({ length: count("rows") }, (_, row) => row * dy);
    const columns = Array.from({ length: count("columns") }, (_, column) => column * dx);
    return rows.flatMap((y) => columns.map((x) => /** @type {[number, number]} */ ([x, y])));
  }

  /**
   * The box of the first copy: as the text says it, or the check where only that knows.
   * @param {[number, number][]} copies
   * @returns {Box}
   */
  box(copies) {
    const region = this.region;
    const { boxMm } = this.layer;
    if (!boxMm) return { x: 0, y: 0, width: this.screen.widthMm, height: this.screen.heightMm };
    const isHere = !this.#isInForeignPixels;
    if (region && isHere && this.isPolygon) return around(this.vertices(region));
    const lengths = SIDES.map((side) => region && this.length(region, side)?.mm);
    if (isHere && lengths.every((mm) => mm !== undefined)) {
      const [x, y, width, height] = lengths;
      return { x, y, width, height };
    }
    const [x, y, width, height] = boxMm;
    const offsets = bounds({ x: 0, y: 0, width: 0, height: 0 }, copies);
    return { x: x - offsets.x, y: y - offsets.y, width: width - offsets.width, height: height - offsets.height };
  }

  /** Whether a length of its place is in pixels whose size this file does not say. */
  get #isInForeignPixels() {
    const region = this.region;
    const lengths = [
      ...this.anchors.map(({ length }) => length),
      ...(region || this.#kind === "bitmap" ? SIDES.map((side) => this.length(region, side)) : []),
      ...(region ? this.vertices(region).flat() : []),
    ];
    return [...this.#steps(this.#pathOf("repeat")), ...lengths.map((length) => length?.mm)].some(Number.isNaN);
  }

  /** Why the layer can neither be moved nor resized, or "". */
  whyNot() {
    if (this.#isInForeignPixels)
      return "This layer is placed in pixels of a design in another file: change it in the text.";
    return this.#hasOwnPlace ? "" : FROM_OTHER_DEFAULTS;
  }

  /** Whether this file says where the layer is that the check has found in a place. */
  get #hasOwnPlace() {
    const isAnchored = this.anchors.length === 2;
    if (this.#kind === "bitmap") return this.hasRegion || (isAnchored && this.length(undefined, "width") !== undefined);
    return (this.layer.boxMm === null || this.hasRegion) && (isAnchored || !PLACED.includes(this.#kind));
  }

  whyNotResized() {
    const isTurned = Number(this.toml.value(this.#pathOf("angle_deg") ?? ["no"]) ?? 0) !== 0;
    if (this.#kind !== "bitmap" || this.hasRegion || this.layer.boxMm === null) return "";
    return isTurned ? "A turned picture has no side to drag: change its width in the text." : "";
  }

  get keepsRatio() {
    if (this.layer.boxMm === null) return false;
    return this.#kind === "bitmap" && !this.hasRegion && this.length(undefined, "height") === undefined;
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
