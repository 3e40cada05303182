// The page in a browser: what is kept of a slide, and its sound.

import assert from "node:assert/strict";
import { test } from "node:test";
import { WHOLE_SCREEN_GRATING, openStudio, wholeStroke, writeScene } from "./page.mjs";

/** Rms voltage that counts as none: what the carrier's last half period leaves of a mean, V. */
const ZERO_V = 2;

/** Stops the board. */
const stopOutput = (page) => page.evaluate(() => studioPage.engine.stop());

test("the page keeps all that is felt, and a lifted finger gets nothing", async () => {
  const page = await openStudio();
  const { given, kept } = await page.evaluate(async () => {
    const { engine, samples } = studioPage;
    const take = engine.onFrames;
    const frame = await new Promise((resolve) => (engine.onFrames = resolve));
    engine.onFrames = take;
    const given = Object.keys(frame).filter((name) => frame[name] instanceof Float32Array);
    return { given, kept: Object.keys(samples.since(samples.nowS)).filter((name) => name !== "timeS") };
  });
  assert.deepEqual(kept, given, "the page keeps each column that the module gives to a frame");
  const { voltageV, xMm } = await wholeStroke(page, 60);
  const last = (values) => values.slice(-100);
  assert.ok(Math.max(...voltageV) > 50 && last(xMm).every(Number.isNaN), "the finger was driven, and is up");
  assert.ok(last(voltageV).every((voltage) => voltage < ZERO_V), "zero without a finger");
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
  engine.onAudio = (samples, _tick, samplesPerS) => {
    processor.port.onmessage({ data: { samples, samplesPerS } });
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
