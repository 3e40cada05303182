// Mock-ups of an interface to lie under the friction map: what a person would see while they feel it.
// @ts-check

import { chosenFile } from "./dom.js";

/**
 * A picture of one's own, once it is chosen.
 * @type {ImageBitmap | undefined}
 */
let ownPicture;

/** By the values of the list of mock-ups. */
const MOCKUPS = { player, keypad, shop, own };
/** @typedef {keyof typeof MOCKUPS} Mockup */

/** Asks for a picture; resolves to whether there is one. */
export async function chooseOwnPicture() {
  const file = await chosenFile("image/*");
  if (file) ownPicture = await createImageBitmap(file).catch(() => undefined);
  return ownPicture !== undefined;
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {Mockup} name
 * @param {number} width
 * @param {number} height
 */
export function drawMockup(context, name, width, height) {
  context.save();
  context.fillStyle = "#f7f7fa";
  context.fillRect(0, 0, width, height);
  // The mock-ups are drawn for 120 x 80: on another shape they keep theirs, in the middle.
  const scale = Math.min(width / 120, height / 80);
  context.translate((width - 120 * scale) / 2, (height - 80 * scale) / 2);
  context.scale(scale, scale);
  MOCKUPS[name](context);
  context.restore();
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {number} x
 * @param {number} y
 * @param {number} width
 * @param {number} height
 * @param {number} radius
 * @param {string} fill
 */
function rounded(context, x, y, width, height, radius, fill) {
  context.beginPath();
  context.roundRect(x, y, width, height, radius);
  context.fillStyle = fill;
  context.fill();
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {string} words
 * @param {number} x
 * @param {number} y
 * @param {number} size
 * @param {string} fill
 */
function text(context, words, x, y, size, fill = "#20242d") {
  context.font = `600 ${size}px system-ui, sans-serif`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillStyle = fill;
  context.fillText(words, x, y);
}

/** @param {CanvasRenderingContext2D} context */
function player(context) {
  rounded(context, 40, 3, 40, 21, 2, "#8fb4d9");
  text(context, "♪", 60, 14, 13, "#fff");
  rounded(context, 8, 37, 104, 6, 3, "#d7dbe3");
  rounded(context, 8, 37, 52, 6, 3, "#0b5cad");
  rounded(context, 55, 34, 12, 12, 6, "#0b5cad");
  text(context, "volume", 60, 29, 4);
  for (const [index, side] of [-1, 1, 1].entries()) {
    const x = 41 + 20 * index;
    rounded(context, x - 7, 58, 14, 14, 7, index === 1 ? "#0b5cad" : "#d7dbe3");
    context.beginPath();
    context.moveTo(x - 2 * side, 61.5);
    context.lineTo(x - 2 * side, 68.5);
    context.lineTo(x + 3.4 * side, 65);
    context.fillStyle = index === 1 ? "#fff" : "#20242d";
    context.fill();
  }
}

/** @param {CanvasRenderingContext2D} context */
function keypad(context) {
  for (let key = 0; key < 9; key += 1) {
    const [x, y] = [24 + 26 * (key % 3), 8 + 17 * Math.floor(key / 3)];
    rounded(context, x, y, 20, 14, 2.5, "#dfe4ec");
    text(context, `${key + 1}`, x + 10, y + 7.3, 7);
  }
  text(context, "enter your number", 60, 68, 5, "#565d6b");
}

/** @param {CanvasRenderingContext2D} context */
function shop(context) {
  for (const [index, [words, fill]] of [
    ["linen", "#d9cdb4"],
    ["leather", "#93623d"],
    ["denim", "#3d5a85"],
  ].entries()) {
    rounded(context, 6 + 38 * index, 6, 32, 46, 2, fill);
    text(context, words, 22 + 38 * index, 58, 4.5);
  }
  rounded(context, 35, 65, 50, 11, 5.5, "#0b5cad");
  text(context, "Add to basket", 60, 70.7, 5, "#fff");
}

/** @param {CanvasRenderingContext2D} context */
function own(context) {
  if (!ownPicture) return;
  const scale = Math.min(120 / ownPicture.width, 80 / ownPicture.height);
  const [width, height] = [ownPicture.width * scale, ownPicture.height * scale];
  context.drawImage(ownPicture, (120 - width) / 2, (80 - height) / 2, width, height);
}
