// The friction map with ruler, scale and names; the finger has a canvas of its own above it (finger.js).
// @ts-check

import { SCALE, imageOf } from "./colors.js";
import { colour, contextOf, shortName } from "./dom.js";
import { MOCKUPS, drawMockup } from "./mockup.js";

/** @import { Checked, FrictionField, Layer, MapSize, Screen } from "../engine/types" */
/** @typedef {{ left: number, top: number, width: number, height: number }} Area Of the map in its box, CSS pixels. */
/** @typedef {{ x: number, y: number, width: number, height: number }} Box */
/** @typedef {{ line: string, text: string }} Ink */

/** Room for ruler and scale around the map, CSS pixels: in a narrow box they are above and below it. */
const AROUND_PX = {
  wide: { left: 38, top: 26, right: 64, bottom: 10 },
  narrow: { left: 2, top: 24, right: 2, bottom: 28 },
};
const NARROW_BOX_PX = 480;
/** Height of the word that marks a draft, CSS pixels. */
const DRAFT_HEIGHT_PX = 36;

/** Longer side of a small picture of the map, pixels. */
const THUMBNAIL_PX = 240;
/** Fewest pixels along the shorter side of a map's picture. */
const SHORT_SIDE_MIN_PX = 8;

/**
 * Size of the picture of a screen's friction map whose longer side has this many pixels, for `engine.map`.
 * @param {Screen} screen
 * @param {number} longSidePx
 * @returns {MapSize}
 */
export function mapSizePx({ widthMm, heightMm }, longSidePx) {
  const perMm = longSidePx / Math.max(widthMm, heightMm);
  const [widthPx, heightPx] = [widthMm, heightMm].map((mm) => Math.max(SHORT_SIDE_MIN_PX, Math.round(mm * perMm)));
  return { widthPx, heightPx };
}

/** How much of the map is seen over a mock-up. */
const MAP_ALPHA = { map: 1, both: 0.45, mockup: 0 };

export class FrictionMap {
  #canvas;
  /** The element that the map is in. */
  box;
  /** @type {FrictionField | undefined} */
  #map;
  /** @type {Checked | undefined} */
  #check;
  /** @type {OffscreenCanvas | undefined} */
  #picture;
  /**
   * Screen in mm; CSS pixels per mm.
   * @type {Screen}
   */
  screen = { widthMm: 120, heightMm: 80 };
  scale = 5;
  /**
   * CSS pixels per mm of the real size, or undefined to fit the page.
   * @type {number | undefined}
   */
  realSize;
  /** Room around the map, CSS pixels. */
  #around = AROUND_PX.wide;
  /** @type {keyof typeof MAP_ALPHA} */
  look = "map";
  hasNames = true;
  /** @type {keyof typeof MOCKUPS} */
  mockup = "player";
  /**
   * The map has another size: finger.js follows.
   * @type {(area: Area) => void}
   */
  onLayout = () => {};
  /**
   * `onRoom(widthPx, heightPx)`: the map would be so wide, with what is around it, if its height alone limited it, and
   * so high, if its width did.
   * @type {(widthPx: number, heightPx: number) => void}
   */
  onRoom = () => {};

  /**
   * Draws on the canvas `picture` in the element `box`.
   * @param {HTMLElement} box
   * @param {HTMLCanvasElement} picture
   */
  constructor(box, picture) {
    this.box = box;
    this.#canvas = picture;
    new ResizeObserver(() => this.layout()).observe(this.box);
  }

  /**
   * @param {FrictionField} map
   * @param {Checked} check
   */
  show(map, check) {
    this.#map = map;
    this.#check = check;
    this.screen = check.screen;
    const picture = new OffscreenCanvas(map.widthPx, map.heightPx);
    contextOf(picture).putImageData(imageOf(map), 0, 0);
    this.#picture = picture;
    this.layout();
  }

