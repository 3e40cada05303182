// The page in a browser: what is felt along a slide, mistakes and mending, sound, and what nobody should give it.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { after, test } from "node:test";
import { deflateRawSync } from "node:zlib";
import { cleanUp, openPage, pageUrl, required } from "./harness.mjs";

/**
 * The goal of DESIGN 8: error of the felt friction below 40 Hz over the reference's own AC rms, and correlation. The
 * page's touch source reports 100 times a second, 10 ms late; for that class the goal is meant for features of 10 mm.
 */
const GOAL = { error: 0.25, correlation: 0.9 };
const FEATURES_OF_10_MM = `version = 2

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
const STILL_DRIVEN_MAX = 0.75;
/** Rms voltage that counts as none: what the carrier's last half period leaves of a mean, V. */
const ZERO_V = 2;
/** A mended scene plays on within 300 ms on a machine of one's own; the tests share theirs, ms. */
const MENDED_MAX_MS = 1500;

after(cleanUp);

/** Opens the page and waits until its first scene plays. */
async function openStudio(url = pageUrl) {
  const opened = await openPage(url);
  await opened.page.waitForFunction(() => globalThis.studioPage && document.documentElement.dataset.state === "active");
  await opened.page.waitForFunction(() => document.getElementById("check").textContent === "plays");
  await opened.page.evaluate(addHelpers);
  return opened;
}

/** Runs in the page. */
function addHelpers() {
  const canvas = document.getElementById("map-finger");
  const send = (type, xMm, yMm, timeStamp) => {
    const box = canvas.getBoundingClientRect();
    const { scale } = studioPage.map;
    const place = { clientX: box.left + xMm * scale, clientY: box.top + yMm * scale };
    const event = new PointerEvent(type, { ...place, pointerId: 1, button: 0, bubbles: true });
    if (timeStamp !== undefined) Object.defineProperty(event, "timeStamp", { value: timeStamp });
    canvas.dispatchEvent(event);
  };
  /**
   * Slides along x at a constant speed, with an event for each 8 ms, and leaves the finger down. The events are sent
   * ahead with their times, so that the stroke is even however busy the machine is. Resolves at its end.
   */
  globalThis.slide = (fromMm, toMm, yMm, speedMmPerS) => {
    const begin = performance.now();
    const durationMs = (1000 * (toMm - fromMm)) / speedMmPerS;
    send("pointerdown", fromMm, yMm, begin);
    for (let ms = 8; ms <= durationMs; ms += 8) {
      send("pointermove", fromMm + (speedMmPerS * ms) / 1000, yMm, begin + ms);
    }
    return wait(durationMs);
  };
  globalThis.lift = (xMm, yMm) => send("pointerup", xMm, yMm);
  /** Resolves once the simulator runs: a busy machine may hold the page up. */
  globalThis.running = async () => {
    const { samples } = studioPage;
    for (let since = samples.nowS; samples.nowS < since + 0.1;) await wait(20);
  };
  globalThis.wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
  globalThis.played = (text) =>
    new Promise((resolve) => {
      const { player, editor } = studioPage;
      const before = player.onPlay;
      player.onPlay = (now) => {
        before(now);
        if (now !== text) return;
        player.onPlay = before;
        resolve(performance.now());
      };
      editor.text = text;
    });
}

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

/** Felt friction and reference along strokes over the scene that plays, below 40 Hz and registered in place. */
async function feltAlong(page, linesMm) {
  const errors = [];
  for (const yMm of linesMm) {
    const way = await page.evaluate(
      async ([yMm, speedMmPerS]) => {
        const { samples } = studioPage;
        await running();
        const beginS = samples.nowS;
        await slide(15, 105, yMm, speedMmPerS);
        await wait(150);
        lift(105, yMm);
        await wait(200);
        return samples.since(beginS);
      },
      [yMm, SPEED_MM_PER_S],
    );
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
  const { page, errors, close } = await openStudio();
  assertFelt(await feltAlong(page, [30, 60, 90]), BRICK, context, "brick");
  await page.evaluate((text) => played(text), FEATURES_OF_10_MM);
  assertFelt(await feltAlong(page, [20, 40, 60]), GOAL, context, "features of 10 mm");
  await page.evaluate(() => studioPage.engine.stop());
  const silent = await feltAlong(page, [40]);
  assert.throws(() => assertFelt(silent, GOAL, context, "with the output at zero"));
  assert.deepEqual(errors, []);
  await close();
});

test("a lifted finger gets nothing, and a still one is driven less than while it moves", async (context) => {
  const { page, errors, close } = await openStudio();
  const found = await page.evaluate(async (speedMmPerS) => {
    const { samples } = studioPage;
    // On the rough half, where there is a drive at each place.
    await played(await studio.text("scenes/constant.toml"));
    await running();
    await slide(15, 105, 60, speedMmPerS);
    const stillS = samples.nowS;
    await wait(2500);
    const still = samples.since(stillS - 0.1);
    lift(105, 60);
    await wait(300);
    return { still, lifted: samples.since(samples.nowS - 0.1) };
  }, SPEED_MM_PER_S);
  const { voltageV, speedMmPerS } = found.still;
  const stoodAt = speedMmPerS.findLastIndex((speed) => speed > 5);
  assert.ok(voltageV[stoodAt - 20] > 50, "there was a drive while it moved");
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
  assert.deepEqual(errors, []);
  await close();
});

test("a typed mistake shows the sentence of `frixel scene check`, and the mended scene plays on", async (context) => {
  const { page, errors, close } = await openStudio();
  const good = fs.readFileSync(new URL("../../../scenes/grating.toml", import.meta.url), "utf8");
  await page.evaluate((text) => played(text), good);
  const line = good.split("\n").findIndex((each) => each.startsWith("kind =")) + 1;
  await page.evaluate((line) => studioPage.editor.goTo(undefined, line), line);
  await page.keyboard.press("End");
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.type("x");
  const shown = page.locator("#problems li.error");
  await shown.waitFor();
  const bad = await page.evaluate(() => studioPage.editor.text);
  const file = path.join(fs.mkdtempSync(path.join(os.tmpdir(), "frixel-page-")), "scene.toml");
  fs.writeFileSync(file, bad);
  let said = "";
  try {
    execFileSync(required("FRIXEL"), ["scene", "check", file], { encoding: "utf8", stdio: "pipe" });
  } catch ({ stdout, stderr }) {
    said = stdout + stderr;
  }
  const [, sentence] = /scene\.toml:\d+:\d+: (.+)/.exec(said);
  assert.equal(await shown.evaluate((item) => item.lastChild.textContent), sentence);
  assert.ok(sentence.includes("gratingx"), sentence);
  await page.locator(".cm-lintRange-error").waitFor();
  assert.equal(
    await page.evaluate(() => document.documentElement.dataset.state),
    "active",
    "the scene before plays on",
  );
  await page.evaluate(() => {
    globalThis.mended = new Promise((resolve) => {
      const { player, editor } = studioPage;
      const before = player.onPlay;
      let changedMs;
      document.addEventListener("keydown", () => (changedMs ??= performance.now()), { capture: true, once: true });
      player.onPlay = (text) => {
        before(text);
        if (text === editor.text) resolve(performance.now() - changedMs);
      };
    });
  });
  await page.keyboard.press("Backspace");
  const ms = await page.evaluate(() => mended);
  context.diagnostic(`plays on ${ms.toFixed(0)} ms after the key`);
  assert.ok(ms <= MENDED_MAX_MS, `${ms} ms`);
  assert.equal(await shown.count(), 0);
  assert.equal(await page.evaluate(() => studioPage.editor.text), good);
  assert.deepEqual(errors, []);
  await close();
});

const WHOLE_SCREEN_GRATING = `version = 2

