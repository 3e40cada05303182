// The worker of the simulated board: firmware and world, paced by the clock, moved by the pointer.
//
// Virtual time follows the page's clock. A sample of the pointer is played DELAY_MS after it was taken, so that the
// next sample is here in time and the finger can be interpolated between both.
// @ts-check
"use strict";

/** Delay between the pointer and the finger, ms: two samples of a 60 Hz display, and a step of this worker. */
const DELAY_MS = 40;
/** Time between two steps of this worker, ms: while something happens, and while no finger is on the board. */
const STEP_MS = 8;
const IDLE_STEP_MS = 96;
/** After a touch or a message the worker goes on with short steps for this long, ms. */
const IDLE_AFTER_MS = 1000;
/** A worker that was held up longer than this, ms, skips the time in place of running after it. */
const LAG_MAX_MS = 100;
/**
 * So much time is looked at to see how much of it the board plays, ms; more than this part is all of it: a computer is
 * held up now and then.
 */
const PACE_MS = 2000;
const PACE_WHOLE = 0.9;
/** Without a sign of life the board is stepped on for this long, ms, so that its host timeout acts; then it rests. */
const REST_AFTER_MS = 2000;
/** Samples of a stroke that a replay can have. */
const STROKE_MAX = 4000;

/** @type {Engine} */
let engine;
/** Virtual time: tick `tick` was at `ms`, and time passes `rate` times as fast as the clock. */
let clock = { tick: 0, ms: 0, rate: 1 };
/**
 * The samples of the last stroke, and whether it is still under way.
 * @type {{ samples: T.PointerSample[], isOver: boolean }}
 */
let stroke = { samples: [], isOver: true };
/**
 * The end of a replay, and what to do then.
 * @type {{ endTick: number, resolve: (answer: { isWhole: boolean }) => void } | null}
 */
let replay = null;
let reported = "";
/** Since when time is counted, since 1970, ms; the ticks that were played since; and the pace that was told. */
let counted = { sinceMs: 0, ticks: 0, told: 1 };
/** Until then steps are short, and when the last one was, since 1970, ms. */
let busyUntilMs = 0;
let steppedMs = 0;

/** Something happens: the board is brought up to now, and steps are short for a while. */
function wake() {
  const isIdle = epochMs() > busyUntilMs;
  busyUntilMs = epochMs() + IDLE_AFTER_MS;
  if (isIdle) step();
}

/** @param {number} ms */
function ticksIn(ms) {
  return (ms * engine.layouts.tickHz) / 1000;
}

/** @param {number} ms */
function tickAt(ms) {
  return clock.tick + ticksIn(ms - clock.ms) * clock.rate;
}

/** @param {number} rate How fast time passes. */
function setClock(rate) {
  clock = { tick: engine.plain("simulator_tick"), ms: epochMs(), rate };
}

function step() {
  const now = epochMs();
  if (now > busyUntilMs && !replay && now - steppedMs < IDLE_STEP_MS) return;
  steppedMs = now;
  const sinceLifeMs = now - lastLifeMs;
  if (sinceLifeMs > REST_AFTER_MS) {
    setClock(clock.rate);
    countAnew();
    return;
  }
  let ticks = Math.floor(tickAt(now) - engine.plain("simulator_tick"));
  if (ticks > ticksIn(LAG_MAX_MS)) {
    // The finger does not slide its way of the skipped time at once: it is lifted, and comes down where that ends.
    if (!replay) engine.plain("simulator_lift");
    setClock(clock.rate);
    ticks = ticksIn(STEP_MS);
  }
  if (ticks > 0) run(ticks, sinceLifeMs <= LIFE_MS);
  count(ticks);
  if (replay && engine.plain("simulator_tick") >= replay.endTick) endReplay(true);
}

function countAnew() {
  counted = { ...counted, sinceMs: epochMs(), ticks: 0 };
}

/**
 * Tells how much of the time is played where that changes: time that a slow computer skips is felt as steps.
 * @param {number} ticks That were played now.
 */
function count(ticks) {
  // A board without a finger is stepped seldom, and a replay is slow on purpose.
  if (epochMs() > busyUntilMs || replay || counted.sinceMs === 0) {
    tellPace(1);
    countAnew();
  }
  counted.ticks += ticks;
  const ms = epochMs() - counted.sinceMs;
  if (ms < PACE_MS) return;
  const part = counted.ticks / ticksIn(ms);
  tellPace(part > PACE_WHOLE ? 1 : Math.ceil(10 * part) / 10);
  countAnew();
}

/** @param {number} pace */
function tellPace(pace) {
  if (pace !== counted.told) tell({ type: "pace", pace });
  counted.told = pace;
}

