// What a scene of one's own, or a layer that is added to it, begins with.
// @ts-check

import { TomlText } from "./toml_text.js";

/** @import { Screen } from "../engine/types" */
/** @import { Box } from "./place.js" */
/** @import { Value } from "./toml_text.js" */
/**
 * A kind of layer to begin with: what a button calls it, what a finger meets, the layer as New opens it, on a screen of
 * 120 by 80 mm, and lengths that are shorter in a smaller box.
 * @typedef {{ name: string, words: string, layer: Fields, lengths?: string[] }} Beginning
 */
/** @typedef {{ [field: string]: Value }} Fields */

/** @type {Beginning[]} */
export const BEGINNINGS = [
  {
    name: "stripes",
    words: "Broad stripes across the screen: a finger that slides over them meets one ridge after another.",
    layer: { name: "stripes", kind: "grating", wave: "sine", wavelength_mm: 10, low_fraction: 0, high_fraction: 0.8 },
    lengths: ["wavelength_mm"],
  },
  {
    name: "button",
    words: "One button: a rim that holds the finger back, and a rougher face inside of it.",
    layer: {
      name: "button",
      kind: "button",
      region: { x_mm: 35, y_mm: 20, width_mm: 50, height_mm: 40 },
      rim_width_mm: 5,
      rim_fraction: 0.9,
      face_fraction: 0.35,
    },
    lengths: ["rim_width_mm"],
  },
  {
    name: "picture",
    words: "The grain of a photo of wood, rough where it is bright; or a picture of yours.",
    layer: {
      name: "wood",
      kind: "bitmap",
      picture: "textures/wood.jpg",
      levels: "stretch",
      x_mm: 15,
      y_mm: 10,
      width_mm: 90,
    },
  },
  {
    name: "noise",
    words: "An uneven ground like coarse sand: no two places of it are alike.",
    layer: {
      name: "sand",
      kind: "noise",
      wavelength_min_mm: 1.5,
      wavelength_max_mm: 3,
      low_fraction: 0,
      high_fraction: 0.9,
    },
    lengths: ["wavelength_min_mm", "wavelength_max_mm"],
  },
];

/** A layer that is added is so wide and high, as parts of the screen's width and height. */
const PART = { width: 0.25, height: 0.35 };
/** A picture that is added alone is so large. */
const PICTURE_PART = 0.75;
/** A length of a layer is at most this part of its box's shorter side. */
const LENGTH_PART = 0.25;
/** Sides of a layer that is added are multiples of this, mm. */
const GRID_MM = 0.5;
/** Room between a layer that is added and others, mm. */
const GAP_MM = 2;
/** Places that are tried for a layer along each side of the screen. */
const PLACES = 24;

/**
 * The text of a scene that has this layer alone.
 * @param {string} words What a finger meets, one sentence.
 * @param {Fields} layer
 */
export function sceneWith(words, layer) {
  return new TomlText(`# ${words}\nversion = 1\n`).withLayer(layer);
}

/**
 * The layer with which a beginning is added to a scene, where there is room.
 * @param {Beginning} beginning
 * @param {Screen} screen
 * @param {Box[]} taken Where other layers are.
 */
export function addedLayer({ layer: { name, kind, region: _, ...fields }, lengths = [] }, screen, taken) {
  const { x, y, width, height } = roomFor(screen.widthMm * PART.width, screen.heightMm * PART.height, screen, taken);
  const most = LENGTH_PART * Math.min(width, height);
  const part = Math.min(1, most / Math.max(...lengths.map((field) => Number(fields[field]))));
  const shorter = lengths.map((field) => [field, Number(fields[field]) * part]);
  const region = { x_mm: x, y_mm: y, width_mm: width, height_mm: height };
  // The region comes right behind the kind.
  return { name, kind, region, ...fields, ...Object.fromEntries(shorter) };
}

/**
 * A layer that shows a picture. It has no pitch: the compiler takes the finest that a board has room for, whatever
 * other pictures the scene has.
 * @param {string} picture Name of its file.
 * @param {number} aspect Its width over its height.
 * @param {Screen} screen
 * @param {Box[]} [taken] Where other layers are; without them, it lies in the middle, as large as fits.
 */
export function pictureLayer(picture, aspect, screen, taken) {
  const { widthMm, heightMm } = screen;
  const part = taken?.length ? PART : { width: PICTURE_PART, height: PICTURE_PART };
  const widest = Math.min(widthMm * part.width, heightMm * part.height * aspect);
  const { x, y, width } = roomFor(widest, widest / aspect, screen, taken ?? []);
  const name = picture.replace(/\.\w+$/, "");
  return { name, kind: "bitmap", picture, levels: "stretch", x_mm: x, y_mm: y, width_mm: width };
}

/**
 * A box of this size that covers as little as can be of what is there, as near to the middle as can be.
 * @param {number} widthMm
 * @param {number} heightMm
 * @param {Screen} screen
 * @param {Box[]} taken
 * @returns {Box}
 */
export function roomFor(widthMm, heightMm, screen, taken) {
  const [width, height] = [widthMm, heightMm].map((mm) => Math.max(GRID_MM, roundedDown(mm)));
  const room = { x: screen.widthMm - width, y: screen.heightMm - height };
  const steps = Array.from({ length: PLACES + 1 }, (_, step) => step / PLACES);
  let best = { x: 0, y: 0, width, height };
  let least = Infinity;
  for (const down of steps) {
    for (const across of steps) {
      const box = { x: roundedDown(room.x * across), y: roundedDown(room.y * down), width, height };
      const covered = taken.reduce((sum, other) => sum + overlap(wider(box, GAP_MM), other), 0);
      // Of places that cover the same, the middle one; a covered square millimetre counts for more than any way.
      const cost = covered * 1000 + Math.hypot(across - 0.5, down - 0.5);
      if (cost < least) [best, least] = [box, cost];
    }
  }
  return best;
}

/** @param {number} mm */
function roundedDown(mm) {
  return Math.floor(mm / GRID_MM) * GRID_MM;
}

/**
 * @param {Box} box
 * @param {number} by
 * @returns {Box}
 */
function wider({ x, y, width, height }, by) {
  return { x: x - by, y: y - by, width: width + 2 * by, height: height + 2 * by };
}

/**
 * The area that two boxes share.
 * @param {Box} one
 * @param {Box} other
 */
function overlap(one, other) {
  const width = Math.min(one.x + one.width, other.x + other.width) - Math.max(one.x, other.x);
  const height = Math.min(one.y + one.height, other.y + other.height) - Math.max(one.y, other.y);
  return Math.max(0, width) * Math.max(0, height);
}

/**
 * A name that no other layer has: the same with a number.
 * @param {string} name
 * @param {string[]} taken
 */
export function freeLayerName(name, taken) {
  const base = name.replace(/ \d+$/, "");
  let free = name;
  for (let number = 2; taken.includes(free); number += 1) free = `${base} ${number}`;
  return free;
}
