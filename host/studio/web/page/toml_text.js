// The smallest replacements that change values of a TOML text: comments, spacing, order and the form of tables stay.
// @ts-check

import { TomlReading, isSame, keyOf, lineEnd, lineStart } from "./toml_reading.js";

/** @import { AST } from "../vendor/studio-vendor.js" */
/** @import { Path, Value } from "./toml_reading.js" */
/** @typedef {{ from: number, to: number, insert: string }} Replacement */
/**
 * A value to write, whose numbers have at most so many decimals. Where the table that it belongs to does not have it
 * yet, it goes behind the key `after`, or behind all others.
 * @typedef {{ path: Path, value: Value, decimals: number, after?: string }} Change
 */

/** Decimals of the numbers of a layer that is added. */
const DECIMALS = 3;

export class TomlText extends TomlReading {
  /**
   * The replacements that make these changes, in the order of the text.
   * @param {Change[]} changes
   * @returns {Replacement[]}
   */
  replacements(changes) {
    const found = changes.flatMap((change) => this.#replacement(change));
    return found.sort((a, b) => a.from - b.from);
  }

  /**
   * @param {Change} change
   * @returns {Replacement[]}
   */
  #replacement({ path, value, decimals, after }) {
    const node = this.nodes.get(keyOf(path));
    if (!node) return [this.#insertion(path, valueText(value, decimals), after)];
    const [from, to] = node.range;
    const before = this.text.slice(from, to);
    const insert = typeof value === "number" ? numberText(value, decimals, before) : valueText(value, decimals);
    return Number(insert) === Number(before) || insert === before ? [] : [{ from, to, insert }];
  }

  /**
   * @param {Path} path
   * @param {string} value
   * @param {string} [after]
   * @returns {Replacement}
   */
  #insertion(path, value, after) {
    const [table, key] = [path.slice(0, -1), String(path[path.length - 1])];
    const own = this.entries.filter((entry) => isSame(entry.path.slice(0, -1), table));
    const last = own.find((entry) => entry.path[entry.path.length - 1] === after) ?? own[own.length - 1];
    if (last) {
      const end = last.node.range[1];
      const [begin] = last.node.range;
      const { keys } = last.node.key;
      // What stands before the last part of a dotted key.
      const prefix = this.text.slice(begin, keys[keys.length - 1].range[0]);
      if (last.isInline) return { from: end, to: end, insert: `, ${prefix}${key} = ${value}` };
      const at = lineEnd(this.text, end);
      const indent = this.text.slice(lineStart(this.text, begin), begin);
      return { from: at, to: at, insert: `\n${indent}${prefix}${key} = ${value}` };
    }
    const inline = this.nodes.get(keyOf(table));
    if (inline) return { from: inline.range[0], to: inline.range[1], insert: `{ ${key} = ${value} }` };
    const header = this.tables.find(({ resolvedKey }) => isSame(resolvedKey, table));
    if (!header) throw new Error(`the text has no table ${table.join(".")}`);
    const at = lineEnd(this.text, header.key.range[1]);
    return { from: at, to: at, insert: `\n${key} = ${value}` };
  }

  /**
   * The replacements that take a layer out: each of its tables, with the comment right above it and the empty lines
   * behind it. Other tables between them stay.
   * @param {number} layer
   * @returns {Replacement[]}
   */
  removals(layer) {
    const { array } = this;
    if (array) return [elementRemoval(this.text, array, layer)];
    return this.#runs(layer).map(([from, to]) => this.#removal(from, to));
  }