[[layer]]
kind = "grating"
wavelength_mm = 2
low_n = 0.0
high_n = 0.1
`;

/** Slides over a grating of 2 mm: the peak of the sound is at speed over wavelength. Returns its frequency, Hz. */
async function assertSoundPeakHz(page, speedMmPerS) {
  const { peak, floor, hz } = await page.evaluate(async (speedMmPerS) => {
    const { analyser } = studioPage.sound;
    const width = analyser.context.sampleRate / analyser.fftSize;
    const bins = [...Array(analyser.frequencyBinCount).keys()].filter((bin) => bin * width > 20 && bin * width < 1000);
    let found = { peak: -Infinity };
    const listen = () => {
      const levels = new Float32Array(analyser.frequencyBinCount);
      analyser.getFloatFrequencyData(levels);
      const peak = bins.reduce((best, bin) => (levels[bin] > levels[best] ? bin : best));
      const sorted = bins.map((bin) => levels[bin]).sort((a, b) => a - b);
      if (levels[peak] > found.peak)
        found = { peak: levels[peak], floor: sorted[sorted.length >> 1], hz: peak * width };
    };
    // What was heard before dies away: the analyser holds a third of a second.
    await wait(500);
    let isOver = false;
    slide(5, 112, 40, speedMmPerS).then(() => (isOver = true));
    while (!isOver) {
      await wait(30);
      listen();
    }
    lift(112, 40);
    return found;
  }, speedMmPerS);
  assert.ok(peak > -30, `no sound: peak ${peak} dB, median ${floor} dB`);
  assert.ok(Math.abs(hz - speedMmPerS / 2) <= 0.1 * (speedMmPerS / 2), `${hz} Hz at ${speedMmPerS} mm/s`);
  return hz;
}

test("the sound's peak is speed over wavelength; without output there is none", async (context) => {
  const { page, errors, close } = await openStudio();
  await page.evaluate((text) => played(text), WHOLE_SCREEN_GRATING);
  await page.click("#tab-sound");
  await page.click("text=Sound on");
  await page.locator("text=Sound off").waitFor();
  for (const speedMmPerS of [100, 150]) {
    const hz = await assertSoundPeakHz(page, speedMmPerS);
    context.diagnostic(`${speedMmPerS} mm/s over 2 mm: ${hz.toFixed(1)} Hz`);
  }
  await page.evaluate(() => studioPage.engine.stop());
  await assert.rejects(assertSoundPeakHz(page, 100), /no sound| Hz at/, "with the output at zero");
  assert.deepEqual(errors, []);
  await close();
});

/** The page is there, plays, and says this. */
async function assertSays(page, expected) {
  await page.waitForFunction(
    (source) => {
      const shown = [...document.querySelectorAll("#problems li.error, #notice:not([hidden]) span")];
      return shown.some((each) => new RegExp(source).test(each.textContent));
    },
    expected.source,
    { timeout: 10_000 },
  );
  // On a busy machine the page may be held up, and the board disarmed, until the page lives again.
  await page.waitForFunction(() => document.documentElement.dataset.state === "active");
  assert.ok(await page.locator("#map-picture").isVisible());
  await page.evaluate(() => (document.getElementById("notice").hidden = true));
}

/** Opens files of these names and contents, as a person does. */
async function give(page, ...files) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "frixel-page-"));
  for (const [name, content] of files) fs.writeFileSync(path.join(folder, name), content);
  await page.setInputFiles(
    "#files",
    files.map(([name]) => path.join(folder, name)),
  );
}

test("bad scenes are sentences", async () => {
  const { page, errors, close } = await openStudio();
  for (const [text, expected] of [
    ["", /no `version`/],
    ["]]][[[ = = \u0000", /not TOML/],
    ['version = 2\n[[layer]]\nkind = "<img src=x onerror=alert(1)>"\n', /<img src=x onerror=alert\(1\)>/],
    [
      'version = 2\n[[layer]]\nkind = "bitmap"\npicture = "../../etc/passwd"\nx_mm = 0\ny_mm = 0\nwidth_mm = 9\n',
      /passwd/,
    ],
    ["version = 2\n" + '[[layer]]\nkind = "constant"\nfriction_n = 0.3\n'.repeat(2000), /the board takes 64/],
  ]) {
    await page.evaluate((text) => (studioPage.editor.text = text), text);
    await assertSays(page, expected);
  }
  assert.equal(await page.locator("#problems img").count(), 0, "text stays text");
  assert.deepEqual(errors, []);
  await close();
});

test("bad files and big ones are sentences", async () => {
  const { page, errors, close } = await openStudio();
  const png = fs.readFileSync(new URL("../../../scenes/textures/leather.png", import.meta.url));
  const scene = Buffer.from(
    'version = 2\n[[layer]]\nkind = "bitmap"\npicture = "bad.png"\nx_mm = 0\ny_mm = 0\nwidth_mm = 20\n',
  );
  await give(page, ["bad.png", Buffer.from("not a picture")]);
  await assertSays(page, /bad\.png: .*no PNG/);
  await give(page, ["bad.png", png.subarray(0, 900)], ["scene.toml", scene]);
  await assertSays(page, /bad\.png/);
  const big = Buffer.alloc(20_000_000, 0x41);
  for (const name of ["big.toml", "big.png", "big.zip"]) {
    await give(page, [name, big]);
    await assertSays(page, new RegExp(`${name}: the file has 20\\.0 MB`));
  }
  await give(page, ["broken.zip", png]);
  await assertSays(page, /broken\.zip: .*cannot be read/);
  await give(page, ["song.mp3", png]);
  await assertSays(page, /song\.mp3: expected a scene/);
  assert.deepEqual(errors, []);
  await close();
});

test("a link with rubbish is a sentence, and the first scene plays", async () => {
  const packed = (text) => deflateRawSync(Buffer.from(text)).toString("base64url");
  const bomb = packed(`{"name":"a","text":"${"#".repeat(30_000_000)}"}`).slice(0, 60_000);
  const { page, errors, close } = await openStudio(`${pageUrl}#scene=%%%`);
  await assertSays(page, /link does not hold a scene/);
  for (const rubbish of ["abcd", packed("{}"), packed("[1,2"), bomb]) {
    await page.evaluate((hash) => (location.hash = hash), `scene=${rubbish}`);
    await assertSays(page, /link does not hold a scene/);
    assert.ok((await page.evaluate(() => studioPage.editor.text)).includes("brick"));
  }
  assert.deepEqual(errors, []);
  await close();
});