  /**
   * The target friction at a place, N; undefined outside of the map, or before there is one.
   * @param {number} xMm
   * @param {number} yMm
   */
  frictionAt(xMm, yMm) {
    const map = this.#map;
    if (!map) return undefined;
    const column = Math.floor((xMm / this.screen.widthMm) * map.widthPx);
    const row = Math.floor((yMm / this.screen.heightMm) * map.heightPx);
    const isInside = column >= 0 && row >= 0 && column < map.widthPx && row < map.heightPx;
    return isInside ? map.frictionN[row * map.widthPx + column] : undefined;
  }

  /** The friction of each pixel, N. */
  get frictionN() {
    return this.#map?.frictionN ?? new Float32Array();
  }

  /**
   * Draws the friction alone on another canvas, whose unit is a mm.
   * @param {CanvasRenderingContext2D} context
   */
  drawOn(context) {
    if (this.#picture) context.drawImage(this.#picture, 0, 0, this.screen.widthMm, this.screen.heightMm);
  }

  /** A small picture of the friction alone, as a PNG. */
  thumbnail() {
    if (!this.#picture) throw new Error("there is no map yet");
    const { width, height } = this.#picture;
    const { widthPx, heightPx } = mapSizePx({ widthMm: width, heightMm: height }, THUMBNAIL_PX);
    const small = new OffscreenCanvas(widthPx, heightPx);
    contextOf(small).drawImage(this.#picture, 0, 0, widthPx, heightPx);
    return small.convertToBlob();
  }

  /** Fits the map into its box, or shows it in real size. */
  layout() {
    const { widthMm, heightMm } = this.screen;
    this.box.classList.toggle("in-real-size", this.realSize !== undefined);
    const { clientWidth, clientHeight } = this.box;
    this.#around = clientWidth < NARROW_BOX_PX ? AROUND_PX.narrow : AROUND_PX.wide;
    const { left, top, right, bottom } = this.#around;
    const scaleByHeight = (clientHeight - top - bottom) / heightMm;
    const scaleByWidth = (clientWidth - left - right) / widthMm;
    const fitted = Math.min(scaleByWidth, scaleByHeight);
    this.onRoom(left + right + widthMm * scaleByHeight, top + bottom + heightMm * scaleByWidth);
    this.scale = this.realSize ?? Math.max(0.5, fitted);
    const width = left + right + widthMm * this.scale;
    const height = top + bottom + heightMm * this.scale;
    const ratio = devicePixelRatio;
    Object.assign(this.#canvas, { width: Math.round(width * ratio), height: Math.round(height * ratio) });
    Object.assign(this.#canvas.style, {
      width: `${width}px`,
      height: `${height}px`,
      marginLeft: `${Math.max(0, (clientWidth - width) / 2)}px`,
      marginTop: `${Math.max(0, (clientHeight - height) / 2)}px`,
    });
    this.draw();
    const area = {
      left: this.#canvas.offsetLeft + left,
      top: this.#canvas.offsetTop + top,
      width: widthMm * this.scale,
      height: heightMm * this.scale,
    };
    // For what floats over the screen.
    this.box.style.setProperty("--screen-right", `${Math.max(0, clientWidth - area.left - area.width)}px`);
    this.box.style.setProperty("--screen-bottom", `${Math.max(0, clientHeight - area.top - area.height)}px`);
    this.onLayout(area);
  }

  /**
   * Shows that the map is older than the scene: another one is being drawn, or none can be.
   * @param {"drawing" | "older" | undefined} why
   */
  markStale(why) {
    if (why) this.box.dataset.stale = why;
    else delete this.box.dataset.stale;
  }

  draw() {
    const context = contextOf(this.#canvas);
    context.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    context.clearRect(0, 0, this.#canvas.width, this.#canvas.height);
    const [map, check, picture] = [this.#map, this.#check, this.#picture];
    if (!map || !check || !picture) return;
    const { widthMm, heightMm } = this.screen;
    const area = { x: this.#around.left, y: this.#around.top, width: widthMm * this.scale, height: heightMm * this.scale };
    context.save();
    context.translate(area.x, area.y);
    // A blind comparison shows nothing of the friction.
    const isBlind = this.box.closest(".blind") !== null;
    if (this.look !== "map") drawMockup(context, this.mockup, area.width, area.height);
    context.globalAlpha = MAP_ALPHA[this.look];
    context.imageSmoothingEnabled = this.scale * devicePixelRatio * widthMm < map.widthPx * 2;
    context.fillStyle = "#777";
    if (isBlind) context.fillRect(0, 0, area.width, area.height);
    else context.drawImage(picture, 0, 0, area.width, area.height);
    context.restore();
    const ink = { line: colour("soft", this.box), text: colour("ink", this.box) };
    this.#drawRuler(context, area, ink);
    if (this.look !== "mockup") this.#drawScale(context, map, area, ink);
    if (this.hasNames && this.look !== "mockup" && !isBlind) this.#drawNames(context, check, area);
    if (check.isDraft && !isBlind) drawDraft(context, area);
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {Box} area
   * @param {Ink} ink
   */
  #drawRuler(context, { x, y, width, height }, ink) {
    context.fillStyle = ink.text;
    context.strokeStyle = ink.line;
    context.font = "13px system-ui, sans-serif";
    const every = [10, 20, 50, 100, 200, 500].find((step) => step * this.scale >= 44) ?? 1000;
    const isNarrow = this.#around === AROUND_PX.narrow;
    context.lineWidth = 1;
    context.beginPath();
    context.textBaseline = "bottom";
    for (let mm = 0; mm <= this.screen.widthMm; mm += every / 5) {
      const isLong = Math.round((mm * 5) / every) % 5 === 0;
      context.moveTo(x + mm * this.scale, y - 2);
      context.lineTo(x + mm * this.scale, y - (isLong ? 9 : 5));
      const isCut = isNarrow && x + mm * this.scale > x + width - 12;
      context.textAlign = isNarrow && mm === 0 ? "left" : "center";
      if (isLong && !isCut) context.fillText(mm === 0 ? "0 mm" : `${Math.round(mm)}`, x + mm * this.scale, y - 10);
    }
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (let mm = 0; mm <= this.screen.heightMm && !isNarrow; mm += every / 5) {
      const isLong = Math.round((mm * 5) / every) % 5 === 0;
      context.moveTo(x - 2, y + mm * this.scale);
      context.lineTo(x - (isLong ? 9 : 5), y + mm * this.scale);
      if (isLong && mm > 0) context.fillText(`${Math.round(mm)}`, x - 11, y + mm * this.scale);
    }
    context.stroke();
    context.strokeRect(x - 0.5, y - 0.5, width + 1, height + 1);
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {FrictionField} map
   * @param {Box} area
   * @param {Ink} ink
   */
  #drawScale(context, { lowN, highN }, { x, y, width, height }, ink) {
    const isNarrow = this.#around === AROUND_PX.narrow;
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
   * Each layer's name in the top left corner of its region, below the names that are there already.
   * @param {CanvasRenderingContext2D} context
   * @param {Checked} check
   * @param {Box} area
   */
  #drawNames(context, { layers, isDraft }, { x, y, width, height }) {
    context.font = "600 14px system-ui, sans-serif";
    context.textAlign = "left";
    context.textBaseline = "middle";
    context.lineJoin = "round";
    /** @type {{ left: number, place: number, wide: number }[]} */
    const taken = [];
    // Below the word in the corner.
    const top = y + (isDraft ? DRAFT_HEIGHT_PX : 0) + 14;
    for (const { name, box } of namedBoxes(layers, this.screen)) {
      const wide = context.measureText(name).width + 16;
      const left = Math.max(x + 8, Math.min(x + box.x * this.scale + 8, x + width - wide));
      let place = Math.max(top, y + box.y * this.scale + 14);
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
}

/**
 * Marks a map whose scene a board would refuse: stripes along the edge, and the word.
 * @param {CanvasRenderingContext2D} context
 * @param {Box} area
 */
function drawDraft(context, { x, y, width, height }) {
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
