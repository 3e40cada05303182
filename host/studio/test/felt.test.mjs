// The page in a browser: what is felt along a slide, and its sound.

import assert from "node:assert/strict";
import { test } from "node:test";
import { WHOLE_SCREEN_GRATING, openStudio, wholeStroke, writeScene } from "./page.mjs";

/**
 * The goal of DESIGN 8: error of the felt friction below 40 Hz over the reference's own AC rms, and correlation. The
 * page's touch source reports 100 times a second, 10 ms late; for that class the goal is meant for features of 10 mm.
 */
const GOAL = { error: 0.25, correlation: 0.9 };
const FEATURES_OF_10_MM = `version = 1

[[layer]]
kind = "grating"
wavelength_mm = 20
low_n = 0.0
high_n = 0.1
`;
/** Mortar of 2 mm is finer than what such reports can follow: its lines are felt, some of them late. */
const BRICK = { error: 0.6, correlation: 0.8 };
const CORNER_HZ = 40;
const SPEED_MM_PER_S = 80;
/** A finger is known to stand still after some reports and 50 ms; noise of the touch source can put that off, ms. */
const STILL_ZERO_MS = 500;
/** Noise of the simulated touch source looks like a slide now and then: the most that a finger at rest is driven. */
const STILL_DRIVEN_MAX = 0.4;
/** Rms voltage that counts as none: what the carrier's last half period leaves of a mean, V. */
const ZERO_V = 2;

/** A first-order low-pass forwards and backwards, so that it delays nothing; samples are 1 ms apart. */
function lowPass(values) {
  const part = 1 - Math.exp((-2 * Math.PI * CORNER_HZ) / 1000);
  const pass = (input) => {
    let state = input[0];
    return input.map((value) => (state += part * (value - state)));
  };
  return pass(pass(values).reverse()).reverse();
}

const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
const rms = (values) => Math.sqrt(mean(values.map((value) => value * value)));

/** Compares what is felt with its reference, registered in place: at the shift of at most 10 ms that suits best. */
function compared(felt, reference) {
  const most = 10;
  const swing = (values) => values.map((value) => value - mean(values));
  const wanted = swing(reference.slice(most, -most));
  const at = (shift) => {
    const found = swing(felt.slice(most + shift, felt.length - most + shift));
    const error = rms(found.map((value, index) => value - wanted[index])) / rms(wanted);
    const correlation = mean(found.map((value, index) => value * wanted[index])) / rms(found) / rms(wanted);
    return { error, correlation, shift, swing: rms(wanted) };
  };
  const shifts = Array.from({ length: 2 * most + 1 }, (_, index) => at(index - most));
  return shifts.reduce((best, each) => (each.error < best.error ? each : best));
}

/** Stops the board. */
const stopOutput = (page) => page.evaluate(() => studioPage.engine.stop());

/** Felt friction and reference along strokes over the scene that plays, below 40 Hz and registered in place. */
async function feltAlong(page, linesMm) {
  const errors = [];
  for (const yMm of linesMm) {
    const way = await wholeStroke(page, yMm);
    // From 150 ms after the touch, while the finger slides.
    const { timeS, xMm, speedMmPerS, feltN, referenceN } = way;
    const touchS = timeS[xMm.findIndex(Number.isFinite)];
    const isOnTheWay = (_, at) => timeS[at] > touchS + 0.15 && xMm[at] < 100 && speedMmPerS[at] > 40;
    const felt = feltN.filter(isOnTheWay);
    assert.ok(felt.length > 500, `${felt.length} samples on the way`);
    errors.push(compared(lowPass(felt), lowPass(referenceN.filter(isOnTheWay))));
  }
  return Object.fromEntries(
    ["error", "correlation", "swing"].map((name) => [name, mean(errors.map((each) => each[name]))]),
  );
}

function assertFelt({ error, correlation, swing }, most, context, what) {
  context.diagnostic(
    `${what}: error ${error.toFixed(3)} of the reference's AC rms, correlation ${correlation.toFixed(3)}`,
  );
  assert.ok(swing > 0.005, "there is a texture");
  assert.ok(error <= most.error, `${what}: error ${error}`);
  assert.ok(correlation >= most.correlation, `${what}: correlation ${correlation}`);
}

test("a slide is felt as the scene has it", async (context) => {
  const page = await openStudio();
  assertFelt(await feltAlong(page, [30, 60, 90]), BRICK, context, "brick");
  await writeScene(page, FEATURES_OF_10_MM);
  assertFelt(await feltAlong(page, [20, 40, 60]), GOAL, context, "features of 10 mm");
  await stopOutput(page);
  const silent = await feltAlong(page, [40]);
  assert.throws(() => assertFelt(silent, GOAL, context, "with the output at zero"));
});

