// What the tests of the page share: the page that plays, a finger on it, and files that are given to it.

import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import assert from "node:assert/strict";
import { forAllTests, openPage, pageUrl } from "./harness.mjs";

/**
 * Opens the page, as `openPage` does, and waits until its first scene plays. Its time is simulated, unless the options
 * say otherwise: nothing that the tests of the page look at depends on the speed of the machine. Text and tools are
 * open, and the ghost finger is dismissed, as a person has left them, unless it is the first visit.
 */
export async function openStudio(url = pageUrl, { isFirstVisit = false, ...options } = {}) {
  const page = await openPage(url, { isSimulated: true, ...options });
  await plays(page);
  await page.evaluate(addHelpers);
  if (isFirstVisit) return page;
  await page.evaluate(() => document.getElementById("first-dismiss").click());
  await showDrawer(page);
  return page;
}

/** The page of all tests of a file that begin with `openScene`. */
let shared;

/**
 * A page with a scene that has just been opened and plays, of a screen of 120 by 80 mm. It is one for all tests of a
 * file: opening a page takes the processor for seconds. What else a test changes in it, it has to change back.
 */
export async function openScene(text) {
  shared ??= await forAllTests(openStudio);
  const page = shared;
  await resize(page, [1280, 800]);
  await showDrawer(page);
  await page.evaluate(openAnew, text);
  await page.waitForFunction((text) => studioPage.editor.text === text, text);
  await plays(page);
  await page.waitForFunction(() => studioPage.map.screen.heightMm === 80);
  await page.evaluate(() => document.querySelector("#notice [aria-label=Dismiss]").click());
  return page;
}

/** Runs in the page: opens a scene by a link, with no history and nothing selected. */
async function openAnew(text) {
  for (const dialog of document.querySelectorAll("dialog[open]")) dialog.close();
  document.activeElement.blur();
  document.querySelector(".mode button").click();
  document.getElementById("tab-layers").click();
  document.querySelector("main").scrollTo(0, 0);
  const { linkOf } = await import(await studio.moduleUrl("page/share.js"));
  history.replaceState(null, "", "#");
  location.hash = new URL(linkOf("opened", text, [])).hash;
}

/** Writes this text in place of the scene's, and waits until it plays and its check is shown. */
export function writeScene(page, text) {
  return page.evaluate((text) => played(text), text);
}

/** Waits until the page has its scene played, and no hand changes that. */
export const plays = (page) =>
  page.waitForFunction(() => {
    const isHeld = globalThis.studioPage?.player.isHeld ?? true;
    return !isHeld && document.getElementById("check").textContent === "plays";
  });

/** Waits until the map has found its place: the browser's frames and those of the page's clock go on meanwhile. */
export function settled(page) {
  return page.evaluate(async () => {
    const parts = ["#map-finger", ".hands"].map((part) => document.querySelector(part));
    const place = () => JSON.stringify(parts.map((part) => part.getBoundingClientRect()));
    for (let before = ""; before !== place(); ) {
      before = place();
      for (let frames = 0; frames < 4; frames += 1) {
        await new Promise(requestAnimationFrame);
        await new Promise(studioClock.nextFrame);
      }
    }
  });
}

/** Gives the window another size, CSS pixels, and waits until the page has taken it. */
export async function resize(page, [width, height]) {
  await page.setViewportSize({ width, height });
  await settled(page);
}

/** Opens the drawer with text and tools, unless it is open. */
export async function showDrawer(page) {
  if (await page.locator("#drawer").isHidden()) await page.click("#toggle-drawer");
}

