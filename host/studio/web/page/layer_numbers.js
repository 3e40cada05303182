// The numbers of a layer that a hand tunes: which they are, what they are called, and how far a slider goes.
// @ts-check

import { layerFields } from "./completion.js";

/** @import { Reach, Screen } from "../engine/types" */
/** @import { Schema } from "./completion.js" */
/** @import { EditedLayer } from "./edited_layers.js" */
/** @import { Fields, Path, TomlText } from "./toml_text.js" */
/** @typedef {Reach & { reachN: number }} Most Of the scene's check. */
/**
 * A number of a layer, and what it means in a few words. `least` and `most` are the ends of a slider, `min` and
 * `max` what a scene may have.
 * @typedef {{ field: string, label: string, words: string, unit: string, value: number, path: Path, decimals: number,
 *   step: number, least: number, most: number, min: number, max: number }} LayerNumber
 */
/**
 * A word of a layer that is chosen, and the words that it may be.
 * @typedef {{ field: string, label: string, words: string, value: string, path: Path, options: string[],
 *   decimals: 0 }} LayerChoice
 */
/** @typedef {LayerNumber | LayerChoice} Tuned */

/** What a place is made of, which a hand drags. */
const PLACE = ["x", "y", "height"];
/** Fields that count without being written, with their defaults. @type {Fields} */
const DEFAULTS = { angle_deg: 0, gain: 1 };
/** Labels of fields whose names alone would be those of others. @type {Record<string, string>} */
const LABELS = { click_ms: "click time", width_mm: "line width" };
/** What numbers mean, by their labels. @type {Record<string, string>} */
const NUMBER_MEANINGS = {
  along: "friction along its direction",
  against: "friction against it",
  angle: "turn of the pattern",
  black: "friction where it is black",
  click: "friction of the click",
  "click time": "how long the click lasts",
  duty: "part of a wave that is high",
  face: "friction inside the rim",
  friction: "friction all over it",
  gain: "all of its friction, times this",
  high: "most friction",
  "line width": "how wide the line is",
  low: "least friction",
  number: "how many around",
  ridge: "friction on the line",
  rim: "friction at the border",
  "rim width": "how wide the border is",
  seed: "another number, another pattern",
  wavelength: "from one ridge to the next",
  "wavelength max": "coarsest grain",
  "wavelength min": "finest grain",
  white: "friction where it is white",
};
/** @type {["columns" | "rows", string, "x" | "y", "width" | "height", string][]} */
const REPEATS = [
  ["columns", "dx_mm", "x", "width", "copies side by side"],
  ["rows", "dy_mm", "y", "height", "copies below one another"],
];
const COPIES_MAX = 64;
/** A copy that ends at the screen's border fits in spite of its rounding. */
const CLOSE = 1e-6;
/** Ends of sliders, times a power of ten. */
const ROUND = [1, 2, 5, 10];
/** Ends of sliders that no value moves, by field or unit. @type {Record<string, [number, number]>} */
const FIXED_ENDS = { duty: [0, 1], "°": [-180, 180], "mm/s": [-100, 100] };
/** Usual ends of others: the right one moves for a value beyond it. @type {Record<string, [number, number]>} */
const USUAL_ENDS = { gain: [0, 2], "×": [0, 2], mm: [0.5, 20], Hz: [1, 300], ms: [1, 100], "": [0, 40] };
/** @type {[ending: string, unit: string, decimals: number, step: number][]} */
const UNITS = [
  ["_mm_per_s", "mm/s", 1, 1],
  ["_mm", "mm", 2, 0.1],
  ["_n", "N", 4, 0.001],
  ["_fraction", "of reach", 3, 0.01],
  ["_factor", "×", 3, 0.01],
  ["_deg", "°", 1, 1],
  ["_hz", "Hz", 1, 1],
  ["_ms", "ms", 1, 1],
];

/**
 * The numbers of a layer of the file: those that it has, in the order of the text, and those of use that it may have.
 * @param {Schema} schema
 * @param {TomlText} toml
 * @param {number} at Number of the layer among those of the file.
 * @param {string} kind
 * @param {Most} reach
 * @returns {LayerNumber[]}
 */
