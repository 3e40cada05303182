// What a layer of a kind must have, with values to begin with: completion of `kind` inserts it.
// @ts-check

/** @import { Table } from "./completion.js" */

/**
 * First values of fields, as TOML. The schema has no examples; what stands here is felt on the example screen.
 * @type {Record<string, string>}
 */
const FIRST_VALUES = {
  region: "{ x_mm = 40, y_mm = 25, width_mm = 40, height_mm = 30 }",
  picture: '"textures/wood.jpg"',
  x_mm: "60",
  y_mm: "40",
  width_mm: "4",
  rim_width_mm: "4",
  wavelength_mm: "10",
  wavelength_min_mm: "2",
  wavelength_max_mm: "6",
  number: "12",
  frequency_hz: "60",
  speeds_mm_per_s: "[20, 150]",
  factors: "[0.3, 1]",
  friction_fraction: "0.6",
  low_fraction: "0",
  high_fraction: "0.8",
  rim_fraction: "0.9",
  face_fraction: "0.4",
  ridge_fraction: "0.8",
  along_fraction: "0.2",
  against_fraction: "0.8",
};
/** A picture is placed by its corner, not by its middle. */
const OF_PICTURES = { x_mm: "20", y_mm: "10", width_mm: "60" };
/** Of fields that stand for each other, those that suit every finger and screen come first. */
const PREFERRED = ["_fraction", "_mm"];

/**
 * The lines that a table lacks, without its kind.
 * @param {Table} table An alternative of the schema.
 * @param {Record<string, string>} present What stands there already.
 */
export function missingLines(table, present) {
  const alternatives = (table.allOf ?? []).map(({ oneOf = [] }) => oneOf.flatMap(({ required = [] }) => required));
  const choices = alternatives.filter(({ length }) => length > 0);
  const lines = [];
  for (const choice of [...(table.required ?? []).map((name) => [name]), ...choices]) {
    if (choice.includes("kind") || choice.some((name) => name in present)) continue;
    const preferred = PREFERRED.flatMap((end) => choice.filter((name) => name.endsWith(end)));
    const name = preferred[0] ?? choice[0];
    lines.push(`${name} = ${firstValue(table, name)}`);
  }
  return lines;
}

/**
 * @param {Table} table
 * @param {string} name
 */
function firstValue({ properties }, name) {
  const values = "picture" in properties ? { ...FIRST_VALUES, ...OF_PICTURES } : FIRST_VALUES;
  const { enum: words = [], const: word = words[0], minimum = 0, maximum = 1 } = properties[name] ?? {};
  return values[name] ?? (word === undefined ? String(Math.max(minimum, Math.min(1, maximum))) : JSON.stringify(word));
}