test("a shared link and a saved zip bring the scene back", async () => {
  const { page, errors, close } = await openStudio();
  await page.evaluate((text) => played(text), WHOLE_SCREEN_GRATING);
  await page.selectOption("#finger", "dry");
  await page.click("#share");
  await page.waitForFunction(() => location.hash.startsWith("#scene="));
  const link = page.url();
  const [saved] = await Promise.all([page.waitForEvent("download"), page.click("#save")]);
  const zip = fs.readFileSync(await saved.path());
  assert.deepEqual(errors, []);
  await close();
  const shared = await openStudio(link);
  await shared.page.waitForFunction((text) => studioPage.editor.text === text, WHOLE_SCREEN_GRATING);
  await shared.close();
  const opened = await openStudio();
  await give(opened.page, ["mine.zip", zip]);
  await opened.page.waitForFunction((text) => studioPage.editor.text === text, WHOLE_SCREEN_GRATING);
  assert.equal(await opened.page.inputValue("#finger"), "dry");
  await opened.close();
});

const KEYS = `version = 2

[[ layer ]]
name = "key"
kind = "constant"
friction_fraction = 0.8
live = true
gain = 0.5
region = { x_mm = 20, y_mm = 20, width_mm = 10, height_mm = 40 }
repeat = { columns = 3, dx_mm = 30 }

[[layer]]
name = "wood"
kind = "bitmap"
picture = "planks.jpg"
x_mm = 0
y_mm = 60
width_mm = 30
`;
const PLAY = `version = 2
include = ["keys.toml"]

[[layer]]
name = "strip"
kind = "constant"
friction_fraction = 0.3
region = { x_mm = 0, y_mm = 0, width_mm = 120, height_mm = 10 }
`;
const JPEG = fs.readFileSync(new URL("../../../scenes/textures/wood.jpg", import.meta.url));

