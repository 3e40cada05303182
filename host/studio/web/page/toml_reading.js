// Where the values of a TOML text stand.
// @ts-check

import { parseTOML } from "../vendor/studio-vendor.js";

/** @import { AST } from "../vendor/studio-vendor.js" */
/** @typedef {(string | number)[]} Path Keys, and numbers of an array's elements. */
/** @typedef {number | string | boolean | Value[] | { [key: string]: Value }} Value */
/** @typedef {{ path: Path, node: AST.TOMLKeyValue, isInline: boolean }} Entry */

export class TomlReading {
  text;
  /**
   * Lines in which the layer tables begin, once they were asked for: each layer of a scene asks.
   * @type {number[] | undefined}
   */
  #linesOfLayers;
  comments;
  /** @type {{ [key: string]: Value }} */
  #root = {};
  /**
   * The values, inline tables included.
   * @type {Map<string, AST.TOMLContentNode>}
   */
  nodes = new Map();
  /**
   * Tables with a header.
   * @type {AST.TOMLTable[]}
   */
  tables = [];
  /** @type {Entry[]} */
  entries = [];

  /**
   * Throws where the text is no TOML.
   * @param {string} text
   */
  constructor(text) {
    const program = parseTOML(text);
    this.text = text;
    this.comments = new Set(program.comments.map(({ range }) => lineStart(text, range[0])));
    const [{ body }] = program.body;
    for (const node of body) {
      if (node.type === "TOMLKeyValue") this.#readEntry(node, [], false);
      else {
        this.tables.push(node);
        this.#put(node.resolvedKey, {});
        for (const entry of node.body) this.#readEntry(entry, node.resolvedKey, false);
      }
    }
  }

  /**
   * @param {AST.TOMLKeyValue} node
   * @param {Path} table
   * @param {boolean} isInline
   */
  #readEntry(node, table, isInline) {
    const path = [...table, ...node.key.keys.map((key) => (key.type === "TOMLBare" ? key.name : key.value))];
    this.entries.push({ path, node, isInline });
    this.#readValue(node.value, path);
  }

  /**
   * @param {AST.TOMLContentNode} node
   * @param {Path} path
   */
  #readValue(node, path) {
    this.nodes.set(keyOf(path), node);
    if (node.type === "TOMLValue") this.#put(path, /** @type {Value} */ (node.value));
    else if (node.type === "TOMLArray") {
      this.#put(path, []);
      for (const [at, element] of node.elements.entries()) this.#readValue(element, [...path, at]);
    } else {
      this.#put(path, {});
      for (const entry of node.body) this.#readEntry(entry, path, true);
    }
  }

  /**
   * @param {Path} path
   * @param {Value} value
   */
  #put(path, value) {
    let at = /** @type {any} */ (this.#root);
    for (const [depth, key] of path.slice(0, -1).entries()) {
      at[key] ??= typeof path[depth + 1] === "number" ? [] : {};
      at = at[key];
    }
    const last = path[path.length - 1];
    // A sub-table may come before the header of its table.
    if (!(typeof value === "object" && !Array.isArray(value) && last in at)) at[last] = value;
  }

  /**
   * The value at a path, or undefined.
   * @param {Path} path
   * @returns {Value | undefined}
   */
  value(path) {
    let at = /** @type {any} */ (this.#root);
    for (const key of path) {
      if (typeof at !== "object" || !Object.hasOwn(at, key)) return undefined;
      at = at[key];
    }
    return at;
  }

  /**
   * Number of the layer table that begins in a line, among those of the text, if it is the only one there.
   * @param {number} line From 1.
   */
  layerAt(line) {
    this.#linesOfLayers ??= this.#firstLines();
    const lines = this.#linesOfLayers;
    const found = lines.indexOf(line);
    return found < 0 || lines.indexOf(line, found + 1) >= 0 ? undefined : found;
  }

  /** The lines in which the layer tables begin. */
  #firstLines() {
    const layers = this.value(["layer"]);
    if (!Array.isArray(layers)) return [];
    let [line, from] = [1, 0];
    // In the order of the text, each line is counted once.
    return layers.map((_, at) => {
      const [begin] = this.rangeOf(["layer", at]);
      line += this.text.slice(from, begin).split("\n").length - 1;
      from = Math.max(from, begin);
      return line;
    });
  }

  /**
   * First and last line of a layer table.
   * @param {number} at
   */
  layerLines(at) {
    const [from, to] = this.rangeOf(["layer", at]);
    return [lineOf(this.text, from), lineOf(this.text, to)];
  }

  /**
   * From the begin of a table to the end of the last value in it.
   * @param {Path} path
   * @returns {[number, number]}
   */
  rangeOf(path) {
    const inline = this.nodes.get(keyOf(path));
    if (inline) return inline.range;
    const own = this.tables.filter(({ resolvedKey }) => path.every((key, depth) => resolvedKey[depth] === key));
    return [Math.min(...own.map(({ range }) => range[0])), Math.max(...own.map(({ range }) => range[1]))];
  }
}

/** @param {Path} path */
export function keyOf(path) {
  return path.join("\n");
}

/**
 * @param {Path} path
 * @param {Path} other
 */
export function isSame(path, other) {
  return path.length === other.length && path.every((key, at) => key === other[at]);
}

/**
 * @param {string} text
 * @param {number} offset
 */
export function lineStart(text, offset) {
  return offset === 0 ? 0 : text.lastIndexOf("\n", offset - 1) + 1;
}

/**
 * @param {string} text
 * @param {number} offset
 */
export function lineEnd(text, offset) {
  const end = text.indexOf("\n", offset);
  return end < 0 ? text.length : end;
}

/**
 * @param {string} text
 * @param {number} offset
 */
function lineOf(text, offset) {
  return text.slice(0, offset).split("\n").length;
}
