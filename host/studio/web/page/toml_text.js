// Where the values of a TOML text stand, and the smallest replacements that change some of them: comments, spacing,
// order and the form of every table stay.
// @ts-check

import { parseTOML } from "../vendor/studio-vendor.js";

/** @import { AST } from "../vendor/studio-vendor.js" */
/** @typedef {(string | number)[]} Path Keys, and numbers of an array's elements. */
/** @typedef {{ from: number, to: number, insert: string }} Replacement */
/** @typedef {number | string | boolean | Value[] | { [key: string]: Value }} Value */
/**
 * A value to write, whose numbers have at most so many decimals. Where the table that it belongs to does not have it
 * yet, it goes behind the key `after`, or behind all others.
 * @typedef {{ path: Path, value: Value, decimals: number, after?: string }} Change
 */
/** @typedef {{ path: Path, node: AST.TOMLKeyValue, isInline: boolean }} Entry */

export class TomlText {
  #text;
  /**
   * Lines in which the layer tables begin, once they were asked for: each layer of a scene asks.
   * @type {number[] | undefined}
   */
  #linesOfLayers;
  #comments;
  /** @type {{ [key: string]: Value }} */
  #root = {};
  /**
   * The values, inline tables included.
   * @type {Map<string, AST.TOMLContentNode>}
   */
  #nodes = new Map();
  /**
   * Tables with a header.
   * @type {AST.TOMLTable[]}
   */
  #tables = [];
  /** @type {Entry[]} */
  #entries = [];

