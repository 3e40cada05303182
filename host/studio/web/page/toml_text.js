// The text of a scene as the map reads and edits it: the engine's module does both (host/studio/src/layer_text.rs).
// @ts-check

import { stemOf } from "./dom.js";

/** @import { Instance, Screen } from "../engine/types" */
/** @typedef {[x: number, y: number, width: number, height: number]} BoxMm */
/** @typedef {{ name: string, words: string, isPicture: boolean, scene: string }} Addition */
/** @typedef {(string | number)[]} Path Keys, and numbers of an array's elements. */
/** @typedef {number | string | boolean | null | Value[] | Fields} Value */
/** @typedef {{ [key: string]: Value }} Fields */
/**
 * A value to write, whose numbers have at most so many decimals. Where the table that it belongs to does not have it
 * yet, it goes behind the key `after`, or behind all others.
 * @typedef {{ path: Path, value: Value, decimals: number, after?: string }} Change
 */

/** @type {Instance} */
let instance;

/**
 * Texts are read and edited by this instance of the module from now on: at once, as a hand that drags needs it.
 * @param {Instance} made
 */
export function editWith(made) {
  instance = made;
}

/** Why a layer without a line of its own is not changed here. */
export const SHARED_LINE = "This layer shares its line with another: change it in the text.";

export class TomlText {
  text;
  #values;
  #lines;
  #fields;

  /**
   * Throws where the text is no TOML.
   * @param {string} text
   * @param {string} [defaults] Of its layers, as the check of the scene has them.
   */
  constructor(text, defaults = "{}") {
    const { values, lines, fields } = instance.call("read_text", new TextEncoder().encode(`${text}\0${defaults}`));
    this.text = text;
    this.defaults = defaults;
    this.#values = values;
    this.#lines = /** @type {number[]} */ (lines);
    this.#fields = /** @type {Fields[]} */ (fields);
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
   * The fields of a layer in the order of the text, then its defaults.
   * @param {number} at
   */
  fields(at) {
    return this.#fields[at];
  }

  /**
   * The place of a layer, and the changes that an act makes to it, as host/studio/src/place.rs says it.
   * @param {number} at
   * @param {object} about Kind, box, screen and act.
   */
  place(at, about) {
    const hasOwnRegion = this.value(["layer", at, "region"]) !== undefined;
    const asked = { fields: this.fields(at), hasOwnRegion, at, ...about };
    return instance.call("place", new TextEncoder().encode(JSON.stringify(asked)));
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
 * The layers that can be added: the scene that New begins with each, and for Add their names.
 * @returns {Addition[]}
 */
export function additions() {
  return instance.call("additions", new Uint8Array());
}

/** @type {Record<string, Record<string, string>> | undefined} */
let first;

/** Initial values of a new layer, as TOML by kind and field. */
export function firstValues() {
  // Completion asks for each kind that it offers.
  first ??= /** @type {Record<string, Record<string, string>>} */ (instance.call("first_values", new Uint8Array()));
  return first;
}

/**
 * What is known of perception: the noticeable steps of a friction that is e times as large, what such a step is, and
 * the voltage below which nothing is driven.
 * @returns {{ weberStepsPerE: number, weberStep: string, offBelowVRms: number }}
 */
export function perception() {
  return instance.call("perception", new Uint8Array());
}

/**
 * A text with a layer more, and the box of that where it is not the whole screen.
 * @param {{ text: string, name: string, layer: string | [file: string, aspect: number], screenMm: [number, number],
 *   takenMm: BoxMm[] }} added `layer` is a name of `additions`, or a picture.
 * @returns {{ text: string, boxMm: BoxMm | null }}
 */
export function withLayer(added) {
  return instance.call("add_layer", new TextEncoder().encode(JSON.stringify(added)));
}

/**
 * A text with a picture alone on a screen.
 * @param {string} text
 * @param {string} file
 * @param {number} aspect Its width over its height.
 * @param {Screen} screen
 */
export function pictureIn(text, file, aspect, { widthMm, heightMm }) {
  const layer = /** @type {[string, number]} */ ([file, aspect]);
  return withLayer({ text, name: stemOf(file), layer, screenMm: [widthMm, heightMm], takenMm: [] }).text;
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

/** Fields of a region in the order in which they are written, in either unit, before all others. */
const FIRST_FIELDS = ["shape", "x", "y", "width", "height"];

/** @param {string} key */
function rank(key) {
  const at = FIRST_FIELDS.indexOf(key.replace(/_(mm|px)$/, ""));
  return at < 0 ? FIRST_FIELDS.length : at;
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
  const entries = Object.entries(value).sort(([one], [other]) => rank(one) - rank(other));
  const words = entries.map(([key, each]) => `${key} = ${valueText(each, decimals)}`);
  return `{ ${words.join(", ")} }`;
}
