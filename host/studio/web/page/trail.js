// The trail behind the finger: where it was of late, and how much friction it felt there.
// @ts-check

import { clock } from "../clock.js";

/** @import { Frame, Reach } from "../engine/types" */
/** @typedef {{ xMm: number, yMm: number, friction: number, ms: number }} TrailPoint */

/** How long a trail stays, s. */
const TRAIL_S = 2.5;
const TRAIL_STEPS = 4;
/** A point of the trail for so many samples. */
const TRAIL_EVERY = 8;

export class Trail {
  /** Null where the finger was up. @type {(TrailPoint | null)[]} */
  #points = [];
  /** Part of the reach that is felt now, 0 to 1. */
  friction = 0;

  get isEmpty() {
    return this.#points.length === 0;
  }

  /**
   * Adds what was felt, and forgets what is old.
   * @param {Frame} frame
   * @param {Reach} reach
   */
  feel(frame, reach) {
    const span = Math.max(reach.highN - reach.lowN, 1e-9);
    for (let at = 0; at < frame.feltN.length; at += TRAIL_EVERY) {
      const felt = Number.isFinite(frame.feltN[at]) ? frame.feltN[at] : frame.referenceN[at];
      // A finger that was up, for however short, left no trail there.
      if (!frame.xMm.subarray(at, at + TRAIL_EVERY).every(Number.isFinite)) this.#points.push(null);
      else {
        this.friction = Math.max(0, Math.min(1.2, (felt - reach.lowN) / span));
        this.#points.push({ xMm: frame.xMm[at], yMm: frame.yMm[at], friction: this.friction, ms: clock.nowMs() });
      }
    }
    const oldest = clock.nowMs() - TRAIL_S * 1000;
    const first = this.#points.findIndex((point) => point !== null && point.ms >= oldest);
    this.#points = first < 0 ? [] : this.#points.slice(first);
  }

  /**
   * Forgets what is old at a picture of the screen.
   * @param {number} ms
   */
  fade(ms) {
    this.#points = this.#points.filter((point) => point === null || ms - point.ms < TRAIL_S * 1000);
    if (!this.#points.some((point) => point !== null)) this.#points = [];
  }

  /**
   * Draws the way of the finger, thicker where more friction was felt. It fades in steps, so that few paths are drawn.
   * @param {CanvasRenderingContext2D} context
   * @param {number} scale CSS pixels per mm.
   */
  draw(context, scale) {
    const now = clock.nowMs();
    const paths = new Map();
    for (let at = 1; at < this.#points.length; at += 1) {
      const [from, to] = [this.#points[at - 1], this.#points[at]];
      if (!from || !to) continue;
      const age = Math.min(TRAIL_STEPS - 1, Math.floor((TRAIL_STEPS * (now - to.ms)) / (TRAIL_S * 1000)));
      const width = Math.round(5 * to.friction);
      const key = `${age} ${width}`;
      const line = paths.get(key) ?? {
        alpha: 0.9 * (1 - age / TRAIL_STEPS),
        width: 1.5 + 1.8 * width,
        path: new Path2D(),
      };
      paths.set(key, line);
      const { path } = line;
      path.moveTo(from.xMm * scale, from.yMm * scale);
      path.lineTo(to.xMm * scale, to.yMm * scale);
    }
    for (const [extra, ink] of /** @type {const} */ ([[3, "#000"], [0, "#fff"]])) {
      context.strokeStyle = ink;
      for (const { alpha, width, path } of paths.values()) {
        context.globalAlpha = alpha;
        context.lineWidth = width + extra;
        context.stroke(path);
      }
    }
    context.globalAlpha = 1;
  }
}
