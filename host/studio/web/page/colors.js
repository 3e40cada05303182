// The colour scale of friction: viridis, even in lightness and told apart by all common kinds of colour vision.
// @ts-check

/** @import { FrictionField } from "../engine/types" */

const STOPS = [
  "#440154",
  "#482878",
  "#3e4989",
  "#31688e",
  "#26828e",
  "#1f9e89",
  "#35b779",
  "#6ece58",
  "#b5de2b",
  "#fde725",
].map((hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)));

/** 256 colours, three bytes each, from the least to the largest friction. */
export const SCALE = new Uint8Array(256 * 3);
for (let at = 0; at < 256; at += 1) {
  const place = (at / 255) * (STOPS.length - 1);
  const low = Math.min(Math.floor(place), STOPS.length - 2);
  for (let part = 0; part < 3; part += 1) {
    SCALE[3 * at + part] = STOPS[low][part] + (place - low) * (STOPS[low + 1][part] - STOPS[low][part]);
  }
}

/**
 * The friction map as an image; what is out of reach is hatched.
 * @param {FrictionField} map
 */
export function imageOf({ widthPx, heightPx, frictionN, outOfReach, lowN, highN }) {
  const image = new ImageData(widthPx, heightPx);
  const range = Math.max(highN - lowN, 1e-9);
  for (let at = 0; at < frictionN.length; at += 1) {
    const level = Math.max(0, Math.min(255, Math.round((255 * (frictionN[at] - lowN)) / range)));
    image.data.set(SCALE.subarray(3 * level, 3 * level + 3), 4 * at);
    image.data[4 * at + 3] = 255;
    if (outOfReach[at] !== 0) hatch(image.data, 4 * at, at % widthPx, Math.floor(at / widthPx), outOfReach[at]);
  }
  return image;
}

/**
 * Stripes: rising where the scene asks for too much, falling where it asks for less than natural friction.
 * @param {Uint8ClampedArray} data
 * @param {number} offset
 * @param {number} x
 * @param {number} y
 * @param {number} side 1 for too much, -1 for too little.
 */
function hatch(data, offset, x, y, side) {
  const phase = (((side > 0 ? x + y : x - y) % 12) + 12) % 12;
  if (phase < 5) data.set(phase < 2 ? [0, 0, 0, 255] : [255, 255, 255, 255], offset);
}
