// The last seconds of what was felt, for the scope and for files.
// @ts-check

/** @import { Column, Frame } from "../engine/types" */

/** Most samples that are kept. */
const CAPACITY = 40_000;
/** Without a touch for this long, s, nothing is kept, so that the last strokes stay. */
const IDLE_S = 1;

/**
 * What is kept of a sample: its time and the columns of a frame, with the names that files give them.
 * @type {Record<"timeS" | Column, string>}
 */
const NAMES = {
  timeS: "t_s",
  xMm: "x_mm",
  yMm: "y_mm",
  speedMmPerS: "speed_mm_s",
  referenceN: "reference_n",
  feltN: "felt_n",
  voltageV: "voltage_v_rms",
  predictedXMm: "predicted_x_mm",
  predictedYMm: "predicted_y_mm",
  reportedXMm: "reported_x_mm",
  reportedYMm: "reported_y_mm",
  contactRadiusMm: "contact_radius_mm",
};
const [, ...COLUMNS] = /** @type {["timeS", ...Column[]]} */ (Object.keys(NAMES));

/**
 * Something for the time of samples and for each column of frames.
 * @template Values
 * @typedef {Record<"timeS" | Column, Values>} Stored
 */

/**
 * @template Values
 * @param {(name: "timeS" | Column) => Values} make
 * @returns {Stored<Values>}
 */
function forEach(make) {
  const entries = /** @type {const} */ (["timeS", ...COLUMNS]).map((name) => [name, make(name)]);
  return Object.fromEntries(entries);
}

export class Samples {
  #data = forEach(() => new Float64Array(CAPACITY));
  #next = 0;
  count = 0;
  /** Time of the newest sample, s of board time. */
  nowS = 0;
  #touchedS = 0;

  /** @param {Frame} frame */
  add(frame) {
    const { firstTick, ticksPerSample, tickHz, feltN, xMm, contact } = frame;
    // In slow motion there are frames without a sample.
    if (feltN.length === 0) return;
    const startS = firstTick / tickHz;
    // A board that was reset counts from zero again.
    if (startS < this.nowS - 0.01) this.clear();
    for (let at = 0; at < feltN.length; at += 1) {
      this.nowS = startS + (at * ticksPerSample) / tickHz;
      if (contact || Number.isFinite(xMm[at])) this.#touchedS = this.nowS;
      if (this.nowS - this.#touchedS > IDLE_S) continue;
      this.#data.timeS[this.#next] = this.nowS;
      for (const name of COLUMNS) this.#data[name][this.#next] = frame[name][at];
      this.#next = (this.#next + 1) % CAPACITY;
      this.count = Math.min(this.count + 1, CAPACITY);
    }
  }

  clear() {
    this.count = 0;
    this.#next = 0;
    this.nowS = 0;
    this.#touchedS = 0;
  }

  /**
   * Columns of the samples since `fromS`, oldest first.
   * @param {number} fromS
   * @returns {Stored<number[]>}
   */
  since(fromS) {
    const oldest = this.#next - this.count + CAPACITY;
    let first = this.count;
    while (first > 0 && this.#data.timeS[(oldest + first - 1) % CAPACITY] >= fromS) first -= 1;
    return forEach((name) => {
      const column = this.#data[name];
      const values = [];
      for (let at = first; at < this.count; at += 1) values.push(column[(oldest + at) % CAPACITY]);
      return values;
    });
  }

  /**
   * Samples of a time as text, a row each.
   * @param {number} fromS
   * @param {number} toS
   */
  csv(fromS, toS) {
    const columns = this.since(fromS);
    const rows = [Object.values(NAMES).join(",")];
    for (let at = 0; at < columns.timeS.length && columns.timeS[at] <= toS; at += 1) {
      const row = Object.values(columns).map((values) => values[at]);
      rows.push(row.map((value) => (Number.isFinite(value) ? Number(value.toFixed(6)) : "")).join(","));
    }
    return `${rows.join("\n")}\n`;
  }
}