test("a lifted finger gets nothing, and a still one is driven less than while it moves", async (context) => {
  const page = await openStudio();
  // On the rough half, where there is a drive at each place.
  await page.evaluate(async () => played(await studio.text("scenes/constant.toml")));
  const { given, kept } = await page.evaluate(async () => {
    const { engine, samples } = studioPage;
    const take = engine.onFrames;
    const frame = await new Promise((resolve) => (engine.onFrames = resolve));
    engine.onFrames = take;
    const given = Object.keys(frame).filter((name) => frame[name] instanceof Float32Array);
    return { given, kept: Object.keys(samples.since(samples.nowS)).filter((name) => name !== "timeS") };
  });
  assert.deepEqual(kept, given, "the page keeps each column that the module gives to a frame");
  const slideAndRest = async (speedMmPerS) => {
    const { samples } = studioPage;
    const beginS = samples.nowS;
    await slide(15, 105, 60, speedMmPerS);
    await wait(2500);
    const still = samples.since(beginS);
    lift(105, 60);
    await wait(300);
    return { still, lifted: samples.since(samples.nowS - 0.1) };
  };
  const found = await page.evaluate(slideAndRest, SPEED_MM_PER_S);
  const { voltageV, speedMmPerS } = found.still;
  const stoodAt = speedMmPerS.findLastIndex((speed) => speed > 5);
  assert.ok(mean(voltageV.slice(stoodAt - 120, stoodAt - 20)) > 50, "there was a drive while it moved");
  const later = voltageV.slice(stoodAt + STILL_ZERO_MS);
  const driven = later.filter((voltage) => voltage >= ZERO_V).length / later.length;
  context.diagnostic(
    `later than ${STILL_ZERO_MS} ms, noise of the touch source drove ${(100 * driven).toFixed(0)} % of the time`,
  );
  assert.ok(later.length > 1000, `${later.length} samples at rest`);
  assert.ok(driven < STILL_DRIVEN_MAX, `${(100 * driven).toFixed(0)} % of the time`);
  const { voltageV: lifted, xMm } = found.lifted;
  assert.ok(xMm.every(Number.isNaN), "the finger is up");
  assert.ok(lifted.length > 20 && lifted.every((voltage) => voltage < ZERO_V), "zero without a finger");
});

/** Runs in the page: the sound of a slide, as the processor makes it of what the engine gives, and its spectrum. */
async function soundOf(speedMmPerS) {
  const [RATE_HZ, LENGTH, BLOCK] = [48_000, 16_384, 128];
  let Processor;
  globalThis.AudioWorkletProcessor = class {
    port = {};
  };
  globalThis.registerProcessor = (_name, processor) => (Processor = processor);
  globalThis.sampleRate = RATE_HZ;
  const source = await studio.text("page/sound_processor.js");
  await import(URL.createObjectURL(new Blob([source], { type: "text/javascript" })));
  const processor = new Processor();
  const heard = [];
  let isOver = false;
  const { engine } = studioPage;
  const feel = engine.onAudio;
  engine.onAudio = (samples, _tick, slowness) => {
    processor.port.onmessage({ data: { samples, slowness } });
    for (let at = 0; !isOver && at < (samples.length * RATE_HZ) / 40_000; at += BLOCK) {
      const block = new Float32Array(BLOCK);
      processor.process([], [[block]]);
      heard.push(...block);
    }
  };
  await slide(5, 112, 40, speedMmPerS);
  isOver = true;
  engine.onAudio = feel;
  lift(112, 40);
  await wait(300);
  const last = heard.slice(-LENGTH);
  const width = RATE_HZ / LENGTH;
  // Blackman's window, as that of an AnalyserNode.
  const cosine = (at) => Math.cos((2 * Math.PI * at) / LENGTH);
  const window = (at) => 0.42 - 0.5 * cosine(at) + 0.08 * cosine(2 * at);
  const windowed = last.map((value, at) => value * window(at));
  const levelDb = (bin) => {
    let [real, imaginary] = [0, 0];
    for (const [at, value] of windowed.entries()) {
      real += value * Math.cos((2 * Math.PI * bin * at) / LENGTH);
      imaginary += value * Math.sin((2 * Math.PI * bin * at) / LENGTH);
    }
    return 20 * Math.log10(Math.hypot(real, imaginary) / LENGTH);
  };
  const bins = Array.from({ length: Math.floor(1000 / width) }, (_, bin) => bin).filter((bin) => bin * width > 20);
  const levels = bins.map((bin) => ({ hz: bin * width, db: levelDb(bin) }));
  return levels.reduce((best, each) => (each.db > best.db ? each : best));
}

/** Slides over a grating of 2 mm: the peak of the sound is at speed over wavelength. Returns its frequency, Hz. */
async function assertSoundPeakHz(page, speedMmPerS) {
  const { db, hz } = await page.evaluate(soundOf, speedMmPerS);
  assert.ok(db > -30, `no sound: peak ${db} dB`);
  assert.ok(Math.abs(hz - speedMmPerS / 2) <= 0.1 * (speedMmPerS / 2), `${hz} Hz at ${speedMmPerS} mm/s`);
  return hz;
}

test("the sound's peak is speed over wavelength; without output there is none", async (context) => {
  const page = await openStudio();
  await writeScene(page, WHOLE_SCREEN_GRATING);
  for (const speedMmPerS of [100, 150]) {
    const hz = await assertSoundPeakHz(page, speedMmPerS);
    context.diagnostic(`${speedMmPerS} mm/s over 2 mm: ${hz.toFixed(1)} Hz`);
  }
  await stopOutput(page);
  await assert.rejects(assertSoundPeakHz(page, 100), /no sound| Hz at/, "with the output at zero");
});

test("a slide is heard where sound is on", async () => {
  const page = await openStudio();
  await writeScene(page, WHOLE_SCREEN_GRATING);
  await page.click("#tab-sound");
  await page.click("text=Sound on");
  await page.locator("#panel-sound >> text=Sound off").waitFor();
  const isHeard = () => {
    const { analyser } = studioPage.sound;
    const levels = new Float32Array(analyser.frequencyBinCount);
    analyser.getFloatFrequencyData(levels);
    return Math.max(...levels) > -40;
  };
  assert.ok(!(await page.evaluate(isHeard)), "nothing is heard without a finger");
  await page.evaluate(() => {
    const slideOn = () => slide(5, 112, 40, 100).then(slideOn);
    slideOn();
  });
  await page.waitForFunction(isHeard);
});
