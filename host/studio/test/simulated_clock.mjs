// A clock for the page whose time passes in steps, each of which waits until page and board have done what it brings.
//
// However slow the machine is, nothing comes late: a stroke is even, no frame is missing, and no board falls silent.
// Time passes as fast as it can while a test waits for it in the page (`wait`, `hang`). Otherwise it passes no faster
// than that of the machine: what the page shows for some seconds is still there when the test comes to it.

/** Runs in the page before its scripts: see web/clock.js. Workers of boards get the time of each step. */
export function addSimulatedClock() {
  const STEP_MS = 8;
  /** Steps between two pictures of the screen. */
  const STEPS_PER_FRAME = 2;
  let nowMs = Math.ceil(performance.now());
  let steps = 0;
  let isHung = false;
  let timers = [];
  let frames = [];
  /** How many functions of the test wait. */
  let waiting = 0;
  const boards = new Set();
  const epochMs = () => performance.timeOrigin + nowMs;

  globalThis.studioClock = {
    nowMs: () => nowMs,
    startMs: () => performance.timeOrigin,
    later(ms, act) {
      const timer = { atMs: nowMs + ms, act };
      timers.push(timer);
      return timer;
    },
    cancel(timer) {
      timers = timers.filter((each) => each !== timer);
    },
    nextFrame: (act) => frames.push(act),
  };
  globalThis.wait = async (ms) => {
    waiting += 1;
    await new Promise((resolve) => studioClock.later(ms, resolve));
    waiting -= 1;
  };
  /** The page does nothing for this time: it sends no frame and runs no timer, and takes what came at the end. */
  globalThis.hang = async (ms) => {
    isHung = true;
    for (let at = 0; at < ms; at += STEP_MS) await stepBoards();
    isHung = false;
  };
  let lateMs = 0;
  /** From now on each step comes so much later, as that of a computer that is too slow. */
  globalThis.beLate = (ms) => {
    lateMs = ms;
  };
  /** Events happen at the time of this clock. */
  Object.defineProperty(Event.prototype, "timeStamp", { get: () => nowMs, configurable: true });

  const Native = Worker;
  globalThis.Worker = class extends Native {
    constructor(url, options) {
      super(url, options);
      if (options?.name !== "board") return;
      boards.add(this);
      this.postMessage({ type: "time", epochMs: epochMs() });
    }
    terminate() {
      boards.delete(this);
      this.ended?.();
      super.terminate();
    }
    /** Gives the worker the time, and waits until it is there. */
    step() {
      return new Promise((resolve) => {
        this.ended = resolve;
        const listen = ({ data }) => {
          if (data.type !== "answer" || data.id !== "time") return;
          this.removeEventListener("message", listen);
          resolve();
        };
        this.addEventListener("message", listen);
        this.postMessage({ type: "time", id: "time", epochMs: epochMs() });
      });
    }
  };

  async function stepBoards() {
    nowMs += STEP_MS + lateMs;
    steps += 1;
    await Promise.all([...boards].map((board) => board.step()));
  }

  function runDue() {
    const due = timers.filter(({ atMs }) => atMs <= nowMs).sort((a, b) => a.atMs - b.atMs);
    timers = timers.filter(({ atMs }) => atMs > nowMs);
    for (const { act } of due) act();
    if (steps % STEPS_PER_FRAME !== 0) return;
    const now = frames;
    frames = [];
    for (const act of now) act(nowMs);
  }

  const channel = new MessageChannel();
  // A message of its own for each step lets the browser do what else there is to do.
  channel.port1.onmessage = async () => {
    if (!isHung) {
      await stepBoards();
      if (!isHung) runDue();
    }
    if (waiting > 0) channel.port2.postMessage(null);
    else setTimeout(() => channel.port2.postMessage(null), STEP_MS);
  };
  channel.port2.postMessage(null);
}
