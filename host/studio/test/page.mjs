// What the tests of the page share: the page that plays, a finger on it, and files that are given to it.

import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import assert from "node:assert/strict";
import { openPage, pageUrl } from "./harness.mjs";

/** Opens the page, as `openPage` does, and waits until its first scene plays. */
export async function openStudio(url = pageUrl, options) {
  const opened = await openPage(url, options);
  await opened.page.waitForFunction(() => globalThis.studioPage && document.documentElement.dataset.state === "active");
  await opened.page.waitForFunction(() => document.getElementById("check").textContent === "plays");
  await opened.page.evaluate(addHelpers);
  await opened.page.evaluate(addWatch);
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
    const begin = performance.now() + AHEAD_MS;
    const durationMs = (1000 * (toMm - fromMm)) / speedMmPerS;
    send("pointerdown", fromMm, yMm, begin);
    for (let ms = 8; ms <= durationMs; ms += 8) {
      send("pointermove", fromMm + (speedMmPerS * ms) / 1000, yMm, begin + ms);
    }
    sentUntil(begin);
    return wait(AHEAD_MS + durationMs);
  };
  globalThis.lift = (xMm, yMm) => send("pointerup", xMm, yMm);
  const listeners = new Set();
  const { samples } = studioPage;
  const add = samples.add.bind(samples);
  samples.add = (frame) => {
    add(frame);
    for (const listen of listeners) listen(frame);
  };
  globalThis.eachFrame = (listen) => {
    listeners.add(listen);
    return () => listeners.delete(listen);
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

/** A stroke is tried so often. */
const STROKES_MAX = 20;
const SPEED_MM_PER_S = 80;

/** Runs in the page, which has a function `eachFrame(listen)` that returns how to listen no more. */
export function addWatch() {
  /** The samples of a stroke are sent so long before the first of them, ms: a busy machine takes its time. */
  globalThis.AHEAD_MS = 300;
  let isSentInTime = true;
  /** All samples of a stroke have been sent, of which the first one is at `ms`. */
  globalThis.sentUntil = (ms) => (isSentInTime &&= performance.now() < ms);
  const FRAMES = 10;
  /** A worker that is held up skips more time than this, and frames are rarely so late, ms. */
  const SKIPPED_MS = 50;
  /** The state that the board has in a stroke. */
  globalThis.expectedState = "active";
  /** Resolves once the simulator runs in this state: a busy machine may hold the page up. */
  globalThis.running = () =>
    new Promise((resolve) => {
      let begin;
      const leave = eachFrame(({ tick, state }) => {
        if (state !== expectedState) begin = undefined;
        else begin ??= tick;
        if (begin === undefined || tick < begin + 100 * 40) return;
        leave();
        resolve();
      });
    });
  /** From now on, `isUndisturbed()` says whether strokes came in time, and the board's state and clock did not jump. */
  globalThis.watchBoard = async () => {
    await running();
    isSentInTime = true;
    const [lagsMs, states] = [[], new Set()];
    const leave = eachFrame(({ tick, slowness, state }) => {
      states.add(state);
      // In the slow time of a replay, the lag grows.
      if (slowness === 1) lagsMs.push(performance.now() - tick / 40);
      else lagsMs.length = 0;
    });
    globalThis.isUndisturbed = () => {
      leave();
      if (!isSentInTime || states.size !== 1 || !states.has(expectedState)) return false;
      return Math.min(...lagsMs.slice(-FRAMES)) < Math.min(...lagsMs) + SKIPPED_MS;
    };
  };
}

/**
 * Does `act()`, and returns its value. A busy machine holds the page up, so that its board is disarmed or its samples
 * come late, or the board itself, which then skips time: `act` is repeated until nothing of this has happened.
 */
export async function undisturbed(page, act) {
  for (let tries = 0; tries < STROKES_MAX; tries += 1) {
    await page.evaluate(() => watchBoard());
    const value = await act();
    if (await page.evaluate(() => isUndisturbed())) return value;
  }
  throw new Error(`the machine is too busy: the board was held up in each of ${STROKES_MAX} tries`);
}

/** Slides over the map along x, lifts, and returns the samples of this stroke. */
export function wholeStroke(page, yMm) {
  const stroke = async ([yMm, speedMmPerS]) => {
    const { samples } = studioPage;
    const beginS = samples.nowS;
    await slide(15, 105, yMm, speedMmPerS);
    await wait(150);
    lift(105, yMm);
    await wait(200);
    return samples.since(beginS);
  };
  return undisturbed(page, () => page.evaluate(stroke, [yMm, SPEED_MM_PER_S]));
}

/** The page is there, plays, and says this. */
export async function assertSays(page, expected) {
  await page.waitForFunction(
    (source) => {
      const shown = [...document.querySelectorAll("#problems li.error, #notice:not([hidden]) span")];
      return shown.some((each) => new RegExp(source).test(each.textContent));
    },
    expected.source,
  );
  // On a busy machine the page may be held up, and the board disarmed, until the page lives again.
  await page.waitForFunction(() => document.documentElement.dataset.state === "active");
  assert.ok(await page.locator("#map-picture").isVisible());
  await page.evaluate(() => (document.getElementById("notice").hidden = true));
}

/** Opens files of these names and contents, as a person does. */
export async function give(page, ...files) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "frixel-page-"));
  for (const [name, content] of files) fs.writeFileSync(path.join(folder, name), content);
  await page.setInputFiles(
    "#files",
    files.map(([name]) => path.join(folder, name)),
  );
}

export const WHOLE_SCREEN_GRATING = `version = 2

[[layer]]
kind = "grating"
wavelength_mm = 2
low_n = 0.0
high_n = 0.1
`;

export const KEYS = `version = 2

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
export const PLAY = `version = 2
include = ["keys.toml"]

[[layer]]
name = "strip"
kind = "constant"
friction_fraction = 0.3
region = { x_mm = 0, y_mm = 0, width_mm = 120, height_mm = 10 }
`;
const JPEG = fs.readFileSync(new URL("../../../scenes/textures/wood.jpg", import.meta.url));

/** Opens a scene that includes another, which shows a JPEG picture. */
export async function openIncluding() {
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

export const tabsOf = (page) => page.locator("#file-tabs button").allTextContents();