/** Opens a scene that includes another, which shows a JPEG picture. */
async function openIncluding() {
  const opened = await openStudio();
  const files = [
    ["keys.toml", KEYS],
    ["play.toml", PLAY],
    ["planks.jpg", JPEG],
  ];
  await give(opened.page, ...files);
  await opened.page.waitForFunction(() => document.querySelectorAll("#panel-layers .layer").length === 3);
  await opened.page.click("#tab-layers");
  return opened;
}

const tabsOf = (page) => page.locator("#file-tabs button").allTextContents();

test("a mistake in an included file is marked in that file", async () => {
  const { page, errors, close } = await openIncluding();
  assert.deepEqual(await tabsOf(page), ["play.toml", "keys.toml"]);
  await page.click("#file-tabs >> text=keys.toml");
  await page.evaluate(() => studioPage.editor.goTo("keys.toml", 5));
  await page.keyboard.press("End");
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.type("x");
  await page.locator(".cm-lintRange-error").waitFor();
  assert.equal(await page.locator("#problems li button").textContent(), "keys.toml, line 5");
  assert.match(await page.locator("#problems li").textContent(), /constantx/);
  assert.deepEqual(await tabsOf(page), ["play.toml", "keys.toml1"]);
  await page.click("#file-tabs >> text=play.toml");
  assert.equal(await page.locator(".cm-lintRange-error").count(), 0, "the scene itself has no mistake");
  await page.click("#problems li button");
  await page.locator(".cm-lintRange-error").waitFor();
  await page.keyboard.press("End");
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("Backspace");
  await page.waitForFunction(() => document.getElementById("check").textContent === "plays");
  assert.deepEqual(errors, []);
  await close();
});

