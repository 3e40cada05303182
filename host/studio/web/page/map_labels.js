// What is drawn around and over the friction map: ruler, scale of colours, names of layers, and the mark of a draft.
// @ts-check

import { SCALE } from "./colors.js";
import { shortName } from "./dom.js";

/** @import { Checked, FrictionField, Layer, Screen } from "../engine/types" */
/** @typedef {{ x: number, y: number, width: number, height: number }} Box */
/** @typedef {{ line: string, text: string }} Ink */
/** @typedef {{ screen: Screen, scale: number, isNarrow: boolean, ink: Ink }} Labels `scale` in CSS pixels per mm. */

/** Height of the word that marks a draft, CSS pixels. */
const DRAFT_HEIGHT_PX = 36;

/**
 * Draws a ruler along the top and the left side, and a line around the map.
 * @param {CanvasRenderingContext2D} context
 * @param {Box} area
 * @param {Labels} labels
 */
export function drawRuler(context, { x, y, width, height }, { screen, scale, isNarrow, ink }) {
  context.fillStyle = ink.text;
  context.strokeStyle = ink.line;
  context.font = "13px system-ui, sans-serif";
  const every = [10, 20, 50, 100, 200, 500].find((step) => step * scale >= 44) ?? 1000;
  context.lineWidth = 1;
  context.beginPath();
  context.textBaseline = "bottom";
  for (let mm = 0; mm <= screen.widthMm; mm += every / 5) {
    const isLong = Math.round((mm * 5) / every) % 5 === 0;
    context.moveTo(x + mm * scale, y - 2);
    context.lineTo(x + mm * scale, y - (isLong ? 9 : 5));
    const isCut = isNarrow && x + mm * scale > x + width - 12;
    context.textAlign = isNarrow && mm === 0 ? "left" : "center";
    if (isLong && !isCut) context.fillText(mm === 0 ? "0 mm" : `${Math.round(mm)}`, x + mm * scale, y - 10);
  }
  context.textAlign = "right";
  context.textBaseline = "middle";
  for (let mm = 0; mm <= screen.heightMm && !isNarrow; mm += every / 5) {
    const isLong = Math.round((mm * 5) / every) % 5 === 0;
    context.moveTo(x - 2, y + mm * scale);
    context.lineTo(x - (isLong ? 9 : 5), y + mm * scale);
    if (isLong && mm > 0) context.fillText(`${Math.round(mm)}`, x - 11, y + mm * scale);
  }
  context.stroke();
  context.strokeRect(x - 0.5, y - 0.5, width + 1, height + 1);
}

/**
 * Draws the scale of colours beside the map, in a narrow box below it.
 * @param {CanvasRenderingContext2D} context
 * @param {FrictionField} map
 * @param {Box} area
 * @param {Labels} labels
 */
export function drawScale(context, { lowN, highN }, { x, y, width, height }, { isNarrow, ink }) {
  const bar = isNarrow
    ? { left: x + 6, top: y + height + 6, length: width - 50 }
    : { left: x + width + 10, top: y + 18, length: height - 18 };
  /** Fills a part of the bar, from 0 at low to 1 at high friction, and `wide` pixels across it from `across`. */
  const fill = (/** @type {number} */ from, /** @type {number} */ long, across = 0, wide = 14) => {
    if (isNarrow) context.fillRect(bar.left + from * bar.length, bar.top + across, long, wide / 2);
    else context.fillRect(bar.left + across, bar.top + (1 - from) * bar.length - long, wide, long);
  };
  for (let at = 0; at < 256; at += 1) {
    context.fillStyle = `rgb(${SCALE.subarray(3 * at, 3 * at + 3).join(",")})`;
    fill(at / 256, bar.length / 256 + 1);
  }
  context.fillStyle = ink.text;
  context.font = "13px system-ui, sans-serif";
  context.textAlign = isNarrow ? "center" : "left";
  context.textBaseline = "middle";
  if (isNarrow) context.fillText("mN", x + width - 18, bar.top + 12);
  else context.fillText("mN", bar.left, y + 6);
  const room = isNarrow ? 40 : 26;
  const everyMn =
    [5, 10, 20, 25, 50, 100, 200, 500].find((step) => (bar.length * step) / (1000 * (highN - lowN)) >= room) ?? 1000;
  for (let mN = Math.ceil((lowN * 1000) / everyMn) * everyMn; mN <= highN * 1000 + 1e-6; mN += everyMn) {
    const part = (mN / 1000 - lowN) / (highN - lowN);
    const place = Math.max(5, Math.min(part * bar.length, bar.length - 5));
    if (isNarrow) context.fillText(`${mN}`, bar.left + Math.max(14, place), bar.top + 15);
    else context.fillText(`${mN}`, bar.left + 22, bar.top + bar.length - place);
    if (!isNarrow) fill(part, 1, 14, 4);
  }
}

