// The place of a layer on the screen, as the text of its scene says it, and the changes of the text that move or resize
// it.
// @ts-check

/** @import { Layer, Screen } from "../engine/types" */
/** @import { Change, Path, TomlText, Value } from "./toml_text.js" */
/** @typedef {{ x: number, y: number, width: number, height: number }} Box In mm. */
/** @typedef {"x" | "y" | "width" | "height"} Side */
/** @typedef {{ path: Path, mm: number, pixelMm: number }} Length */
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

/** Kinds that have a place besides their region. */
const PLACED = ["rings", "spokes", "edge", "bitmap"];
/** @type {Side[]} */
const SIDES = ["x", "y", "width", "height"];
const DECIMALS = 2;
/** Numbers that differ by less are the same, pixels. */
const CLOSE = 1e-6;
/** Smallest side that a hand gives a region, mm. */
export const SIDE_MIN_MM = 1;
/** @type {Record<Side, "width" | "height">} */
const ALONG = { x: "width", width: "width", y: "height", height: "height" };
const WHOLE_SCREEN = "This layer covers the whole screen: drag a corner inwards to give it a place of its own.";
const ELSEWHERE =
  "The place of this layer comes from [defaults] of an included file: write it into the layer to move it.";

/**
 * @param {TomlText} toml The file that the layer is in.
 * @param {number} at Number of the layer among those of the file.
 * @param {Layer} layer
 * @param {Screen} screen
 * @param {boolean} hasOtherDefaults Whether a file that this one includes has defaults.
 * @returns {Place}
 */
