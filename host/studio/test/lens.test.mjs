// The page in a browser: the lens of a slow replay.

import assert from "node:assert/strict";
import { test } from "node:test";
import { compareBlind, openStudio, openWide, wholeStroke } from "./page.mjs";

/** The lens's radius on a large map, in CSS pixels, for the millimetres that it shows around the finger. */
const LENS = { radiusPx: 120, radiusMm: 8 };
/** Where the strip of the envelope is, and how high. */
const STRIP = { middlePx: 0.68 * LENS.radiusPx, widePx: 1.1 * LENS.radiusPx, highPx: 0.2 * LENS.radiusPx };
/** Radius of the point of a report. */
const REPORT_PX = 4.5;

/** What the map's finger is drawn with at a picture, around the finger in CSS pixels; and the newest samples. */
function lensDrawn(page) {
  return page.evaluate(async () => {
    const { samples } = studioPage;
    const context = document.getElementById("map-finger").getContext("2d");
    const drawn = { arc: [], lineTo: [], rotate: [] };
    const watch = (name, act) => {
      context[name] = (...given) => {
        act(given);
        CanvasRenderingContext2D.prototype[name].apply(context, given);
      };
    };
    for (const [name, calls] of Object.entries(drawn)) watch(name, (given) => calls.push(given));
    watch("clearRect", () => {
      for (const calls of Object.values(drawn)) calls.length = 0;
    });
    await wait(100);
    for (const name of ["clearRect", ...Object.keys(drawn)]) delete context[name];
    const words = document.getElementById("lens-words").innerText;
    return { ...drawn, words, last: samples.since(samples.nowS), voltageV: samples.since(samples.nowS - 0.12).voltageV };
  });
}

const isNear = (value, wanted, most) => Math.abs(value - wanted) < most;
const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;

/** Contact, reports, predicted place, arrow and envelope are where the samples say, and as large. */
function assertLensDrawn({ arc, lineTo, rotate, last, voltageV }, highN) {
  const perMm = LENS.radiusPx / LENS.radiusMm;
  const said = JSON.stringify({ arc, lineTo, rotate });
  assert.ok(arc.some(([x, y, radius]) => x === 0 && y === 0 && isNear(radius, last.contactRadiusMm[0] * perMm, 3)), said);
  assert.ok(arc.some(([x, , radius]) => radius === REPORT_PX && x < -0.8 * perMm), `reports trail behind: ${said}`);
  // The last four lines are those of the cross, twice.
  const cross = lineTo.find(([x, y], at) => isNear(lineTo[at + 1]?.[0], x - 9, 0.01) && isNear(lineTo[at + 1][1], y + 9, 0.01));
  assert.ok(cross && Math.hypot(cross[0] - 9, cross[1]) < 2 * perMm, said);
  const forcePx = (0.85 * LENS.radiusPx * last.feltN[0]) / highN;
  assert.ok(lineTo.some(([x, y]) => y === 0 && isNear(x, forcePx, 3)), `not ${forcePx}: ${said}`);
  assert.ok(rotate.some(([angle]) => isNear(Math.abs(angle), Math.PI, 0.2)), "against the way of the finger");
  const half = STRIP.highPx / 2;
  const upper = lineTo.filter(([, y]) => y >= STRIP.middlePx - half && y < STRIP.middlePx);
  const wide = upper.at(-1)[0] - upper[0][0];
  assert.ok(wide > 0.8 * STRIP.widePx && wide <= STRIP.widePx, `${wide}`);
  const most = Math.max(50, ...voltageV);
  const heightPx = mean(upper.map(([, y]) => STRIP.middlePx - y));
  assert.ok(isNear(heightPx / ((half * mean(voltageV)) / most), 1, 0.1), `${heightPx} of ${voltageV}`);
}

test("a slow replay has a lens at the finger: contact, reports, predicted place, voltage and force", async () => {
  const page = await openWide();
  const { highN } = await page.evaluate(() => {
    const { engine, editor } = studioPage;
    return engine.compile({ "scene.toml": editor.text }, "scene.toml", {});
  });
  await wholeStroke(page, 40);
  assert.ok(await page.isHidden("#lens-words"), "not while one slides");
  await page.click("#replay");
  await page.evaluate(() => wait(5000));
  const drawn = await lensDrawn(page);
  assertLensDrawn(drawn, highN);
  await page.evaluate(() => wait(1000));
  const scale = await page.evaluate(() => studioPage.map.scale);
  const [first, then] = [drawn, await lensDrawn(page)].map(({ arc, last: { xMm, yMm } }) => {
    const fingers = arc.filter(([x, y]) => isNear(x, xMm[0] * scale, 3) && isNear(y, yMm[0] * scale, 3));
    assert.ok(fingers.length > 0, `a finger at ${xMm} mm: ${JSON.stringify(arc)}`);
    return xMm[0];
  });
  assert.ok(then > first + 5, `it moves on: ${first} to ${then} mm`);
  const { words, last } = drawn;
  const [xMm, contactMm, feltN, voltageV] = ["xMm", "contactRadiusMm", "feltN", "voltageV"].map((name) => last[name][0]);
  assert.ok(xMm > 30 && xMm < 90, `${xMm} mm`);
  const [, contact, force, voltage] = /contact\s*([\d.]+) mm[\s\S]*force\s*(\d+) mN[\s\S]*voltage\s*(\d+) V rms/.exec(words) ?? [];
  // The words are of a picture at most two samples older.
  assert.ok(Math.abs(contact - 2 * contactMm) < 0.2 && contact > 7 && contact < 11, words);
  assert.ok(Math.abs(force - 1000 * feltN) < 25 && force > 150, words);
  assert.ok(Math.abs(voltage - voltageV) < 15, words);
  await page.click("#replay");
  await page.evaluate(() => wait(300));
  assert.ok(await page.isHidden("#lens-words"), "the replay is over");
  assert.deepEqual((await lensDrawn(page)).lineTo, []);
});

test("a blind comparison ends a slow replay, and the lens says nothing in one", async () => {
  const page = await openStudio();
  await wholeStroke(page, 40);
  await page.evaluate(() => {
    document.getElementById("loop").checked = true;
    document.getElementById("replay").click();
  });
  await page.evaluate(() => wait(1000));
  assert.ok(await page.isVisible("#lens-words"));
  await compareBlind(page);
  await page.evaluate(() => wait(300));
  assert.equal(await page.textContent("#replay"), "Replay slowly");
  assert.ok(await page.isHidden("#lens-words"), "the replay is over");
  // However one gets there: words of what is felt say which version that is.
  await page.evaluate(() => document.getElementById("replay").click());
  await page.evaluate(() => wait(1000));
  assert.equal(await page.textContent("#replay"), "Stop replay");
  assert.ok(await page.isHidden("#lens-words"), "in a comparison");
});
