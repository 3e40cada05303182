// What a board outside of the page reports, as a frame of the engine. Part of the source of the worker `host`.
// @ts-check
"use strict";

/** @typedef {{ tick: number, isTouched: boolean } & { [Name in T.Column]?: number }} Telemetry */

/**
 * Telemetry as a frame of samples with these columns. What a board does not tell is not-a-number.
 * @param {Telemetry[]} telemetry
 * @param {number} tickHz
 * @param {string[]} columns
 * @returns {T.WorkerFrame}
 */
function frameOf(telemetry, tickHz, columns) {
  const [first, second] = telemetry;
  const last = telemetry[telemetry.length - 1];
  const values = /** @type {T.Column[]} */ (columns).map((name) =>
    Float32Array.from(telemetry, (sample) => sample[name] ?? NaN),
  );
  return {
    .../** @type {T.Columns} */ (named(columns, values)),
    firstTick: first.tick,
    tick: last.tick,
    ticksPerSample: second ? second.tick - first.tick : 1,
    tickHz,
    contact: last.isTouched,
    delayMs: 0,
    slowness: 1,
    simulated: false,
  };
}