/** Runs in the page. */
function addHelpers() {
  const canvas = document.getElementById("map-finger");
  const send = (type, xMm, yMm) => {
    const box = canvas.getBoundingClientRect();
    const { scale } = studioPage.map;
    const place = { clientX: box.left + xMm * scale, clientY: box.top + yMm * scale };
    const event = new PointerEvent(type, { ...place, pointerId: 1, button: 0, bubbles: true });
    canvas.dispatchEvent(event);
  };
  globalThis.wait ??= (ms) => new Promise((resolve) => setTimeout(resolve, ms));
  /** Slides along x at a constant speed, an event for each 8 ms, and leaves the finger down. Resolves at its end. */
  globalThis.slide = async (fromMm, toMm, yMm, speedMmPerS) => {
    const durationMs = (1000 * (toMm - fromMm)) / speedMmPerS;
    send("pointerdown", fromMm, yMm);
    for (let ms = 8; ms <= durationMs; ms += 8) {
      await wait(8);
      send("pointermove", fromMm + (speedMmPerS * ms) / 1000, yMm);
    }
  };
  globalThis.lift = (xMm, yMm) => send("pointerup", xMm, yMm);
  /** Slides and lifts. Resolves when all of it has been felt. */
  globalThis.stroke = async (fromMm, toMm, yMm, speedMmPerS) => {
    await slide(fromMm, toMm, yMm, speedMmPerS);
    await wait(150);
    lift(toMm, yMm);
    await wait(200);
  };
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
  /** Types a text, and resolves once the board plays it and its check is shown. */
  globalThis.played = (text) =>
    new Promise((resolve) => {
      const { player, editor } = studioPage;
      const before = player.onStatus;
      player.onStatus = (status) => {
        before(status);
        if (status !== "loaded" || editor.text !== text) return;
        player.onStatus = before;
        resolve();
      };
      editor.text = text;
    });
}

/** Sliding speed of a whole stroke. */
export const SPEED_MM_PER_S = 80;

/** Slides over the map along x, lifts, and returns the samples of this stroke. */
export function wholeStroke(page, yMm) {
  const slid = async ([yMm, speedMmPerS]) => {
    const { samples } = studioPage;
    const beginS = samples.nowS;
    await stroke(15, 105, yMm, speedMmPerS);
    return samples.since(beginS);
  };
  return page.evaluate(slid, [yMm, SPEED_MM_PER_S]);
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

export const WHOLE_SCREEN_GRATING = `version = 1

[[layer]]
kind = "grating"
wavelength_mm = 2
low_n = 0.0
high_n = 0.1
`;

/** The same with a name, a switch and a gain. */
export const liveGrating = (name) =>
  WHOLE_SCREEN_GRATING.replace('kind = "grating"', `name = "${name}"\nkind = "grating"\nlive = true`);

export const KEYS = `version = 1

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
export const PLAY = `version = 1
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
  const page = await openStudio();
  const files = [
    ["keys.toml", KEYS],
    ["play.toml", PLAY],
    ["planks.jpg", JPEG],
  ];
  await give(page, ...files);
  await page.waitForFunction(() => document.querySelectorAll("#panel-layers .layer").length === 3);
  await page.click("#tab-layers");
  return page;
}

export const tabsOf = (page) => page.locator("#file-tabs button").allTextContents();

/** Smooth stripes: friction is the mean of least and largest at every half of one. */
export const STRIPES_MM = 20;
const STRIPES = WHOLE_SCREEN_GRATING.replace("wavelength_mm = 2", `wave = "sine"\nwavelength_mm = ${STRIPES_MM}`);

/** Opens the page with a large map that shows the stripes. */
export async function openWide() {
  const page = await openStudio();
  await resize(page, [1920, 1200]);
  await page.click("#toggle-drawer");
  await writeScene(page, STRIPES);
  await page.waitForFunction(() => {
    const at = (xMm) => studioPage.map.frictionAt(xMm, 40);
    return at(5) - at(15) > 0.09 && at(45) - at(55) > 0.09;
  });
  return page;
}

/** Begins a blind comparison of the first scene and another. */
export async function compareBlind(page) {
  await page.click("#tab-compare");
  await page.click("text=Keep this scene as A");
  await writeScene(page, WHOLE_SCREEN_GRATING);
  await page.click("text=Compare A with the scene now");
  await page.locator("body.blind").waitFor();
}