test("layers of other files and with copies have their places, switches and gains", async () => {
  const { page, errors, close } = await openIncluding();
  const titles = await page.locator("#panel-layers .layer > div:first-child").allTextContents();
  assert.deepEqual(titles, ["key constant × 3, keys.toml", "wood bitmap, keys.toml", "strip constant"]);
  const gain = page.getByLabel("gain of key, as a number");
  assert.deepEqual(await gain.evaluate(({ value, min, max }) => [value, min, max]), ["0.5", "-100", "100"]);
  assert.equal(await page.getByLabel("gain of key", { exact: true }).inputValue(), "0.5");
  await page.evaluate(() => {
    const { engine } = studioPage;
    globalThis.lines = [];
    const control = engine.control.bind(engine);
    engine.control = (line) => control(line).then(() => lines.push(line));
  });
  await gain.fill("0.25");
  await page.waitForFunction(() => lines.length === 3);
  assert.deepEqual(await page.evaluate(() => lines.sort()), [1, 2, 3].map((number) => `layer ${number} gain 0.25`));
  await page.click("#panel-layers >> text=wood");
  const line = await page.evaluate(() => {
    const { editor } = studioPage;
    return [editor.files.find(({ isShown }) => isShown).name, document.querySelector(".cm-activeLine").textContent];
  });
  assert.deepEqual(line, ["keys.toml", "[[layer]]"]);
  await page.locator("#panel-layers .layer", { hasText: "wood" }).locator("text=Make live").click();
  await page.getByLabel("wood on").waitFor();
  assert.match(await page.evaluate(() => globalThis.studioPage.editor.text), /^version = 2\ninclude/);
  assert.deepEqual(errors, []);
  await close();
});