/**
 * Writes each layer's name in the top left corner of its region, below the names that are there already.
 * @param {CanvasRenderingContext2D} context
 * @param {Checked} check
 * @param {Box} area
 * @param {number} scale CSS pixels per mm.
 */
export function drawNames(context, { layers, screen, isDraft }, { x, y, width, height }, scale) {
  context.font = "600 14px system-ui, sans-serif";
  context.textAlign = "left";
  context.textBaseline = "middle";
  context.lineJoin = "round";
  /** @type {{ left: number, place: number, wide: number }[]} */
  const taken = [];
  // Below the word in the corner.
  const top = y + (isDraft ? DRAFT_HEIGHT_PX : 0) + 14;
  for (const { name, box } of namedBoxes(layers, screen)) {
    const wide = context.measureText(name).width + 16;
    const left = Math.max(x + 8, Math.min(x + box.x * scale + 8, x + width - wide));
    let place = Math.max(top, y + box.y * scale + 14);
    const isTaken = () =>
      taken.some(
        (other) =>
          Math.abs(other.place - place) < 20 && left < other.left + other.wide && other.left < left + wide,
      );
    for (let tries = 0; tries < 6 && isTaken(); tries += 1) place += 20;
    if (place > y + height - 8 || isTaken()) continue;
    taken.push({ left, place, wide });
    context.strokeStyle = "#000c";
    context.lineWidth = 4;
    context.strokeText(name, left, place);
    context.fillStyle = "#fff";
    context.fillText(name, left, place);
  }
}

/**
 * Marks a map whose scene a board would refuse: stripes along the edge, and the word.
 * @param {CanvasRenderingContext2D} context
 * @param {Box} area
 */
export function drawDraft(context, { x, y, width, height }) {
  const wide = 10;
  context.save();
  context.beginPath();
  context.rect(x, y, width, height);
  context.rect(x + wide, y + wide, width - 2 * wide, height - 2 * wide);
  context.clip("evenodd");
  context.fillStyle = "#000";
  context.fillRect(x, y, width, height);
  context.strokeStyle = "#ffd23f";
  context.lineWidth = 7;
  context.beginPath();
  for (let at = -height; at < width; at += 20) {
    context.moveTo(x + at, y + height);
    context.lineTo(x + at + height, y);
  }
  context.stroke();
  context.restore();
  const words = "draft";
  context.font = "700 20px system-ui, sans-serif";
  const long = context.measureText(words).width + 28;
  context.fillStyle = "#000";
  context.fillRect(x, y, long, DRAFT_HEIGHT_PX);
  context.fillStyle = "#ffd23f";
  context.textAlign = "left";
  context.textBaseline = "middle";
  context.fillText(words, x + 14, y + DRAFT_HEIGHT_PX / 2);
}

/**
 * Names of layers with the box of each region; a layer without a region has the whole screen.
 * @param {Layer[]} layers
 * @param {Screen} screen
 */
function namedBoxes(layers, screen) {
  return layers.map(({ name, boxMm }) => {
    const [x, y, width, height] = boxMm ?? [0, 0, screen.widthMm, screen.heightMm];
    return { name: shortName(name), box: { x, y, width, height } };
  });
}
