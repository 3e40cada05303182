// Completion of scene texts from the JSON schema of scenes.
// @ts-check

import { missingLines } from "./needs.js";

/** @import { Completion, CompletionContext, CompletionResult, Text } from "../vendor/studio-vendor.js" */

/**
 * What the completion reads of a JSON schema.
 * @typedef {object} Schema
 * @property {string} [$ref]
 * @property {string} [type]
 * @property {string} [description]
 * @property {number} [minimum]
 * @property {number} [maximum]
 * @property {unknown[]} [enum]
 * @property {unknown} [const]
 * @property {Schema} [items]
 * @property {Schema[]} [oneOf]
 * @property {Schema[]} [anyOf]
 * @property {Schema[]} [allOf]
 * @property {string[]} [required]
 * @property {Record<string, Schema>} [properties]
 */
/** @typedef {Schema & { properties: Record<string, Schema> }} Table */
/** @typedef {Schema & { words: unknown[], schemas: Schema[] }} Field A field, as all alternatives have it. */
/** @typedef {{ doc: Text, line: number, before: string }} Place The cursor's line, and what stands in it before it. */

/**
 * A CodeMirror completion source for this schema.
 * @param {Schema} schema
 * @returns {(context: CompletionContext) => CompletionResult | null}
 */
export function completeFrom(schema) {
  return (context) => {
    const line = context.state.doc.lineAt(context.pos);
    const before = line.text.slice(0, context.pos - line.from);
    if (/^[^"]*#/.test(before)) return null;
    const place = { doc: context.state.doc, line: line.number, before };
    const value = /([A-Za-z_]+)\s*=\s*("?)([\w-]*)$/.exec(before);
    const word = /[\w-]*$/.exec(before)?.[0] ?? "";
    if (value)
      return found(context.pos - value[3].length - value[2].length, values(schema, place, value[1]));
    const header = /^\s*\[{1,2}(\w*)$/.exec(before);
    if (header) return found(context.pos - header[0].trimStart().length, headers(schema));
    if (!context.explicit && word === "") return null;
    const isKey = /^\s*[\w-]*$/.test(before) || /[{,]\s*[\w-]*$/.test(before);
    return isKey ? found(context.pos - word.length, keys(schema, place)) : null;
  };
}

/**
 * @param {number} from
 * @param {Completion[]} options
 */
function found(from, options) {
  return options.length > 0 ? { from, options, validFor: /^[["\w-]*$/ } : null;
}

/**
 * @param {Schema} schema
 * @returns {Completion[]}
 */
function headers(schema) {
  const properties = propertiesOf(schema);
  return Object.entries(properties)
    .filter(([, property]) => kindOf(schema, property) !== "plain")
    .map(([name, property]) => (kindOf(schema, property) === "array" ? `[[${name}]]` : `[${name}]`))
    .map((label) => ({ label, type: "namespace" }));
}

/**
 * @param {Schema} schema
 * @param {Place} place
 * @returns {Completion[]}
 */
function keys(schema, place) {
  const { properties, present } = tableAt(schema, place);
  return Object.entries(properties)
    .filter(([name]) => !(name in present))
    .map(([name, { description, minimum, maximum }]) => ({
      label: name,
      apply: `${name} = `,
      type: "property",
      // What a layer is comes before what it has.
      boost: name === "kind" ? 99 : 0,
      detail: minimum === undefined ? "" : `${minimum} to ${maximum}`,
      info: description,
    }));
}

/**
 * @param {Schema} schema
 * @param {Place} place
 * @param {string} name
 * @returns {Completion[]}
 */
function values(schema, place, name) {
  const { all, outer, present } = tableAt(schema, place);
  const property = all[name];
  if (!property) return [];
  if (property.type === "boolean") return ["true", "false"].map((label) => ({ label, type: "keyword" }));
  return property.words.map((word) => ({
    label: JSON.stringify(word),
    type: "enum",
    ...(name === "kind" && withNeeds(schema, outer, { ...present, kind: String(word) })),
  }));
}

/**
 * How the completion of a kind is applied: with what a layer of it needs and does not have.
 * @param {Schema} schema
 * @param {Schema[]} alternatives
 * @param {Record<string, string>} present
 * @returns {Partial<Completion>}
 */
function withNeeds(schema, alternatives, present) {
  const table = fitting(schema, alternatives, present).find(({ required }) => required?.includes("kind"));
  const lines = table ? missingLines(table, present) : [];
  if (lines.length === 0) return {};
  return {
    detail: `with ${lines.map((line) => line.split(" ")[0]).join(", ")}`,
    apply: (view, { label }, from, to) => {
      // The quotation mark that the editor has closed by itself is that of the label.
      const end = view.state.sliceDoc(to, to + 1) === '"' ? to + 1 : to;
      const insert = [label, ...lines].join("\n");
      view.dispatch({
        changes: { from, to: end, insert },
        selection: { anchor: from + insert.length },
        userEvent: "input.complete",
      });
    },
  };
}

/**
 * The table that the cursor is in: fields that fit to what stands in it, all its fields, its alternatives, and what
 * stands in it.
 * @param {Schema} schema
 * @param {Place} place
 */
function tableAt(schema, { doc, line, before }) {
  const block = blockAt(doc, line);
  const root = propertiesOf(schema);
  const outer = block.header ? (root[block.header]?.schemas ?? []) : [schema];
  const inline = /(\w+)\s*=\s*\{[^}]*$/.exec(before);
  const alternatives = inline ? (merged(schema, outer, {})[inline[1]]?.schemas ?? []) : outer;
  const present = pairs(inline ? before.slice(inline.index + inline[1].length).replace(/^\s*=\s*\{/, "") : block.text);
  const [properties, all] = [merged(schema, alternatives, present), merged(schema, alternatives, {})];
  return { properties, all, outer: inline ? [] : outer, present };
}

/**
 * The lines from the header above a line to the next header.
 * @param {Text} doc
 * @param {number} number
 */
function blockAt(doc, number) {
  const isHeader = (/** @type {number} */ at) => /^\s*\[{1,2}(\w+)\]/.exec(doc.line(at).text);
  let first = number;
  while (first > 1 && !isHeader(first)) first -= 1;
  let last = number;
  while (last < doc.lines && !isHeader(last + 1)) last += 1;
  const lines = [];
  for (let at = first; at <= last; at += 1) if (at !== number) lines.push(doc.line(at).text);
  return { header: isHeader(first)?.[1], text: lines.join("\n") };
}

/**
 * Fields and their values in a text, strings without quotation marks.
 * @param {string} text
 * @returns {Record<string, string>}
 */
function pairs(text) {
  const found = [...text.matchAll(/(?:^|[,\n])\s*(\w+)\s*=\s*("[^"]*"|[^,\n}]*)/g)];
  return Object.fromEntries(found.map(([, name, value]) => [name, value.replace(/^"|"$/g, "").trim()]));
}

/** @param {Schema} schema */
function propertiesOf(schema) {
  return merged(schema, [schema], {});
}

/**
 * @param {Schema} root
 * @param {Schema} schema
 * @returns {Schema}
 */
function resolve(root, schema) {
  if (!schema.$ref) return schema;
  let at = /** @type {Record<string, any>} */ (root);
  for (const name of schema.$ref.split("/").slice(1)) at = at[name];
  return at;
}

/**
 * All alternatives of a schema that are tables; of an array, those of its items.
 * @param {Schema} root
 * @param {Schema} schema
 * @returns {Table[]}
 */
function tables(root, schema) {
  const at = resolve(root, schema);
  if (at.items) return tables(root, at.items);
  const choices = [...(at.oneOf ?? []), ...(at.anyOf ?? [])];
  if (choices.length > 0) return choices.flatMap((choice) => tables(root, choice));
  return at.properties ? [/** @type {Table} */ (at)] : [];
}

/**
 * @param {Schema} property
 * @returns {unknown[]}
 */
function wordsOf(property) {
  return property.enum ?? (property.const === undefined ? [] : [property.const]);
}

/**
 * The alternatives that do not contradict what stands there.
 * @param {Schema} root
 * @param {Schema[]} schemas
 * @param {Record<string, string>} present
 */
function fitting(root, schemas, present) {
  const fits = (/** @type {Table} */ table) =>
    Object.entries(present).every(([name, value]) => {
      const words = wordsOf(resolve(root, table.properties[name] ?? {})).map(String);
      return words.length === 0 || words.includes(value);
    });
  return schemas.flatMap((schema) => tables(root, schema)).filter(fits);
}

/**
 * Fields of the alternatives that do not contradict what stands there.
 * @param {Schema} root
 * @param {Schema[]} schemas
 * @param {Record<string, string>} present
 */
function merged(root, schemas, present) {
  /** @type {Record<string, Field>} */
  const fields = {};
  for (const table of fitting(root, schemas, present)) {
    for (const [name, raw] of Object.entries(table.properties)) {
      const property = resolve(root, raw);
      fields[name] ??= { ...property, description: raw.description ?? property.description, words: [], schemas: [] };
      fields[name].schemas.push(raw);
      for (const word of wordsOf(property)) if (!fields[name].words.includes(word)) fields[name].words.push(word);
    }
  }
  return fields;
}

/**
 * @param {Schema} root
 * @param {Field} field
 */
function kindOf(root, { schemas }) {
  if (schemas.some((schema) => resolve(root, schema).items)) return "array";
  return schemas.some((schema) => tables(root, schema).length > 0) ? "table" : "plain";
}

/**
 * The fields that a layer with these words may have.
 * @param {Schema} schema
 * @param {Record<string, string>} words
 */
export function layerFields(schema, words) {
  const { layer } = propertiesOf(schema);
  return merged(schema, layer.schemas, words);
}
