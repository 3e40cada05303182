// Borders of a texture along a stroke: where the finger crosses them, and where it is once the board has crossed them.
// @ts-check

/** @typedef {{ xMm: number, yMm: number }} Place */
/** @typedef {"predicted" | "reported"} By Where a board has the finger: with prediction, and without. */
/**
 * A border that the finger has crossed, the direction in which it went, and how much later, in mm of its way, the
 * friction of the other side came; below zero where it came early.
 * @typedef {Place & { ux: number, uy: number, tMs: number, isUp: boolean } & { [each in By]?: number }} Border
 */

/**
 * A border that a board has crossed, and where the finger was then.
 * @typedef {{ by: By, isUp: boolean, tMs: number, at: Place }} Crossing
 */

/** Part of the difference of least and largest friction around their mean, the border, that is on neither side. */
const HYSTERESIS = 0.12;
/** A board crosses a border within this time of the finger, ms, or misses it: 100 reports a second are no later. */
const WITHIN_MS = 60;
/** How far back the direction of the finger is taken from, samples of a millisecond. */
const BACK = 6;
const BORDERS_MAX = 300;

/** Follows on which side of the border a place is: low friction or high. */
class Side {
  /** @type {boolean | undefined} */
  #isHigh;

  /**
   * Returns whether the place has crossed the border, up or down; undefined if it has not.
   * @param {number | undefined} frictionN
   * @param {{ lowN: number, highN: number }} between
   */
  cross(frictionN, { lowN, highN }) {
    if (frictionN === undefined) return undefined;
    const isHigh = frictionN > highN ? true : frictionN < lowN ? false : this.#isHigh;
    const before = this.#isHigh;
    this.#isHigh = isHigh;
    return before === undefined || isHigh === before ? undefined : isHigh;
  }
}

export class Borders {
  /** @type {Border[]} */
  found = [];
  #sides = { finger: new Side(), predicted: new Side(), reported: new Side() };
  /** @type {Crossing[]} */
  #open = [];
  /** @type {Place[]} */
  #way = [];
  #between;
  #tMs = 0;
  #frictionAt;

  /**
   * @param {(xMm: number, yMm: number) => number | undefined} frictionAt
   * @param {Float32Array} frictionN That of the whole map.
   */
  constructor(frictionAt, frictionN) {
    this.#frictionAt = frictionAt;
    let [least, most] = [Infinity, -Infinity];
    for (const each of frictionN) {
      least = Math.min(least, each);
      most = Math.max(most, each);
    }
    const mean = (least + most) / 2;
    const half = HYSTERESIS * (most - least);
    this.#between = { lowN: mean - half, highN: mean + half };
  }

  /**
   * Takes a sample of the stroke: where the finger is, and where a board has it.
   * @param {number} tMs
   * @param {Place} finger
   * @param {Record<By, Place>} board
   */
  add(tMs, finger, board) {
    this.#tMs = tMs;
    this.#way.push(finger);
    if (this.#way.length > BACK + 1) this.#way.shift();
    const isUp = this.#crossed("finger", finger);
    const [from] = this.#way;
    const length = Math.hypot(finger.xMm - from.xMm, finger.yMm - from.yMm);
    if (isUp !== undefined && length > 0 && this.found.length < BORDERS_MAX) {
      const [ux, uy] = [(finger.xMm - from.xMm) / length, (finger.yMm - from.yMm) / length];
      this.found.push({ ...finger, ux, uy, tMs, isUp });
    }
    for (const by of /** @type {By[]} */ (["predicted", "reported"])) {
      const side = this.#crossed(by, board[by]);
      if (side !== undefined) this.#open.push({ by, isUp: side, tMs, at: finger });
    }
    // The finger may cross later than the board.
    const isOver = (/** @type {Crossing} */ crossing) => tMs - crossing.tMs >= WITHIN_MS;
    for (const crossing of this.#open.filter(isOver)) this.#match(crossing);
    this.#open = this.#open.filter((crossing) => !isOver(crossing));
  }

  /** The stroke is over. */
  end() {
    for (const crossing of this.#open.splice(0)) this.#match(crossing);
  }

  /**
   * @param {"finger" | By} who
   * @param {Place} place
   */
  #crossed(who, { xMm, yMm }) {
    return this.#sides[who].cross(this.#frictionAt(xMm, yMm), this.#between);
  }

  /**
   * The border that the finger has crossed nearest in time is the one that the board has crossed, unless it has before.
   * @param {Crossing} crossing
   */
  #match({ by, isUp, tMs, at }) {
    const apart = (/** @type {Border} */ border) => Math.abs(border.tMs - tMs);
    const near = this.found.filter((border) => border.isUp === isUp && apart(border) < WITHIN_MS);
    if (near.length === 0) return;
    const border = near.reduce((best, each) => (apart(each) < apart(best) ? each : best));
    border[by] ??= (at.xMm - border.xMm) * border.ux + (at.yMm - border.yMm) * border.uy;
  }

  /** How many lines the finger has come upon: borders where friction rises. */
  get lines() {
    return this.found.filter(({ isUp }) => isUp).length;
  }

  /** How many of them a board without prediction has jumped over. */
  get missed() {
    const isKnown = (/** @type {Border} */ border) => this.#tMs - border.tMs > 2 * WITHIN_MS;
    return this.found.filter((border) => border.isUp && border.reported === undefined && isKnown(border)).length;
  }

  /**
   * The mean size of the lags so far, mm; undefined without one.
   * @param {By} by
   */
  meanMm(by) {
    const lags = this.found.map((border) => border[by]).filter((lag) => lag !== undefined);
    return lags.length > 0 ? lags.reduce((sum, lag) => sum + Math.abs(lag), 0) / lags.length : undefined;
  }
}
