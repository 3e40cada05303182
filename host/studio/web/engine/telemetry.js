// What a board outside of the page reports, as a frame of the engine. Part of the source of the worker `host`.
// @ts-check
"use strict";

/** @typedef {"xMm" | "yMm" | "speedMmPerS" | "referenceN" | "voltageV"} Told The columns that a board tells. */
/** @typedef {Record<Told | "tick", number> & { isTouched: boolean }} Telemetry */

/**
 * Telemetry as a frame of samples. The felt friction and the true place of the finger are unknown to a board.
 * @param {Telemetry[]} telemetry
 * @param {number} tickHz
 * @returns {T.WorkerFrame}
 */
function frameOf(telemetry, tickHz) {
  const column = (/** @type {Told} */ name) => Float32Array.from(telemetry, (sample) => sample[name]);
  const unknown = () => new Float32Array(telemetry.length).fill(NaN);
  const [first, second] = telemetry;
  return {
    firstTick: first.tick,
    tick: telemetry[telemetry.length - 1].tick,
    ticksPerSample: second ? second.tick - first.tick : 1,
    tickHz,
    xMm: column("xMm"),
    yMm: column("yMm"),
    speedMmPerS: column("speedMmPerS"),
    referenceN: column("referenceN"),
    feltN: unknown(),
    voltageV: column("voltageV"),
    predictedXMm: unknown(),
    predictedYMm: unknown(),
    reportedXMm: unknown(),
    reportedYMm: unknown(),
    contactRadiusMm: unknown(),
    contact: telemetry[telemetry.length - 1].isTouched,
    delayMs: 0,
    slowness: 1,
    simulated: false,
  };
}
