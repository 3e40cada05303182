// The text of a scene as the map reads and edits it: the engine's module does both (host/studio/src/layer_text.rs).
// @ts-check

/** @import { Instance } from "../engine/types" */
/** @typedef {(string | number)[]} Path Keys, and numbers of an array's elements. */
/** @typedef {number | string | boolean | null | Value[] | { [key: string]: Value }} Value */
/**
 * A value to write, whose numbers have at most so many decimals. Where the table that it belongs to does not have it
 * yet, it goes behind the key `after`, or behind all others.
 * @typedef {{ path: Path, value: Value, decimals: number, after?: string }} Change
 */

/** Decimals of the numbers of a layer that is added. */
const DECIMALS = 3;

/** @type {Instance} */
let instance;

/**
 * Texts are read and edited by this instance of the module from now on: at once, as a hand that drags needs it.
 * @param {Instance} made
 */
export function editWith(made) {
  instance = made;
}

export class TomlText {
  text;
  #values;
  #lines;

  /**
   * Throws where the text is no TOML.
   * @param {string} text
   */
  constructor(text) {
    const { values, lines } = instance.call("read_text", new TextEncoder().encode(text));
    this.text = text;
    this.#values = values;
    this.#lines = /** @type {number[]} */ (lines);
  }

  /**
   * The value at a path, or undefined.
   * @param {Path} path
   * @returns {Value | undefined}
   */
  value(path) {
    let at = this.#values;
    for (const key of path) {
      if (typeof at !== "object" || at === null || !Object.hasOwn(at, key)) return undefined;
      at = at[key];
    }
    return at;
  }

  /**
   * Number of the layer that begins in a line, among those of the text, if it is the only one there.
   * @param {number} line From 1.
   */
  layerAt(line) {
    const found = this.#lines.indexOf(line);
    return found < 0 || this.#lines.includes(line, found + 1) ? undefined : found;
  }

  /**
   * The line in which a layer begins.
   * @param {number} at
   */
  lineOf(at) {
    return this.#lines[at];
  }

  /**
   * The text with these changes.
   * @param {Change[]} changes
   */
  with(changes) {
    const parts = changes.flatMap(({ path, value, decimals, after = "" }) => [
      path.join("\n"),
      valueText(value, decimals),
      after,
    ]);
    return this.#edited("set", ...parts);
  }

  /**
   * The text with a layer behind all others.
   * @param {{ [field: string]: Value }} layer
   */
  withLayer(layer) {
    const fields = Object.entries(layer).flatMap(([field, value]) => [field, valueText(value, DECIMALS)]);
    return this.#edited("add", ...fields);
  }

  /**
   * The text with a copy of a layer right behind it, without the comment above it.
   * @param {number} at
   */
  withCopy(at) {
    return this.#edited("copy", String(at));
  }

  /**
   * The text without a layer and the comment right above it.
   * @param {number} at
   */
  without(at) {
    return this.#edited("remove", String(at));
  }

  /**
   * @param {string} act
   * @param {string[]} parts
   */
  #edited(act, ...parts) {
    const request = [act, this.text, ...parts].join("\0");
    return new TextDecoder().decode(instance.callForBytes("edit_text", new TextEncoder().encode(request)));
  }
}

/**
 * A number as a person writes it.
 * @param {number} value
 * @param {number} decimals At most.
 */
export function numberText(value, decimals) {
  // TOML has words for these, but no scene may have them.
  if (!Number.isFinite(value)) throw new Error(`${value} is no number of a scene`);
  const text = String(Number(value.toFixed(decimals)));
  return text === "-0" ? "0" : text;
}

/**
 * @param {Value} value
 * @param {number} decimals
 * @returns {string}
 */
function valueText(value, decimals) {
  if (typeof value === "number") return numberText(value, decimals);
  // TOML takes no DEL as it is.
  if (typeof value !== "object" || value === null) return JSON.stringify(value).replaceAll("\u007f", "\\u007f");
  if (Array.isArray(value)) return `[${value.map((each) => valueText(each, decimals)).join(", ")}]`;
  const words = Object.entries(value).map(([key, each]) => `${key} = ${valueText(each, decimals)}`);
  return `{ ${words.join(", ")} }`;
}