export function layerNumbers(schema, toml, at, kind, reach) {
  const own = { ...DEFAULTS, ...toml.fields(at) };
  const { blend, above } = own;
  const fields = layerFields(schema, { kind, ...(typeof blend === "string" ? { blend } : {}) });
  const isPlate = kind === "constant" && (blend ?? "replace") === "replace";
  const isTotal = above === "zero" || (isPlate && above !== "natural");
  // Fields that count unwritten stay last when a hand writes them: no row moves.
  const usual = Object.keys(own).filter((field) => !(field in DEFAULTS));
  const names = [...usual, ...Object.keys(DEFAULTS)].filter((field) => field in fields);
  return names.flatMap((field) => {
    const about = fields[field];
    const [ending, unit, decimals, step] = UNITS.find(([each]) => field.endsWith(each)) ?? ["", "", 2, 0.01];
    const label = field.slice(0, field.length - ending.length);
    const isPlace = PLACE.includes(label) || field.endsWith("_px") || (kind === "bitmap" && label === "width");
    const value = own[field];
    const isNumber = about.type === "number" || about.type === "integer";
    if (typeof value !== "number" || !Number.isFinite(value) || isPlace || !isNumber) return [];
    const isWhole = about.type === "integer" || field === "number" || field === "seed";
    const { minimum: min = -1e6, maximum: max = 1e6 } = about;
    // A click counts from what it is added to.
    const [least, most] = ends(field, unit, value, isTotal && !field.startsWith("click"), reach);
    const name = LABELS[field] ?? label.replaceAll("_", " ");
    return {
      field,
      label: name,
      words: NUMBER_MEANINGS[name] ?? "",
      unit: field === "gain" ? "×" : unit,
      value,
      path: ["layer", at, field],
      decimals: isWhole ? 0 : decimals,
      step: isWhole ? 1 : step,
      least: Math.max(min, Math.min(least, value)),
      most: Math.min(max, Math.max(most, value)),
      min,
      max,
    };
  });
}

/**
 * The shape of a layer's wave, where it has one.
 * @param {Schema} schema
 * @param {TomlText} toml
 * @param {number} at Number of the layer among those of the file.
 * @param {string} kind
 * @returns {LayerChoice[]}
 */
export function layerChoices(schema, toml, at, kind) {
  const { wave } = layerFields(schema, { kind });
  if (!wave) return [];
  const options = wave.words.map(String);
  const value = String(toml.fields(at).wave ?? options[0]);
  const path = ["layer", at, "wave"];
  return [{ field: "wave", label: "wave", words: "shape of the pattern", value, path, options, decimals: 0 }];
}

/**
 * How many copies a layer has side by side and below one another, as far as the screen has room for more.
 * @param {EditedLayer} edited
 * @param {Screen} screen
 * @returns {LayerNumber[]}
 */
export function repeatNumbers({ toml, at, place: { box } }, screen) {
  if (at === undefined) return [];
  return REPEATS.flatMap(([name, step, side, along, words]) => {
    const path = ["layer", at, "repeat", name];
    const [value, stepMm] = [toml?.value(path), toml?.value(["layer", at, "repeat", step])];
    if (typeof value !== "number" || typeof stepMm !== "number" || stepMm === 0) return [];
    const room = stepMm > 0 ? screen[`${along}Mm`] - box[side] - box[along] : box[side];
    const most = Math.max(value, 1, Math.min(COPIES_MAX, 1 + Math.floor(room / Math.abs(stepMm) + CLOSE)));
    const whole = { decimals: 0, step: 1, least: 1, most, min: 1, max: COPIES_MAX };
    return [{ field: `repeat.${name}`, label: name, words, unit: "", value, path, ...whole }];
  });
}

/**
 * The ends of a slider: what is used every day, and no more friction than the drive can add.
 * @param {string} field
 * @param {string} unit
 * @param {number} value
 * @param {boolean} isTotal Whether newtons count from zero, not from natural friction.
 * @param {Most} reach
 * @returns {[number, number]}
 */
function ends(field, unit, value, isTotal, { naturalN, reachN }) {
  if (unit === "N") return isTotal ? [naturalN, reachN] : [value < 0 ? naturalN - reachN : 0, reachN - naturalN];
  if (unit === "of reach") return [value < 0 ? -1 : 0, 1];
  const fixed = FIXED_ENDS[field] ?? FIXED_ENDS[unit];
  if (fixed) return fixed;
  const [least, usual] = USUAL_ENDS[field] ?? USUAL_ENDS[unit];
  return [least, roundAbove(usual, value)];
}

/**
 * The end of a slider, which stays while a hand moves a value within it: the usual one, or a round number above.
 * @param {number} usual
 * @param {number} value
 */
function roundAbove(usual, value) {
  const size = Math.abs(value);
  if (size <= usual) return usual;
  const power = 10 ** Math.floor(Math.log10(size));
  return power * (ROUND.find((each) => each * power > size) ?? 10);
}