export function placeOf(toml, at, layer, screen, hasOtherDefaults) {
  const reader = new PlaceReader(toml, at, layer, screen);
  const copies = reader.copies();
  const box = reader.box(copies);
  const isWholeScreen = layer.boxMm === null;
  const why = reader.whyNot(hasOtherDefaults);
  const isMovable = reader.hasRegion || reader.anchors.length > 0;
  return {
    box,
    copies,
    isWholeScreen,
    keepsRatio: reader.keepsRatio,
    whyNotMoved: why || (isMovable ? "" : WHOLE_SCREEN),
    whyNotResized: why || reader.whyNotResized(),
    move: (dxMm, dyMm) => reader.move(dxMm, dyMm, bounds(box, copies)),
    resize: (to) => reader.resize(box, to, isWholeScreen),
  };
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

class PlaceReader {
  #toml;
  #layer;
  #screen;
  /** @type {Path} */
  #own;
  #kind;

  /**
   * @param {TomlText} toml
   * @param {number} at
   * @param {Layer} layer
   * @param {Screen} screen
   */
  constructor(toml, at, layer, screen) {
    this.#toml = toml;
    this.#layer = layer;
    this.#screen = screen;
    this.#own = ["layer", at];
    this.#kind = layer.kind;
  }

  /**
   * The path of the value that counts for a field of the layer: its own, or the default of its file.
   * @param {string} field
   */
  #pathOf(field) {
    const paths = [
      [...this.#own, field],
      ["defaults", field],
    ];
    return paths.find((path) => this.#toml.value(path) !== undefined);
  }

  get #region() {
    return this.#pathOf("region");
  }

  get hasRegion() {
    return this.#region !== undefined;
  }

  get #isPolygon() {
    const region = this.#region;
    return region !== undefined && this.#toml.value([...region, "shape"]) === "polygon";
  }

  /**
   * Millimetres of a pixel of the design along a side; 1 for millimetres.
   * @param {string} field
   * @param {Side} side
   */
  #pixelMm(field, side) {
    if (!field.endsWith("_px")) return 1;
    const along = ALONG[side];
    const design = Number(this.#toml.value(["design", `${along}_px`]));
    return this.#screen[`${along}Mm`] / design;
  }

  /**
   * A length in a table, in either unit, or that of the layer itself or its defaults.
   * @param {Path | undefined} table
   * @param {Side} side
   * @returns {Length | undefined}
   */
  #length(table, side) {
    for (const within of table ? [table] : [this.#own, ["defaults"]]) {
      for (const field of [`${side}_mm`, `${side}_px`]) {
        const value = this.#toml.value([...within, field]);
        if (typeof value !== "number") continue;
        const pixelMm = this.#pixelMm(field, side);
        return { path: [...(table ?? this.#own), field], mm: value * pixelMm, pixelMm };
      }
    }
    return undefined;
  }

  /** Lengths of a place besides the region: a middle, a point of a line, or a picture's corner. */
  get anchors() {
    if (!PLACED.includes(this.#kind)) return [];
    const sides = /** @type {const} */ (["x", "y"]);
    return sides.flatMap((side) => {
      const length = this.#length(undefined, side);
      return length ? [{ side, length }] : [];
    });
  }

  /**
   * The vertices of a polygon.
   * @param {Path} region
   */
  #vertices(region) {
    const field = ["points_mm", "points_px"].find((name) => this.#toml.value([...region, name]) !== undefined);
    const points = field && this.#toml.value([...region, field]);
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
      const field = fields.find((name) => this.#toml.value([...(repeat ?? []), name]) !== undefined);
      return repeat && field ? Number(this.#toml.value([...repeat, field])) * this.#pixelMm(field, side) : 0;
    });
  }

  /** @returns {[number, number][]} */
  copies() {
    const repeat = this.#pathOf("repeat");
    // Where this file does not say the size of a pixel, the box of the check is around all copies.
    if (!repeat || this.#isInForeignPixels) return [[0, 0]];
    const count = (/** @type {string} */ name) => Number(this.#toml.value([...repeat, name]) ?? 1);
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
    const region = this.#region;
    const { boxMm } = this.#layer;
    if (!boxMm) return { x: 0, y: 0, width: this.#screen.widthMm, height: this.#screen.heightMm };
    const isHere = !this.#isInForeignPixels;
    if (region && isHere && this.#isPolygon) return around(this.#vertices(region));
    const lengths = SIDES.map((side) => region && this.#length(region, side)?.mm);
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
    const region = this.#region;
    const lengths = [
      ...this.anchors.map(({ length }) => length),
      ...(region || this.#kind === "bitmap" ? SIDES.map((side) => this.#length(region, side)) : []),
      ...(region ? this.#vertices(region).flat() : []),
    ];
    return [...this.#steps(this.#pathOf("repeat")), ...lengths.map((length) => length?.mm)].some(Number.isNaN);
  }

  /**
   * Why the layer can neither be moved nor resized, or "".
   * @param {boolean} hasOtherDefaults
   */
  whyNot(hasOtherDefaults) {
    if (this.#toml.value(["version"]) !== 2) return "Scenes of version 1 are edited in their text.";
    const isPlaced = PLACED.includes(this.#kind) && this.#kind !== "bitmap";
    const hasAll = (this.#layer.boxMm === null || this.hasRegion) && (!isPlaced || this.anchors.length === 2);
    if (!hasAll && hasOtherDefaults) return ELSEWHERE;
    if (this.#isInForeignPixels)
      return "This layer is placed in pixels of a design in another file: change it in the text.";
    return "";
  }

  whyNotResized() {
    const isTurned = Number(this.#toml.value(this.#pathOf("angle_deg") ?? ["no"]) ?? 0) !== 0;
    if (this.#kind !== "bitmap" || this.hasRegion || this.#layer.boxMm === null) return "";
    return isTurned ? "A turned picture has no side to drag: change its width in the text." : "";
  }

  /**
   * @param {number} dxMm
   * @param {number} dyMm
   * @param {Box} all Around all copies: it stays on the screen.
   * @returns {Change[]}
   */
  move(dxMm, dyMm, all) {
    const { widthMm, heightMm } = this.#screen;
    const isFree = this.#layer.boxMm === null;
    const by = {
      x: isFree ? dxMm : clamp(dxMm, -all.x, widthMm - all.x - all.width),
      y: isFree ? dyMm : clamp(dyMm, -all.y, heightMm - all.y - all.height),
    };
    const region = this.#region;
    const sides = /** @type {const} */ (["x", "y"]);
    const added = this.anchors.flatMap(({ side, length }) =>
      by[side] === 0 ? [] : [set(length, length.mm + by[side])],
    );
    if (!region) return added;
    const moved = this.#isPolygon
      ? this.#vertices(region).flatMap((point) => point.map((each, at) => ({ ...each, side: sides[at] })))
      : sides.map((side) => ({ .../** @type {Length} */ (this.#length(region, side)), side }));
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
    const region = this.#region;
    if (isWholeScreen && !region) {
      const { x, y, width, height } = to;
      const value = { x_mm: x, y_mm: y, width_mm: width, height_mm: height };
      return [{ path: [...this.#own, "region"], value, decimals: DECIMALS, after: "kind" }];
    }
    if (region && this.#isPolygon) {
      const scaled = this.#vertices(region).flatMap((point) =>
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
      const length = this.#length(region, side);
      return length ? [set(length, to[side])] : [];
    });
    return region ? this.#inOwnRegion(changes) : changes;
  }

  get keepsRatio() {
    if (this.#layer.boxMm === null) return false;
    return this.#kind === "bitmap" && !this.hasRegion && this.#length(undefined, "height") === undefined;
  }

  /**
   * Changes of a region that comes from the defaults, as a region of the layer's own.
   * @param {Change[]} changes
   * @returns {Change[]}
   */
  #inOwnRegion(changes) {
    const region = this.#region;
    if (region?.[0] !== "defaults" || changes.length === 0) return changes;
    const value = structuredClone(/** @type {Record<string, any>} */ (this.#toml.value(region)));
    for (const change of changes) {
      /** @type {any} */
      let at = value;
      for (const key of change.path.slice(region.length, -1)) at = at[key];
      at[change.path[change.path.length - 1]] = change.value;
    }
    return [{ path: [...this.#own, "region"], value, decimals: DECIMALS, after: "kind" }];
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
 * @param {Length[][]} points
 * @returns {Box}
 */
function around(points) {
  const [xs, ys] = [0, 1].map((along) => points.map((point) => point[along].mm));
  const [x, y] = [Math.min(...xs), Math.min(...ys)];
  return { x, y, width: Math.max(...xs) - x, height: Math.max(...ys) - y };
}

/**
 * @param {number} value
 * @param {number} least
 * @param {number} most
 */
export function clamp(value, least, most) {
  return Math.max(least, Math.min(value, most));
}
