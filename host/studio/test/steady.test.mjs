// The page in a browser: it works only while something happens, and what it shows is of now.

import assert from "node:assert/strict";
import { test } from "node:test";
import { pageUrl } from "./harness.mjs";
import { WHOLE_SCREEN_GRATING, openStudio, wholeStroke, writeScene } from "./page.mjs";

/** Runs in the page before its scripts: counts what is drawn on canvases, and frames that come from the board. */
function countWork() {
  globalThis.work = { drawn: 0, frames: 0, changed: 0 };
  for (const name of ["fill", "stroke", "fillRect", "clearRect", "drawImage", "fillText"]) {
    const draw = CanvasRenderingContext2D.prototype[name];
    CanvasRenderingContext2D.prototype[name] = function (...args) {
      work.drawn += 1;
      return draw.apply(this, args);
    };
  }
  const count = (records) => (work.changed += records.length);
  const watch = { subtree: true, childList: true, characterData: true, attributes: true };
  addEventListener("DOMContentLoaded", () => new MutationObserver(count).observe(document.body, watch));
}

test("idle or stopped, the page does a twentieth of the work of sliding", async () => {
  const page = await openStudio(pageUrl, { init: countWork });
  const counted = await page.evaluate(async () => {
    eachFrame(() => (work.frames += 1));
    /** What is done in a second, after some seconds without a finger. */
    const during = async (act) => {
      Object.assign(work, { drawn: 0, frames: 0, changed: 0 });
      await act();
      return { ...work };
    };
    const sliding = await during(() => slide(20, 100, 40, 80));
    lift(100, 40);
    await wait(5000);
    const idle = await during(() => wait(1000));
    await studioPage.engine.stop();
    await wait(3000);
    const stopped = await during(() => wait(1000));
    await studioPage.engine.resume();
    const again = await during(() => slide(20, 100, 40, 80));
    return { sliding, idle, stopped, again };
  });
  const all = ({ drawn, frames, changed }) => drawn + frames + changed;
  const said = JSON.stringify(counted);
  for (const still of ["idle", "stopped"]) assert.ok(20 * all(counted[still]) <= all(counted.sliding), said);
  assert.ok(10 * counted.idle.frames <= counted.sliding.frames, said);
  assert.equal(counted.idle.drawn + counted.stopped.drawn, 0, said);
  assert.ok(2 * all(counted.again) > all(counted.sliding), `it wakes: ${said}`);
});

test("a check and a play send the text alone to the workers, not the pictures again", async () => {
  const init = () => {
    globalThis.sentBytes = 0;
    const sizeOf = (value) => {
      if (typeof value === "string") return value.length;
      if (ArrayBuffer.isView(value)) return value.byteLength;
      return value && typeof value === "object" ? Object.values(value).reduce((sum, each) => sum + sizeOf(each), 0) : 0;
    };
    const post = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (message, ...rest) {
      if (message.scene) globalThis.sentBytes += sizeOf(message.scene.files);
      return post.call(this, message, ...rest);
    };
  };
  const page = await openStudio(pageUrl, { init });
  const first = await page.evaluate(() => sentBytes);
  assert.ok(first > 100_000, `the first play sends all: ${first} bytes`);
  const text = WHOLE_SCREEN_GRATING;
  await writeScene(page, text);
  await page.evaluate(() => (globalThis.sentBytes = 0));
  await writeScene(page, text.replace("= 2\nlow", "= 3\nlow"));
  await page.waitForFunction(() => !document.getElementById("map").dataset.stale);
  const sent = await page.evaluate(() => sentBytes);
  assert.ok(sent > 0 && sent <= 3 * text.length, `check, play and map send ${sent} bytes for ${text.length} of text`);
  const felt = await wholeStroke(page, 40);
  assert.ok(Math.max(...felt.voltageV) > 50, "the scene plays with the files that the worker has");
});

test("a map that is older than the scene looks so until the new one is there", async () => {
  const page = await openStudio();
  const seen = await page.evaluate(async (text) => {
    const { engine } = studioPage;
    const [box, picture] = ["map", "map-picture"].map((id) => document.getElementById(id));
    const look = (stale) => ({
      isMarked: box.dataset.stale === stale,
      opacity: Number(getComputedStyle(picture).opacity),
      words: getComputedStyle(box, "::after").content,
    });
    const becomes = async (stale) => {
      while (box.dataset.stale !== stale) await new Promise((done) => setTimeout(done, 20));
      await new Promise((done) => setTimeout(done, 600));
      return look(stale);
    };
    const map = engine.map.bind(engine);
    let draw;
    const asked = new Promise((resolve) => (draw = resolve));
    engine.map = async (...scene) => {
      await asked;
      return map(...scene);
    };
    await played(text);
    const old = await becomes("drawing");
    draw();
    const drawn = await becomes(undefined);
    studioPage.editor.text = text.replace("grating", "gratin");
    return { old, drawn, mistaken: await becomes("older") };
  }, WHOLE_SCREEN_GRATING);
  assert.ok(seen.old.isMarked && seen.old.opacity < 0.5 && /drawing…/.test(seen.old.words), JSON.stringify(seen));
  assert.equal(seen.drawn.opacity, 1);
  assert.match(seen.mistaken.words, /the version before/);
});

test("the scope draws from its first sample on, and says how long ago, also after an hour", async () => {
  const page = await openStudio();
  const { isDrawn, said } = await page.evaluate(async () => {
    const [{ Scope }, { Samples }] = await Promise.all(
      ["page/scope.js", "page/samples.js"].map(async (name) => import(await studio.moduleUrl(name))),
    );
    const box = document.body.appendChild(document.createElement("div"));
    box.style.height = "300px";
    const samples = new Samples();
    const texts = [];
    const fillText = CanvasRenderingContext2D.prototype.fillText;
    CanvasRenderingContext2D.prototype.fillText = function (text, ...place) {
      if (box.contains(this.canvas)) texts.push(text);
      return fillText.call(this, text, ...place);
    };
    const scope = new Scope(samples, box);
    const picture = () => box.querySelector("canvas").toDataURL();
    /** A tenth of a second of samples. */
    const add = (firstTick) => {
      const columns = Object.keys(samples.since(0)).map((name) => [name, new Float32Array(100).fill(0.3)]);
      const frame = { ...Object.fromEntries(columns), firstTick, ticksPerSample: 40, tickHz: 40_000, contact: true };
      samples.add(frame);
      scope.feel(frame);
    };
    await wait(300);
    const empty = picture();
    add(0);
    await wait(300);
    const isDrawn = picture() !== empty;
    const HOUR_TICKS = 3600 * 40_000;
    for (let at = 0; at < 40; at += 1) add(HOUR_TICKS + at * 4000);
    texts.length = 0;
    await wait(300);
    box.remove();
    CanvasRenderingContext2D.prototype.fillText = fillText;
    return { isDrawn, said: texts.filter((text) => / s$|now/.test(text)) };
  });
  assert.ok(isDrawn, "a tenth of a second is drawn");
  assert.ok(said.includes("now") && said.includes("−1 s") && said.includes("−2 s"), said.join(", "));
  assert.ok(said.every((text) => text.length <= 6), said.join(", "));
});
