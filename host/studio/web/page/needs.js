// What a layer of a kind must have, with values to begin with: completion of `kind` inserts it.
// @ts-check

import { firstValues } from "./toml_text.js";

/** @import { Table } from "./completion.js" */

/**
 * The lines that a table lacks, without its kind.
 * @param {Table} table An alternative of the schema.
 * @param {Record<string, string>} present What stands there already, its kind among it.
 */
export function missingLines(table, present) {
  const values = firstValues()[present.kind] ?? {};
  const alternatives = (table.allOf ?? []).map(({ oneOf = [] }) => oneOf.flatMap(({ required = [] }) => required));
  const choices = alternatives.filter(({ length }) => length > 0);
  const lines = [];
  for (const choice of [...(table.required ?? []).map((name) => [name]), ...choices]) {
    if (choice.includes("kind") || choice.some((name) => name in present)) continue;
    // Of fields that stand for each other, the one that a new layer has.
    const name = choice.find((each) => each in values) ?? choice[0];
    lines.push(`${name} = ${values[name] ?? possibleValue(table, name)}`);
  }
  return lines;
}

/**
 * A value that the schema allows, for what only other words in the layer ask for.
 * @param {Table} table
 * @param {string} name
 */
function possibleValue({ properties }, name) {
  const { enum: words = [], const: word = words[0], minimum = 0, maximum = 1 } = properties[name] ?? {};
  return word === undefined ? String(Math.max(minimum, Math.min(1, maximum))) : JSON.stringify(word);
}
