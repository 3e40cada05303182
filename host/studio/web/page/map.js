// The friction map, as large as its box or in real size; the finger has a canvas of its own above it (finger.js).
// @ts-check

import { imageOf } from "./colors.js";
import { colour, contextOf } from "./dom.js";
import { drawDraft, drawNames, drawRuler, drawScale } from "./map_labels.js";
import { drawMockup } from "./mockup.js";

/** @import { Checked, FrictionField, MapSize, Screen } from "../engine/types" */
/** @import { Mockup } from "./mockup.js" */
/** @typedef {{ left: number, top: number, width: number, height: number }} Area Of the map in its box, CSS pixels. */

/** Room for ruler and scale around the map, CSS pixels: in a narrow box they are above and below it. */
const AROUND_PX = {
  wide: { left: 38, top: 26, right: 64, bottom: 10 },
  narrow: { left: 2, top: 24, right: 2, bottom: 28 },
};
const NARROW_BOX_PX = 480;

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
  #resizes;
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
  /** @type {Mockup} */
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
    this.#resizes = new ResizeObserver(() => this.layout());
    this.#resizes.observe(this.box);
  }

  /** Ends the fitting into the box. */
  close() {
    this.#resizes.disconnect();
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
    this.box.style.setProperty("--screen-left", `${area.left}px`);
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
    const { left, top } = this.#around;
    const area = { x: left, y: top, width: widthMm * this.scale, height: heightMm * this.scale };
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
    const isNarrow = this.#around === AROUND_PX.narrow;
    const labels = { screen: this.screen, scale: this.scale, isNarrow, ink };
    drawRuler(context, area, labels);
    if (this.look !== "mockup") drawScale(context, map, area, labels);
    if (this.hasNames && this.look !== "mockup" && !isBlind) drawNames(context, check, area, this.scale);
    if (check.isDraft && !isBlind) drawDraft(context, area);
  }
}
