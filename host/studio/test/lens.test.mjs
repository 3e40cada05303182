// The page in a browser: the lens of a slow replay.

import assert from "node:assert/strict";
import { test } from "node:test";
import { compareBlind, openStudio, openWide, wholeStroke } from "./page.mjs";

/** Where the lens's ring and the inks of its parts are on the map, as boxes in mm; none where it is not. */
function lensParts(page) {
  return page.evaluate(() => {
    const canvas = document.getElementById("map-finger");
    const { data, width } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const perMm = studioPage.map.scale * devicePixelRatio;
    const inks = { reports: [0xff, 0xd2, 0x3f], predicted: [0x7d, 0xff, 0xb0] };
    const boxes = {};
    for (const [name, ink] of Object.entries(inks)) {
      const found = [];
      for (let at = 0; at < data.length; at += 4) {
        if (data[at + 3] > 250 && ink.every((value, index) => Math.abs(data[at + index] - value) < 8)) found.push(at / 4);
      }
      const [xs, ys] = [found.map((at) => (at % width) / perMm), found.map((at) => Math.floor(at / width) / perMm)];
      const middle = (values) => (Math.min(...values) + Math.max(...values)) / 2;
      boxes[name] = found.length > 0 ? { xMm: middle(xs), yMm: middle(ys), leftMm: Math.min(...xs) } : null;
    }
    const { samples } = studioPage;
    const last = samples.since(samples.nowS);
    return { ...boxes, words: document.getElementById("lens-words").innerText, last };
  });
}

/** The lens's radius on a large map, in CSS pixels, for the millimetres that it shows around the finger. */
const LENS = { radiusPx: 120, radiusMm: 8 };

/**
 * What is drawn in the lens: where the contact's ring crosses the line up from the finger, the box of each ink, and the
 * envelope's pixels; lengths in CSS pixels, from the finger. Also the newest sample, the voltages that led to it, and
 * the largest friction.
 */
function lensDrawn(page) {
  return page.evaluate(async (radiusPx) => {
    const { engine, editor, map, samples } = studioPage;
    const canvas = document.getElementById("map-finger");
    const { data, width } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const last = samples.since(samples.nowS);
    const { voltageV } = samples.since(samples.nowS - 0.12);
    const [left, top] = [last.xMm[0] * map.scale - radiusPx, last.yMm[0] * map.scale - radiusPx].map(Math.round);
    const inkOf = (name) => {
      const probe = map.box.appendChild(document.createElement("span"));
      probe.style.color = `var(--${name})`;
      const ink = getComputedStyle(probe).color.match(/\d+/g).map(Number);
      probe.remove();
      return ink;
    };
    const colourAt = (x, y) => {
      const at = 4 * ((top + y) * width + left + x);
      return data.slice(at, at + 3);
    };
    const boxOf = (name) => {
      const ink = inkOf(name);
      const found = [];
      for (let y = 4; y < 2 * radiusPx - 4; y += 1)
        for (let x = 4; x < 2 * radiusPx - 4; x += 1) {
          const isInk = colourAt(x, y).every((value, index) => Math.abs(value - ink[index]) < 10);
          if (isInk) found.push([x - radiusPx, y - radiusPx]);
        }
      const [xs, ys] = [found.map(([x]) => x), found.map(([, y]) => y)];
      const box = { left: Math.min(...xs), right: Math.max(...xs), top: Math.min(...ys), bottom: Math.max(...ys) };
      return { ...box, pixels: found.length };
    };
    const contact = [];
    for (let y = 14; y < radiusPx - 12; y += 1) {
      if (colourAt(radiusPx, radiusPx - y).every((value) => value > 170)) contact.push(y);
    }
    const { highN } = await engine.compile({ "scene.toml": editor.text }, "scene.toml", {});
    return { contact, force: boxOf("felt"), voltage: boxOf("voltage"), last, voltageV, highN };
  }, LENS.radiusPx);
}

/** Contact, arrow and envelope are as large as the samples say. */
async function assertLensDrawn(page) {
  const { contact, force, voltage, last, voltageV, highN } = await lensDrawn(page);
  const { radiusPx, radiusMm } = LENS;
  const contactPx = (last.contactRadiusMm[0] * radiusPx) / radiusMm;
  assert.ok(contact.length > 0 && contact.every((y) => Math.abs(y - contactPx) < 3), `${contact}, not ${contactPx}`);
  // Against the way of the finger. A report may lie over the tip.
  const forcePx = (0.85 * radiusPx * last.feltN[0]) / highN;
  const isLong = -force.left > forcePx - 14 && -force.left < forcePx + 3;
  assert.ok(isLong && force.right < 12, `${JSON.stringify(force)}, not ${forcePx}`);
  const [widePx, highPx, belowPx] = [1.1 * radiusPx, 0.2 * radiusPx, 0.68 * radiusPx];
  const isAt = (value, wanted) => Math.abs(value - wanted) < 4;
  const said = JSON.stringify(voltage);
  // Where there is little voltage, the strip is thinner than a pixel.
  const isWide = voltage.left > -widePx / 2 - 4 && voltage.right < widePx / 2 + 4;
  assert.ok(isWide && voltage.right - voltage.left > 0.8 * widePx, said);
  assert.ok(isAt((voltage.top + voltage.bottom) / 2, belowPx), said);
  const most = Math.max(50, ...voltageV);
  const area = (widePx * highPx * voltageV.reduce((sum, value) => sum + value, 0)) / voltageV.length / most;
  // Pixels at its edges are in part of another ink.
  assert.ok(voltage.pixels > 0.75 * area && voltage.pixels < 1.1 * area, `${said}, not ${area} pixels`);
}

test("a slow replay has a lens at the finger: contact, reports, predicted place, voltage and force", async () => {
  const page = await openWide();
  await wholeStroke(page, 40);
  assert.ok(await page.isHidden("#lens-words"), "not while one slides");
  await page.click("#replay");
  await page.evaluate(() => wait(5000));
  const { reports, predicted, words, last } = await lensParts(page);
  const [xMm, contactMm, feltN, voltageV] = ["xMm", "contactRadiusMm", "feltN", "voltageV"].map((name) => last[name][0]);
  assert.ok(xMm > 30 && xMm < 90, `${xMm} mm`);
  assert.ok(predicted && Math.hypot(predicted.xMm - xMm, predicted.yMm - 40) < 2, JSON.stringify({ predicted, xMm }));
  assert.ok(reports && reports.leftMm < xMm - 0.8, `reports trail behind: ${JSON.stringify({ reports, xMm })}`);
  const [, contact, force, voltage] = /contact\s*([\d.]+) mm[\s\S]*force\s*(\d+) mN[\s\S]*voltage\s*(\d+) V rms/.exec(words) ?? [];
  await assertLensDrawn(page);
  // The words are of a picture at most two samples older.
  assert.ok(Math.abs(contact - 2 * contactMm) < 0.2 && contact > 7 && contact < 11, words);
  assert.ok(Math.abs(force - 1000 * feltN) < 25 && force > 150, words);
  assert.ok(Math.abs(voltage - voltageV) < 15, words);
  await page.click("#replay");
  await page.evaluate(() => wait(300));
  assert.ok(await page.isHidden("#lens-words"), "the replay is over");
  const gone = await lensParts(page);
  assert.deepEqual([gone.reports, gone.predicted], [null, null]);
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
