// The finger: pointer events and arrow keys to the engine, and what is drawn of it: trail and finger.
// @ts-check

import { clock } from "../clock.js";
import { ARROWS } from "./arrows.js";
import { colour, contextOf, drawCircle, lay } from "./dom.js";
import { Trail } from "./trail.js";

/** @import { Engine } from "../engine/engine.js" */
/** @import { Frame, Reach } from "../engine/types" */
/** @import { Area, FrictionMap } from "./map.js" */
/**
 * What others draw between the trail and the finger. While `isActive`, it is drawn at each picture of the screen.
 * @typedef {{ isActive: boolean, draw: (context: CanvasRenderingContext2D) => void }} Overlay
 */


/** The drawn finger follows within this time on bare glass, and as much longer at the largest friction, ms. */
const FOLLOW_MS = 12;
const DRAG_MS = 160;
/** Speed of a finger that an arrow key moves, mm/s. */
const KEY_MM_PER_S = 80;
/** Load of a pressure of one half, the usual pressure, is that of the finger's profile, N. */
const LOAD_AT_FULL_PRESSURE_N = 1;

export class Finger {
  #canvas;
  #engine;
  #map;
  #area = { width: 1, height: 1 };
  /** @type {number | undefined} */
  #pointerId;
  /** @type {Set<string>} */
  #keys = new Set();
  /** The place of the pointer, and the place where the finger is drawn, mm. */
  #target = { xMm: 60, yMm: 40 };
  #drawn = { xMm: 60, yMm: 40 };
  #isDown = false;
  #isInside = false;
  #trail = new Trail();
  #lastMs = 0;
  /** What was drawn last, without a trail; empty where a trail was. */
  #shown = "";
  /**
   * Where a replay has the finger, mm.
   * @type {{ xMm: number, yMm: number } | undefined}
   */
  #replayed;
  /** Others have drawn something new: one more picture. */
  #isStale = false;
  /** @type {Overlay[]} */
  overlays = [];
  /** Something else slides, so a pointer that is not pressed lifts nothing. */
  isGuided = false;
  usesPressure = false;
  drags = true;
  #isClosed = false;
  /** A stroke begins. */
  onDown = () => {};