test("a scene of several files goes into a link and a zip, and comes back", async () => {
  const { page, errors, close } = await openIncluding();
  const [saved] = await Promise.all([page.waitForEvent("download"), page.click("#save")]);
  const zip = fs.readFileSync(await saved.path());
  // A picture of 36 kB is too big for a link: without it, the rest fits.
  await page.click("#share");
  await assertSays(page, /too big for a link/);
  await page.evaluate(() => studioPage.editor.show("keys.toml"));
  const flat = KEYS.slice(0, KEYS.indexOf("[[layer]]"));
  await give(page, ["keys.toml", flat]);
  await page.waitForFunction(() => document.querySelectorAll("#panel-layers .layer").length === 2);
  await page.click("#share");
  await page.waitForFunction(() => location.hash.startsWith("#scene="));
  await assertSays(page, /pastes the link into the page/);
  const link = page.url();
  assert.deepEqual(errors, []);
  await close();
  const shared = await openStudio();
  await shared.page.evaluate((link) => {
    const clipboardData = new DataTransfer();
    clipboardData.setData("text/plain", link);
    const target = document.querySelector(".cm-content");
    target.dispatchEvent(new ClipboardEvent("paste", { clipboardData, bubbles: true, cancelable: true }));
  }, link);
  await shared.page.waitForFunction(() => document.querySelectorAll("#panel-layers .layer").length === 2);
  assert.deepEqual(await tabsOf(shared.page), ["play.toml", "keys.toml"]);
  assert.equal(await shared.page.evaluate(() => studioPage.editor.text), PLAY);
  await give(shared.page, ["mine.zip", zip]);
  await shared.page.waitForFunction(() => document.querySelectorAll("#panel-layers .layer").length === 3);
  assert.deepEqual(shared.errors, []);
  await shared.close();
});

test("a scene that a board refuses plays as a draft, and is called so", async () => {
  const { page, errors, close } = await openStudio();
  const heavy = 'version = 2\n[[layer]]\nkind = "constant"\nfriction_n = 0.9\n';
  await page.evaluate((text) => played(text), heavy);
  assert.match(await page.locator("#check").textContent(), /1 mistake; draft/);
  assert.match(await page.locator("#problems li.error").textContent(), /line 4.*newton|line 4.* N/s);
  assert.ok(await page.locator(".scope-card .draft").isVisible());
  const most = await page.evaluate(async () => {
    await running();
    const sinceS = studioPage.samples.nowS;
    await slide(20, 100, 40, 80);
    lift(100, 40);
    return Math.max(...studioPage.samples.since(sinceS).voltageV);
  });
  assert.ok(most > 140, `clamped to the largest voltage, found ${most} V`);
  const [saved] = await Promise.all([page.waitForEvent("download"), page.click("#save-csv")]);
  assert.match(saved.suggestedFilename(), /draft/);
  const corner = () =>
    page.evaluate(() => {
      const canvas = document.getElementById("map-picture");
      const [x, y] = [(40 + 4) * devicePixelRatio, (26 + 4) * devicePixelRatio];
      return [...canvas.getContext("2d").getImageData(x, y, 1, 1).data];
    });
  assert.deepEqual(await corner(), [0, 0, 0, 255], "the map is marked");
  await page.evaluate((text) => played(text), heavy.replace("0.9", "0.3"));
  await page.waitForFunction(() => document.getElementById("check").textContent === "plays");
  assert.ok(await page.locator(".scope-card .draft").isHidden());
  await page.waitForFunction(() => {
    const canvas = document.getElementById("map-picture");
    const place = [(40 + 4) * devicePixelRatio, (26 + 4) * devicePixelRatio];
    return canvas.getContext("2d").getImageData(...place, 1, 1).data[2] > 0;
  });
  assert.deepEqual(errors, []);
  await close();
});