  /**
   * Throws where the text is no TOML.
   * @param {string} text
   */
  constructor(text) {
    const program = parseTOML(text);
    this.#text = text;
    this.#comments = new Set(program.comments.map(({ range }) => lineStart(text, range[0])));
    const [{ body }] = program.body;
    for (const node of body) {
      if (node.type === "TOMLKeyValue") this.#readEntry(node, [], false);
      else {
        this.#tables.push(node);
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
    this.#entries.push({ path, node, isInline });
    this.#readValue(node.value, path);
  }

  /**
   * @param {AST.TOMLContentNode} node
   * @param {Path} path
   */
  #readValue(node, path) {
    this.#nodes.set(keyOf(path), node);
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
      const [begin] = this.#rangeOf(["layer", at]);
      line += this.#text.slice(from, begin).split("\n").length - 1;
      from = Math.max(from, begin);
      return line;
    });
  }

  /**
   * First and last line of a layer table.
   * @param {number} at
   */
  layerLines(at) {
    const [from, to] = this.#rangeOf(["layer", at]);
    return [lineOf(this.#text, from), lineOf(this.#text, to)];
  }

  /**
   * From the begin of a table to the end of the last value in it.
   * @param {Path} path
   * @returns {[number, number]}
   */
  #rangeOf(path) {
    const inline = this.#nodes.get(keyOf(path));
    if (inline) return inline.range;
    const own = this.#tables.filter(({ resolvedKey }) => path.every((key, depth) => resolvedKey[depth] === key));
    return [Math.min(...own.map(({ range }) => range[0])), Math.max(...own.map(({ range }) => range[1]))];
  }

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
    const node = this.#nodes.get(keyOf(path));
    if (!node) return [this.#insertion(path, wordsOf(value, decimals), after)];
    const [from, to] = node.range;
    const before = this.#text.slice(from, to);
    const insert = typeof value === "number" ? numberText(value, decimals, before) : wordsOf(value, decimals);
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
    const own = this.#entries.filter((entry) => isSame(entry.path.slice(0, -1), table));
    const last = own.find((entry) => entry.path[entry.path.length - 1] === after) ?? own[own.length - 1];
    if (last) {
      const end = last.node.range[1];
      const [begin] = last.node.range;
      const { keys } = last.node.key;
      // What stands before the last part of a dotted key.
      const prefix = this.#text.slice(begin, keys[keys.length - 1].range[0]);
      if (last.isInline) return { from: end, to: end, insert: `, ${prefix}${key} = ${value}` };
      const at = lineEnd(this.#text, end);
      const indent = this.#text.slice(lineStart(this.#text, begin), begin);
      return { from: at, to: at, insert: `\n${indent}${prefix}${key} = ${value}` };
    }
    const inline = this.#nodes.get(keyOf(table));
    if (inline) return { from: inline.range[0], to: inline.range[1], insert: `{ ${key} = ${value} }` };
    const header = this.#tables.find(({ resolvedKey }) => isSame(resolvedKey, table));
    if (!header) throw new Error(`the text has no table ${table.join(".")}`);
    const at = lineEnd(this.#text, header.key.range[1]);
    return { from: at, to: at, insert: `\n${key} = ${value}` };
  }

  /**
   * The replacements that take a layer out: each of its tables, with the comment right above it and the empty lines
   * behind it. Other tables between them stay.
   * @param {number} layer
   * @returns {Replacement[]}
   */
  removals(layer) {
    const array = this.#nodes.get("layer");
    if (array?.type === "TOMLArray") return [elementRemoval(this.#text, array, layer)];
    /** @type {[number, number][]} */
    const runs = [];
    let wasOwn = false;
    for (const { resolvedKey, range } of this.#tables) {
      const isOwn = resolvedKey[0] === "layer" && resolvedKey[1] === layer;
      if (isOwn && wasOwn) runs[runs.length - 1][1] = range[1];
      else if (isOwn) runs.push([range[0], range[1]]);
      wasOwn = isOwn;
    }
    return runs.map(([from, to]) => this.#removal(from, to));
  }

  /**
   * @param {number} from
   * @param {number} to
   * @returns {Replacement}
   */
  #removal(from, to) {
    let first = lineStart(this.#text, from);
    while (first > 0 && this.#isComment(lineStart(this.#text, first - 1))) first = lineStart(this.#text, first - 1);
    // The head of the file stays.
    if (first === 0) first = lineStart(this.#text, from);
    let last = this.#nextLine(to);
    let comments = last;
    while (this.#isComment(comments)) comments = this.#nextLine(comments);
    // A comment that stands right above the next table belongs to that one.
    if (!this.#text.startsWith("[", comments)) last = comments;
    const rest = /^(?:[ \t]*\n)*/.exec(this.#text.slice(last));
    last += rest?.[0].length ?? 0;
    const before = /\n[ \t\n]*$/.exec(this.#text.slice(0, first));
    if (last >= this.#text.length && before) first = before.index + 1;
    return { from: first, to: last, insert: "" };
  }

  /** @param {number} start */
  #isComment(start) {
    return this.#comments.has(start) && this.#text.slice(start).trimStart().startsWith("#");
  }

  /** @param {number} offset */
  #nextLine(offset) {
    return Math.min(lineEnd(this.#text, offset) + 1, this.#text.length);
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
 * @param {Value} value
 * @param {number} decimals
 * @returns {string}
 */
function wordsOf(value, decimals) {
  if (typeof value === "number") return numberText(value, decimals);
  if (typeof value !== "object") return JSON.stringify(value);
  if (Array.isArray(value)) return `[${value.map((each) => wordsOf(each, decimals)).join(", ")}]`;
  const words = Object.entries(value).map(([key, each]) => `${key} = ${wordsOf(each, decimals)}`);
  return `{ ${words.join(", ")} }`;
}

/** @param {Path} path */
function keyOf(path) {
  return path.join("\n");
}

/**
 * @param {Path} path
 * @param {Path} other
 */
function isSame(path, other) {
  return path.length === other.length && path.every((key, at) => key === other[at]);
}

/**
 * @param {string} text
 * @param {number} offset
 */
function lineStart(text, offset) {
  return offset === 0 ? 0 : text.lastIndexOf("\n", offset - 1) + 1;
}

/**
 * @param {string} text
 * @param {number} offset
 */
function lineEnd(text, offset) {
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
