// The page's clock: the time, timers and the next picture of the screen.
//
// A test gives the page another one, as `globalThis.studioClock`, and lets its time pass.
// @ts-check

/**
 * @typedef {object} Clock
 * @property {() => number} nowMs Time since the document's start, ms: that of an event's `timeStamp`.
 * @property {() => number} startMs Time of the document's start since 1970, ms.
 * @property {(ms: number, act: () => void) => number} later Calls `act` once, after this time; returns the timer.
 * @property {(timer: number | undefined) => void} cancel Ends a timer.
 * @property {(act: (nowMs: number) => void) => void} nextFrame Calls `act` before the next picture of the screen.
 */

/** @type {Clock} */
const ofTheMachine = {
  nowMs: () => performance.now(),
  startMs: () => performance.timeOrigin,
  later: (ms, act) => setTimeout(act, ms),
  cancel: (timer) => clearTimeout(timer),
  nextFrame: (act) => void requestAnimationFrame(act),
};

export const clock = globalThis.studioClock ?? ofTheMachine;

/**
 * Resolves, to nothing, after this time.
 * @param {number} ms
 * @returns {Promise<void>}
 */
export function after(ms) {
  return new Promise((resolve) => clock.later(ms, resolve));
}
