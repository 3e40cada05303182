// The lens at the finger while a stroke is replayed slowly: contact, reports, predicted place, voltage and force.
// @ts-check

import { byId, colour, drawCircle } from "./dom.js";

/** @import { Frame, Reach } from "../engine/types" */
/** @import { Finger } from "./finger.js" */
/** @import { FrictionMap } from "./map.js" */
/** @typedef {{ xMm: number, yMm: number }} Place */

/** What the lens shows around the finger, mm, and its largest and least radius, CSS pixels. */
const RADIUS_MM = 8;
const RADIUS_MAX_PX = 120;
const RADIUS_MIN_PX = 64;
/** Part of the map's height that the lens takes at most. */
const HEIGHT_PART = 0.34;
/** Distance of the words below it from it and from the screen's edge together, CSS pixels. */
const WORDS_GAP_PX = 12;
/** Reports that stay, and how much of the voltage is shown, samples of a millisecond. */
const REPORTS = 8;
const ENVELOPE = 120;
/** The envelope's height at this voltage, or at a larger one that is there, is that of its strip. */
const ENVELOPE_V = 50;

export class Lens {
  #map;
  #finger;
  #words = byId("lens-words");
  /**
   * The finger, where the board predicts it, and how it moves; while it is down in a replay.
   * @type {{ at: Place, predicted?: Place, direction: Place, radiusMm: number, feltN: number } | undefined}
   */
  #now;
  /** @type {Place[]} */
  #reports = [];
  /** @type {number[]} */
  #voltagesV = [];
  #highN = 1;

  /** @param {{ map: FrictionMap, finger: Finger }} parts */
  constructor({ map, finger }) {
    this.#map = map;
    this.#finger = finger;
    finger.overlays.push(this);
  }

  get isActive() {
    return this.#now !== undefined;
  }

  /**
   * @param {Frame} frame
   * @param {Reach} reach
   */
  feel(frame, { highN }) {
    const { slowness, simulated, contact, feltN } = frame;
    if (!(slowness > 1 && simulated) || (!contact && feltN.length > 0)) {
      if (this.#now) this.#close();
      return;
    }
    this.#highN = highN;
    for (let at = 0; at < feltN.length; at += 1) this.#add(frame, at);
    if (this.#now && feltN.length > 0) this.#say();
  }

  #close() {
    this.#now = undefined;
    [this.#reports, this.#voltagesV] = [[], []];
    this.#words.hidden = true;
    this.#finger.redraw();
  }

  /**
   * @param {Frame} frame
   * @param {number} at
   */
  #add(frame, at) {
    const place = { xMm: frame.xMm[at], yMm: frame.yMm[at] };
    if (!Number.isFinite(place.xMm)) return;
    const before = this.#now;
    const moved = before && { xMm: place.xMm - before.at.xMm, yMm: place.yMm - before.at.yMm };
    const length = moved ? Math.hypot(moved.xMm, moved.yMm) : 0;
    const isMoving = moved && length > 0.005;
    const direction = isMoving ? { xMm: moved.xMm / length, yMm: moved.yMm / length } : before?.direction;
    const predicted = { xMm: frame.predictedXMm[at], yMm: frame.predictedYMm[at] };
    this.#now = {
      at: place,
      predicted: Number.isFinite(predicted.xMm) ? predicted : undefined,
      direction: direction ?? { xMm: 0, yMm: 0 },
      radiusMm: frame.contactRadiusMm[at],
      feltN: frame.feltN[at],
    };
    const report = { xMm: frame.reportedXMm[at], yMm: frame.reportedYMm[at] };
    const last = this.#reports.at(-1);
    const isNew = report.xMm !== last?.xMm || report.yMm !== last?.yMm;
    if (Number.isFinite(report.xMm) && isNew) this.#reports.push(report);
    this.#reports.splice(0, this.#reports.length - REPORTS);
    this.#voltagesV.push(frame.voltageV[at]);
    this.#voltagesV.splice(0, this.#voltagesV.length - ENVELOPE);
  }

  #say() {
    if (!this.#now) return;
    const { radiusMm, feltN } = this.#now;
    const patch = Number.isFinite(radiusMm) ? `${(2 * radiusMm).toFixed(1)} mm` : "unknown";
    this.#words.hidden = false;
    const values = {
      "lens-contact": patch,
      "lens-force": `${(1000 * feltN).toFixed(0)} mN`,
      "lens-voltage": `${(this.#voltagesV.at(-1) ?? 0).toFixed(0)} V rms`,
    };
    for (const [id, words] of Object.entries(values)) byId(id).textContent = words;
  }