  /**
   * Where the tables of a layer stand, each from its begin to its end.
   * @param {number} layer
   */
  #runs(layer) {
    /** @type {[number, number][]} */
    const runs = [];
    let wasOwn = false;
    for (const { resolvedKey, range } of this.tables) {
      const isOwn = resolvedKey[0] === "layer" && resolvedKey[1] === layer;
      if (isOwn && wasOwn) runs[runs.length - 1][1] = range[1];
      else if (isOwn) runs.push([range[0], range[1]]);
      wasOwn = isOwn;
    }
    return runs;
  }

  /** The layers, where they are written as one array. */
  get array() {
    const array = this.nodes.get("layer");
    return array?.type === "TOMLArray" ? array : undefined;
  }

  /**
   * The replacement that adds a layer behind all others.
   * @param {{ [field: string]: Value }} layer
   * @returns {Replacement}
   */
  addition(layer) {
    const { array } = this;
    if (array) {
      const last = array.elements[array.elements.length - 1];
      const at = last ? last.range[1] : array.range[0] + 1;
      return { from: at, to: at, insert: `${last ? ", " : ""}${valueText(layer, DECIMALS)}` };
    }
    const gap = this.text === "" || this.text.endsWith("\n\n") ? "" : this.text.endsWith("\n") ? "\n" : "\n\n";
    const at = this.text.length;
    return { from: at, to: at, insert: `${gap}${tableText(layer)}\n` };
  }

  /**
   * The replacement that puts a copy of a layer right behind it, without the comment above it.
   * @param {number} layer
   * @returns {Replacement}
   */
  copy(layer) {
    const { array } = this;
    if (array) {
      const [from, to] = array.elements[layer].range;
      return { from: to, to, insert: `, ${this.text.slice(from, to)}` };
    }
    const runs = this.#runs(layer).map(([from, to]) => [lineStart(this.text, from), lineEnd(this.text, to)]);
    const at = runs[runs.length - 1][1];
    return { from: at, to: at, insert: runs.map(([from, to]) => `\n\n${this.text.slice(from, to)}`).join("") };
  }

  /**
   * @param {number} from
   * @param {number} to
   * @returns {Replacement}
   */
  #removal(from, to) {
    let first = lineStart(this.text, from);
    while (first > 0 && this.#isComment(lineStart(this.text, first - 1))) first = lineStart(this.text, first - 1);
    // The head of the file stays.
    if (first === 0) first = lineStart(this.text, from);
    let last = this.#nextLine(to);
    let comments = last;
    while (this.#isComment(comments)) comments = this.#nextLine(comments);
    // A comment that stands right above the next table belongs to that one.
    if (!this.text.startsWith("[", comments)) last = comments;
    const rest = /^(?:[ \t]*\n)*/.exec(this.text.slice(last));
    last += rest?.[0].length ?? 0;
    const before = /\n[ \t\n]*$/.exec(this.text.slice(0, first));
    if (last >= this.text.length && before) first = before.index + 1;
    return { from: first, to: last, insert: "" };
  }

  /** @param {number} start */
  #isComment(start) {
    return this.comments.has(start) && this.text.slice(start).trimStart().startsWith("#");
  }

  /** @param {number} offset */
  #nextLine(offset) {
    return Math.min(lineEnd(this.text, offset) + 1, this.text.length);
  }
}

/**
 * @param {string} text
 * @param {AST.TOMLArray} array
 * @param {number} at
 * @returns {Replacement}
 */
function elementRemoval(text, { elements }, at) {
  const [from, to] = elements[at].range;
  if (at + 1 < elements.length) return { from, to: elements[at + 1].range[0], insert: "" };
  if (at === 0) return { from, to, insert: "" };
  const before = text.slice(elements[at - 1].range[1], from);
  if (!before.includes("#")) return { from: from - before.length, to, insert: "" };
  // The comment of the element before stays, and so does its comma: the own one goes.
  const indent = /\n?[ \t]*$/.exec(before)?.[0] ?? "";
  const behind = /^(?:(?:\s|#.*\n)*,)?(?:[ \t]*#.*)?/.exec(text.slice(to))?.[0] ?? "";
  const end = to + behind.length;
  // What is in the line of the element comes into that of the comment otherwise.
  return { from: from - indent.length, to: end, insert: text[end] === "\n" ? "" : "\n" };
}

/**
 * A text after replacements, which are in its order.
 * @param {string} text
 * @param {Replacement[]} replacements
 */
export function replaced(text, replacements) {
  let [made, from] = ["", 0];
  for (const each of replacements) {
    made += text.slice(from, each.from) + each.insert;
    from = each.to;
  }
  return made + text.slice(from);
}

/**
 * A number as a person writes it, with a point where the number before had one.
 * @param {number} value
 * @param {number} decimals At most.
 * @param {string} [before]
 */
export function numberText(value, decimals, before = "") {
  // TOML has words for these, but no scene may have them.
  if (!Number.isFinite(value)) throw new Error(`${value} is no number of a scene`);
  const text = String(Number(value.toFixed(decimals)));
  const written = text === "-0" ? "0" : text;
  return before.includes(".") && !written.includes(".") ? `${written}.0` : written;
}

/**
 * The lines of a layer table.
 * @param {{ [field: string]: Value }} layer
 */
export function tableText(layer) {
  const lines = Object.entries(layer).map(([field, value]) => `${field} = ${valueText(value, DECIMALS)}`);
  return ["[[layer]]", ...lines].join("\n");
}

/**
 * @param {Value} value
 * @param {number} decimals
 * @returns {string}
 */
export function valueText(value, decimals) {
  if (typeof value === "number") return numberText(value, decimals);
  // TOML takes no DEL as it is.
  if (typeof value !== "object") return JSON.stringify(value).replaceAll("\u007f", "\\u007f");
  if (Array.isArray(value)) return `[${value.map((each) => valueText(each, decimals)).join(", ")}]`;
  const words = Object.entries(value).map(([key, each]) => `${key} = ${valueText(each, decimals)}`);
  return `{ ${words.join(", ")} }`;
}