  /**
   * Draws on `canvas`, which lies over the map, and takes its pointer events and arrow keys.
   * @param {Engine} engine
   * @param {FrictionMap} map
   * @param {HTMLCanvasElement} canvas
   */
  constructor(engine, map, canvas) {
    this.#engine = engine;
    this.#map = map;
    this.#canvas = canvas;
    map.onLayout = (area) => this.#place(area);
    canvas.addEventListener("pointerdown", (event) => this.#down(event));
    canvas.addEventListener("pointermove", (event) => this.#move(event));
    canvas.addEventListener("pointerup", (event) => this.#up(event));
    canvas.addEventListener("pointercancel", (event) => this.#up(event));
    canvas.addEventListener("pointerleave", () => (this.#isInside = false));
    canvas.addEventListener("keydown", (event) => this.#key(event, true));
    canvas.addEventListener("keyup", (event) => this.#key(event, false));
    canvas.addEventListener("blur", () => this.#releaseKeys());
    clock.nextFrame((ms) => this.#frame(ms));
  }

  /** @param {Area} area */
  #place({ left, top, width, height }) {
    this.#area = { width, height };
    this.#isStale = true;
    Object.assign(this.#canvas, {
      width: Math.round(width * devicePixelRatio),
      height: Math.round(height * devicePixelRatio),
    });
    lay(this.#canvas, { left, top, width, height });
  }

  /** Whether a person presses the map. */
  get isDown() {
    return this.#isDown;
  }

  /** Ends the drawing. */
  close() {
    this.#isClosed = true;
  }

  /** Draws once more: an overlay has changed. */
  redraw() {
    this.#isStale = true;
  }

  /** @param {PointerEvent} event */
  #aim(event) {
    const box = this.#canvas.getBoundingClientRect();
    const { widthMm, heightMm } = this.#map.screen;
    this.#target = {
      xMm: ((event.clientX - box.left) / box.width) * widthMm,
      yMm: ((event.clientY - box.top) / box.height) * heightMm,
    };
  }

  /**
   * @param {PointerEvent} event
   * @param {boolean} down
   */
  #send(event, down) {
    this.#aim(event);
    const loadN = this.usesPressure && event.pressure > 0 ? LOAD_AT_FULL_PRESSURE_N * event.pressure : undefined;
    this.#engine.pointer({ timeMs: event.timeStamp, ...this.#target, down, loadN });
  }

  /** @param {PointerEvent} event */
  #down(event) {
    if (event.button !== 0 || this.#pointerId !== undefined) return;
    this.#pointerId = event.pointerId;
    // A pointer that a test makes cannot be captured.
    if (event.isTrusted) this.#canvas.setPointerCapture(event.pointerId);
    this.#isDown = true;
    this.#send(event, true);
    this.#drawn = { ...this.#target };
    this.onDown();
  }

  /** @param {PointerEvent} event */
  #move(event) {
    this.#isInside = true;
    if (!this.#isDown && this.isGuided) this.#aim(event);
    else if (!this.#isDown) this.#send(event, false);
    else if (event.pointerId === this.#pointerId) {
      const events = event.getCoalescedEvents?.() ?? [];
      for (const each of events.length > 0 ? events : [event]) this.#send(each, true);
    }
  }

  /** @param {PointerEvent} event */
  #up(event) {
    if (event.pointerId !== this.#pointerId) return;
    this.#pointerId = undefined;
    this.#isDown = false;
    this.#send(event, false);
  }

  /**
   * @param {KeyboardEvent} event
   * @param {boolean} isPressed
   */
  #key(event, isPressed) {
    if (!(event.key in ARROWS)) return;
    event.preventDefault();
    if (!isPressed) {
      this.#keys.delete(event.key);
      if (this.#keys.size === 0) this.#releaseKeys();
      return;
    }
    if (this.#keys.size === 0) this.onDown();
    this.#keys.add(event.key);
    this.#isDown = true;
  }

  #releaseKeys() {
    if (this.#pointerId !== undefined || !this.#isDown) return;
    this.#keys.clear();
    this.#isDown = false;
    this.#engine.pointer({ timeMs: clock.nowMs(), ...this.#target, down: false });
  }

  /**
   * Moves the finger by the arrow keys that are held.
   * @param {number} ms
   */
  #moveByKeys(ms) {
    const stepMm = (KEY_MM_PER_S * Math.min(ms - this.#lastMs, 50)) / 1000;
    for (const key of this.#keys) {
      this.#target.xMm += ARROWS[key][0] * stepMm;
      this.#target.yMm += ARROWS[key][1] * stepMm;
    }
    this.#target.xMm = Math.max(0, Math.min(this.#target.xMm, this.#map.screen.widthMm));
    this.#target.yMm = Math.max(0, Math.min(this.#target.yMm, this.#map.screen.heightMm));
    this.#engine.pointer({ timeMs: ms, ...this.#target, down: true });
  }

  /**
   * What was felt, for the trail and the drag; `reach` is least and largest friction, N.
   * @param {Frame} frame
   * @param {Reach} reach
   */
  feel(frame, reach) {
    this.#trail.feel(frame, reach);
    const last = frame.xMm.length - 1;
    if (frame.slowness === 1 || !frame.contact) this.#replayed = undefined;
    else if (Number.isFinite(frame.xMm[last])) this.#replayed = { xMm: frame.xMm[last], yMm: frame.yMm[last] };
  }

  /** @param {number} ms */
  #frame(ms) {
    if (this.#isClosed) return;
    if (this.#keys.size > 0) this.#moveByKeys(ms);
    const isDragging = this.drags && this.#isDown;
    const followMs = isDragging ? FOLLOW_MS + DRAG_MS * this.#trail.friction : 0;
    const part = followMs === 0 ? 1 : 1 - Math.exp(-(ms - this.#lastMs) / followMs);
    this.#drawn.xMm += part * (this.#target.xMm - this.#drawn.xMm);
    this.#drawn.yMm += part * (this.#target.yMm - this.#drawn.yMm);
    this.#lastMs = ms;
    this.#trail.fade(ms);
    const isMoving = !this.#trail.isEmpty || this.#isStale || this.overlays.some(({ isActive }) => isActive);
    const shown = isMoving ? "" : JSON.stringify([this.#finger, this.#isDown, this.#area, this.#hasFocus]);
    // A finger that rests is drawn once.
    if (shown === "" || shown !== this.#shown) this.#draw();
    [this.#shown, this.#isStale] = [shown, false];
    clock.nextFrame((next) => this.#frame(next));
  }

  /** A blind comparison shows nothing of the friction. */
  get #isBlind() {
    return this.#canvas.closest(".blind") !== null;
  }

  /** Where the finger is drawn, mm: that of a replay, or the person's, if there is one. */
  get #finger() {
    if (this.#replayed) return this.#replayed;
    return this.#isInside || this.#isDown || this.#hasFocus ? this.#drawn : undefined;
  }

  get #hasFocus() {
    return this.#canvas.matches(":focus");
  }

  #draw() {
    const context = contextOf(this.#canvas);
    context.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    context.clearRect(0, 0, this.#area.width, this.#area.height);
    if (!this.#isBlind) this.#trail.draw(context, this.#map.scale);
    // The lens of a replay shows what is under its finger.
    if (this.#replayed) this.#drawFinger(context);
    if (!this.#isBlind) for (const overlay of this.overlays) overlay.draw(context);
    if (!this.#replayed) this.#drawFinger(context);
  }

  /** @param {CanvasRenderingContext2D} context */
  #drawFinger(context) {
    const finger = this.#finger;
    if (!finger) return;
    const { scale } = this.#map;
    const [x, y] = [finger.xMm * scale, finger.yMm * scale];
    const isDown = this.#isDown || this.#replayed !== undefined;
    const radius = Math.max(9, 4 * scale);
    const width = isDown && !this.#isBlind ? 2 + 5 * this.#trail.friction : 2;
    const stroke = isDown ? colour("felt", this.#map.box) : "#fff";
    drawCircle(context, [x, y, radius], { fill: isDown ? "#ffffff59" : "#ffffff1f", stroke, width });
    drawCircle(context, [x, y, radius + 4], { stroke: "#000b" });
  }
}