/**
 * @param {number} ticks
 * @param {boolean} isAlive
 */
function run(ticks, isAlive) {
  const buffer = engine.callForBytes("simulator_run", null, ticks, isAlive ? 1 : 0);
  const { frameHead, frameColumns } = engine.layouts;
  const head = named(frameHead, new Float64Array(buffer, 0, frameHead.length));
  const { tick, firstTick, ticksPerSample, samples, soundSamples } = head;
  const after = (/** @type {number} */ columns) => 8 * frameHead.length + 4 * samples * columns;
  const columns = frameColumns.map((_, index) => new Float32Array(buffer, after(index), samples));
  const sound = new Float32Array(buffer, after(frameColumns.length), soundSamples);
  const frame = {
    .../** @type {T.Columns} */ (named(frameColumns, columns)),
    tick,
    firstTick,
    ticksPerSample,
    tickHz: engine.layouts.tickHz,
    contact: head.contact !== 0,
    simulated: true,
    slowness: 1 / clock.rate,
    delayMs: DELAY_MS,
  };
  reportState(head.state, head.fault);
  if (frame.contact) busyUntilMs = epochMs() + IDLE_AFTER_MS;
  tell({ type: "frame", frame, sound, soundTick: tick - soundSamples + 1 }, [buffer]);
}

/**
 * @param {number} state
 * @param {number} fault
 */
function reportState(state, fault) {
  const now = `${state} ${fault}`;
  if (now === reported) return;
  reported = now;
  tell({ type: "state", ...engine.call("state_words", null, state, fault) });
}

/**
 * @param {T.PointerSample} sample
 * @param {number} tick
 */
function addSample({ xMm, yMm, down, loadN }, tick) {
  engine.plain("simulator_pointer", tick, xMm, yMm, down ? 1 : 0, loadN ?? 0);
}

/**
 * Remembers the samples from one touch to its lift.
 * @param {T.PointerSample} sample
 */
function remember(sample) {
  if (stroke.isOver && sample.down) stroke = { samples: [], isOver: false };
  if (!stroke.isOver && stroke.samples.length < STROKE_MAX) stroke.samples.push(sample);
  stroke.isOver = !sample.down;
}

/** @param {boolean} isWhole */
function endReplay(isWhole) {
  if (!replay) return;
  const { resolve } = replay;
  replay = null;
  if (!isWhole) engine.plain("simulator_lift");
  setClock(1);
  resolve({ isWhole });
}

serve({
  async start(message) {
    compiled = message.module;
    engine = await Engine.start();
    engine.call("simulator_start", null, message.seed ?? 1);
    setClock(1);
    repeat(step, STEP_MS);
    return {};
  },

  play({ scene }) {
    wake();
    return engine.call("simulator_play", requestOf(scene));
  },
  stop() {
    wake();
    return engine.call("simulator_stop");
  },
  resume() {
    wake();
    return engine.call("simulator_resume");
  },
  control({ line }) {
    wake();
    return engine.call("simulator_control", new TextEncoder().encode(line));
  },

  pointer({ sample }) {
    if (sample.down) wake();
    // A press takes the finger back from a replay.
    if (replay && sample.down) endReplay(false);
    if (replay) return;
    remember(sample);
    addSample(sample, tickAt(sample.epochMs + DELAY_MS));
  },

  lift() {
    if (replay) return;
    engine.plain("simulator_lift");
    stroke.isOver = true;
  },

  /** Plays the samples of the last stroke again while time passes slowly. */
  replay({ slowness }) {
    const { samples } = stroke;
    if (samples.length === 0) throw new Error("nothing to replay: slide over the scene first");
    if (!(slowness > 0)) throw new Error(`slowness is ${slowness}: give a number above 0`);
    if (replay) endReplay(false);
    setClock(1 / slowness);
    engine.plain("simulator_lift");
    const start = clock.tick + ticksIn(STEP_MS);
    const tickOf = (/** @type {T.PointerSample} */ { epochMs }) => start + ticksIn(epochMs - samples[0].epochMs);
    const last = samples[samples.length - 1];
    for (const sample of samples) addSample(sample, tickOf(sample));
    const endTick = tickOf(last) + ticksIn(STEP_MS);
    addSample({ ...last, down: false }, endTick);
    return new Promise((resolve) => {
      replay = { endTick, resolve };
    });
  },

  endReplay() {
    if (replay) endReplay(false);
    return {};
  },

  alive() {
    lastLifeMs = epochMs();
  },
  gone() {
    lastLifeMs = Math.min(lastLifeMs, epochMs() - LIFE_MS - 1);
  },
});
