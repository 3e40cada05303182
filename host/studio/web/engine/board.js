// The worker of the simulated board: firmware and world, paced by the clock, moved by the pointer.
//
// Virtual time follows the page's clock. A sample of the pointer is played DELAY_MS after it was taken, so that the
// next sample is here in time and the finger can be interpolated between both.
"use strict";

const TICKS_PER_MS = 40;
/** Delay between the pointer and the finger, ms: two samples of a 60 Hz display, and a step of this worker. */
const DELAY_MS = 40;
/** Time between two steps of this worker, ms. */
const STEP_MS = 8;
/** A worker that was held up longer than this, ms, skips the time in place of running after it. */
const LAG_MAX_MS = 100;
/** Without a sign of life the board is stepped on for this long, ms, so that its host timeout acts; then it rests. */
const REST_AFTER_MS = 2000;
/** Samples of a stroke that a replay can have. */
const STROKE_MAX = 4000;

let engine;
/** Virtual time: tick `tick` was at `ms`, and time passes `rate` times as fast as the clock. */
let clock = { tick: 0, ms: 0, rate: 1 };
let lastLifeMs = -Infinity;
/** The samples of the last stroke, and whether it is still under way. */
let stroke = { samples: [], isOver: true };
/** The end of a replay, and what to do then. */
let replay = null;
let reported = "";

function tickAt(ms) {
  return clock.tick + (ms - clock.ms) * TICKS_PER_MS * clock.rate;
}

function setClock(rate) {
  clock = { tick: engine.plain("simulator_tick"), ms: epochMs(), rate };
}

function step() {
  const now = epochMs();
  const sinceLifeMs = now - lastLifeMs;
  if (sinceLifeMs > REST_AFTER_MS) {
    setClock(clock.rate);
    return;
  }
  let ticks = Math.floor(tickAt(now) - engine.plain("simulator_tick"));
  if (ticks > LAG_MAX_MS * TICKS_PER_MS) {
    setClock(clock.rate);
    ticks = STEP_MS * TICKS_PER_MS;
  }
  if (ticks > 0) run(ticks, sinceLifeMs <= LIFE_MS);
  if (replay && engine.plain("simulator_tick") >= replay.endTick) endReplay(true);
}

function run(ticks, isAlive) {
  const buffer = engine.callForBytes("simulator_run", null, ticks, isAlive ? 1 : 0);
  const [tick, firstTick, ticksPerSample, count, soundCount, state, fault, contact] = new Float64Array(buffer, 0, 8);
  const column = (index) => new Float32Array(buffer, 64 + 4 * count * index, count);
  const frame = { tick, firstTick, ticksPerSample, contact: contact !== 0, simulated: true };
  Object.assign(frame, { slowness: 1 / clock.rate, delayMs: DELAY_MS });
  for (const [index, name] of ["xMm", "yMm", "speedMmPerS", "referenceN", "feltN", "voltageV"].entries()) {
    frame[name] = column(index);
  }
  const sound = new Float32Array(buffer, 64 + 4 * count * 6, soundCount);
  reportState(state, fault);
  self.postMessage({ type: "frame", frame, sound, soundTick: tick - soundCount + 1 }, [buffer]);
}

function reportState(state, fault) {
  const now = `${state} ${fault}`;
  if (now === reported) return;
  reported = now;
  self.postMessage({ type: "state", ...engine.call("state_words", null, state, fault) });
}

function addSample({ xMm, yMm, down, loadN }, tick) {
  engine.plain("simulator_pointer", tick, xMm, yMm, down ? 1 : 0, loadN ?? 0);
}

/** Remembers the samples from one touch to its lift. */
function remember(sample) {
  if (stroke.isOver && sample.down) stroke = { samples: [], isOver: false };
  if (!stroke.isOver && stroke.samples.length < STROKE_MAX) stroke.samples.push(sample);
  stroke.isOver = !sample.down;
}

function endReplay(isWhole) {
  const { resolve } = replay;
  replay = null;
  if (!isWhole) engine.plain("simulator_lift");
  setClock(1);
  resolve({ isWhole });
}

serve({
  async start({ module, seed }) {
    engine = await Engine.start(module);
    engine.call("simulator_start", null, seed ?? 1);
    setClock(1);
    setInterval(step, STEP_MS);
    return {};
  },

  play: ({ scene }) => engine.call("simulator_play", requestOf(scene)),
  stop: () => engine.call("simulator_stop"),
  resume: () => engine.call("simulator_resume"),
  control: ({ line }) => engine.call("simulator_control", new TextEncoder().encode(line)),

  pointer({ sample }) {
    // A press takes the finger back from a replay.
    if (replay && sample.down) endReplay(false);
    if (replay) return;
    remember(sample);
    addSample(sample, tickAt(sample.epochMs + DELAY_MS));
  },

  /** Plays the samples of the last stroke again while time passes slowly. */
  replay({ slowness }) {
    const { samples } = stroke;
    if (samples.length === 0) throw new Error("nothing to replay: slide over the scene first");
    if (!(slowness > 0)) throw new Error(`slowness is ${slowness}: give a number above 0`);
    if (replay) endReplay(false);
    setClock(1 / slowness);
    engine.plain("simulator_lift");
    const start = clock.tick + STEP_MS * TICKS_PER_MS;
    const tickOf = (sample) => start + (sample.epochMs - samples[0].epochMs) * TICKS_PER_MS;
    const last = samples[samples.length - 1];
    for (const sample of samples) addSample(sample, tickOf(sample));
    const endTick = tickOf(last) + STEP_MS * TICKS_PER_MS;
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