  /** @param {CanvasRenderingContext2D} context */
  draw(context) {
    if (!this.#now) return;
    const { scale, screen, box } = this.#map;
    const [width, height] = [screen.widthMm * scale, screen.heightMm * scale];
    const radius = Math.max(RADIUS_MIN_PX, Math.min(RADIUS_MAX_PX, HEIGHT_PART * height));
    const { at } = this.#now;
    const inside = (/** @type {number} */ value, /** @type {number} */ most) =>
      Math.max(radius + 4, Math.min(value, most - radius - 4));
    // The lens stays above the words where there is room.
    const most = Math.max(height - this.#words.offsetHeight - WORDS_GAP_PX, 2 * radius + 8);
    const centre = [inside(at.xMm * scale, width), inside(at.yMm * scale, most)];
    context.save();
    context.translate(centre[0], centre[1]);
    context.save();
    drawCircle(context, [0, 0, radius], { fill: "#10141b" });
    context.clip();
    context.scale(radius / RADIUS_MM, radius / RADIUS_MM);
    context.translate(-at.xMm, -at.yMm);
    this.#map.drawOn(context);
    context.fillStyle = "#0006";
    context.fillRect(at.xMm - RADIUS_MM, at.yMm - RADIUS_MM, 2 * RADIUS_MM, 2 * RADIUS_MM);
    context.restore();
    this.#drawFinger(context, radius, colour("felt", box));
    this.#drawEnvelope(context, radius, colour("voltage", box));
    drawCircle(context, [0, 0, radius], { stroke: "#000b", width: 5 });
    drawCircle(context, [0, 0, radius], { stroke: "#fff", width: 2.5 });
    context.restore();
  }

  /**
   * Contact, reports, cross and arrow; the finger is in the middle.
   * @param {CanvasRenderingContext2D} context
   * @param {number} radius
   * @param {string} ink
   */
  #drawFinger(context, radius, ink) {
    if (!this.#now) return;
    const { at, predicted, direction, radiusMm, feltN } = this.#now;
    const perMm = radius / RADIUS_MM;
    const local = (/** @type {Place} */ place) => [(place.xMm - at.xMm) * perMm, (place.yMm - at.yMm) * perMm];
    const skin = { fill: "#ffffff38", stroke: "#fff", width: 1.5 };
    if (Number.isFinite(radiusMm)) drawCircle(context, [0, 0, radiusMm * perMm], skin);
    drawArrow(context, [-direction.xMm, -direction.yMm], (0.85 * radius * feltN) / this.#highN, ink);
    for (const [index, report] of this.#reports.entries()) {
      const [x, y] = local(report);
      if (Math.hypot(x, y) > radius - 6) continue;
      context.globalAlpha = (index + 1) / this.#reports.length;
      drawCircle(context, [x, y, 4.5], { fill: "#ffd23f", stroke: "#000", width: 1.5 });
    }
    context.globalAlpha = 1;
    if (predicted) drawCross(context, local(predicted));
  }

  /**
   * The voltage of the last moments, as the carrier's envelope, in a strip at the bottom.
   * @param {CanvasRenderingContext2D} context
   * @param {number} radius
   * @param {string} ink
   */
  #drawEnvelope(context, radius, ink) {
    const [wide, high] = [1.1 * radius, 0.2 * radius];
    const [left, middle] = [-wide / 2, 0.68 * radius];
    const most = this.#voltagesV.reduce((largest, voltageV) => Math.max(largest, voltageV), ENVELOPE_V);
    const x = (/** @type {number} */ index) => left + (wide * (ENVELOPE - this.#voltagesV.length + index)) / ENVELOPE;
    context.fillStyle = "#000a";
    context.fillRect(left, middle - high / 2 - 2, wide, high + 4);
    context.beginPath();
    for (const [index, voltageV] of this.#voltagesV.entries()) {
      context.lineTo(x(index), middle - (high * voltageV) / most / 2);
    }
    for (let index = this.#voltagesV.length - 1; index >= 0; index -= 1) {
      context.lineTo(x(index), middle + (high * this.#voltagesV[index]) / most / 2);
    }
    context.closePath();
    context.fillStyle = ink;
    context.fill();
  }
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {number[]} direction
 * @param {number} length
 * @param {string} ink
 */
function drawArrow(context, [ux, uy], length, ink) {
  if (!(length > 1) || (ux === 0 && uy === 0)) return;
  context.save();
  context.rotate(Math.atan2(uy, ux));
  context.beginPath();
  context.moveTo(0, -3.5);
  context.lineTo(length - 12, -3.5);
  context.lineTo(length - 12, -9);
  context.lineTo(length, 0);
  context.lineTo(length - 12, 9);
  context.lineTo(length - 12, 3.5);
  context.lineTo(0, 3.5);
  context.closePath();
  context.fillStyle = ink;
  context.fill();
  context.lineWidth = 1.5;
  context.strokeStyle = "#fff";
  context.stroke();
  context.restore();
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {number[]} place
 */
function drawCross(context, [x, y]) {
  for (const [width, ink] of /** @type {const} */ ([[5, "#000"], [2.5, "#7dffb0"]])) {
    context.lineWidth = width;
    context.strokeStyle = ink;
    context.beginPath();
    context.moveTo(x - 9, y);
    context.lineTo(x + 9, y);
    context.moveTo(x, y - 9);
    context.lineTo(x, y + 9);
    context.stroke();
  }
}
