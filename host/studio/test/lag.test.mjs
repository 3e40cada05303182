// The page in a browser: how late friction comes with prediction and without, and the lens of a slow replay.

import assert from "node:assert/strict";
import { after, afterEach, test } from "node:test";
import { cleanUp, endLeftovers } from "./harness.mjs";
import { WHOLE_SCREEN_GRATING, openStudio, wholeStroke } from "./page.mjs";

afterEach(endLeftovers);
after(cleanUp);

/** Smooth stripes: friction is the mean of least and largest at every half of one. */
const STRIPES_MM = 20;
/** The page takes a border as crossed 12 % of the difference behind that mean: so far behind it, mm. */
const BEHIND_MM = (STRIPES_MM / (2 * Math.PI)) * Math.asin(2 * 0.12);
const STRIPES = WHOLE_SCREEN_GRATING.replace("wavelength_mm = 2", `wave = "sine"\nwavelength_mm = ${STRIPES_MM}`);
const INKS = { predicted: [0x7d, 0xff, 0xb0], reported: [0xff, 0x7a, 0x1a] };

/** Opens the page with a large map that shows the stripes. */
async function openWide() {
  const opened = await openStudio();
  await opened.page.setViewportSize({ width: 1920, height: 1200 });
  await opened.page.click("#toggle-drawer");
  await opened.page.evaluate((text) => played(text), STRIPES);
  await opened.page.waitForFunction(() => {
    const at = (xMm) => studioPage.map.frictionAt(xMm, 40);
    return at(5) - at(15) > 0.09 && at(45) - at(55) > 0.09;
  });
  return opened;
}

const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
const rms = (values) => Math.sqrt(mean(values.map((value) => value * value)));

/** The lags that the page says, mm. */
async function said(page) {
  const texts = await page.locator("#lag-predicted, #lag-reported").allInnerTexts();
  const [predicted, reported] = texts.map((text) => Number(/^(\d\.\d) mm$/.exec(text)?.[1]));
  return { predicted, reported };
}

/** How many pixels of the map are in the inks of the bands. */
function bands(page) {
  return page.evaluate((inks) => {
    const canvas = document.getElementById("map-finger");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const count = (wanted) => {
      let found = 0;
      for (let at = 0; at < data.length; at += 4) {
        const isThere = data[at + 3] > 150 && data[at + 3] < 250;
        if (isThere && wanted.every((value, index) => Math.abs(data[at + index] - value) < 6)) found += 1;
      }
      return found;
    };
    return Object.fromEntries(Object.entries(inks).map(([name, ink]) => [name, count(ink)]));
  }, INKS);
}

/** The lags of a stroke, from its samples alone: how far the finger goes until the board has crossed, too, mm. */
function lagsOf({ xMm, predictedXMm, reportedXMm }) {
  const lags = { predicted: [], reported: [] };
  const crossing = (places, borderMm) => places.findIndex((place, at) => places[at - 1] < borderMm && place >= borderMm);
  for (let borderMm = BEHIND_MM; borderMm < 120; borderMm += STRIPES_MM / 2) {
    const at = crossing(xMm, borderMm);
    if (at < 0) continue;
    for (const [by, places] of [["predicted", predictedXMm], ["reported", reportedXMm]]) {
      const then = crossing(places, borderMm);
      if (then >= 0) lags[by].push(xMm[then] - borderMm);
    }
  }
  return Object.fromEntries(Object.entries(lags).map(([by, all]) => [by, mean(all.map(Math.abs))]));
}

/** The samples of the stroke that comes next by itself. */
const nextStroke = (page) =>
  page.evaluate(async () => {
    const { samples } = studioPage;
    const beginS = samples.nowS;
    const isOver = () => {
      const { xMm } = samples.since(beginS);
      return xMm.some(Number.isFinite) && Number.isNaN(xMm.at(-1));
    };
    while (!isOver()) await wait(50);
    return samples.since(beginS);
  });

/** Felt friction beside its reference, from a while after the touch on, over the reference's own swing. */
function errorOf({ xMm, feltN, referenceN }) {
  const isOnTheWay = (_, at) => xMm[at] > 30 && xMm[at] < 100;
  const [felt, reference] = [feltN.filter(isOnTheWay), referenceN.filter(isOnTheWay)];
  const middle = mean(reference);
  return rms(felt.map((value, at) => value - reference[at])) / rms(reference.map((value) => value - middle));
}

test("the lag of a stroke is a band at each border, with prediction and without, and as long as it is", async (context) => {
  const { page, errors, close } = await openWide();
  assert.deepEqual(await bands(page), { predicted: 0, reported: 0 }, "no band before one asks");
  await page.click("#open-lag");
  const stroke = await wholeStroke(page, 40);
  const lags = lagsOf(stroke);
  const shown = await said(page);
  context.diagnostic(`off by ${shown.predicted} mm with prediction, ${shown.reported} mm without`);
  for (const by of ["predicted", "reported"]) assert.ok(Math.abs(shown[by] - lags[by]) < 0.2, JSON.stringify({ shown, lags }));
  assert.ok(shown.predicted < 0.6 && shown.reported > 1, JSON.stringify(shown));
  await page.evaluate(() => wait(3000));
  const drawn = await bands(page);
  assert.ok(drawn.reported > 1.5 * drawn.predicted && drawn.predicted > 0, `${JSON.stringify(drawn)} pixels stay after the trail`);
  await page.click("#open-lag");
  await page.evaluate(() => wait(100));
  assert.deepEqual(await bands(page), { predicted: 0, reported: 0 });
  assert.deepEqual(errors, []);
  await close();
});

test("the switch slides the same stroke again without prediction, which is felt and heard late", async (context) => {
  const { page, errors, close } = await openWide();
  await page.click("#open-lag");
  const own = await wholeStroke(page, 40);
  await page.evaluate(() => {
    const { engine } = studioPage;
    const feel = engine.onAudio;
    globalThis.heard = 0;
    engine.onAudio = (change, ...rest) => {
      heard += change.filter((each) => Math.abs(each) > 1e-3).length;
      feel(change, ...rest);
    };
  });
  const again = nextStroke(page);
  await page.locator("#prediction").uncheck();
  const without = await again;
  const way = ({ xMm }) => xMm.filter(Number.isFinite);
  assert.ok(Math.abs(way(own).length - way(without).length) < 30, "the same stroke");
  assert.ok((await page.evaluate(() => heard)) > 10_000, "it is heard");
  const [late, before] = [errorOf(without), errorOf(own)];
  context.diagnostic(`felt is off by ${before.toFixed(2)} of the reference's swing with prediction, ${late.toFixed(2)} without`);
  assert.ok(late > 1.4 * before, `${late}, ${before}`);
  const shown = await said(page);
  assert.ok(shown.predicted < 0.6 && shown.reported > 1, `both are known of each stroke: ${JSON.stringify(shown)}`);
  const back = nextStroke(page);
  await page.locator("#prediction").check();
  assert.ok(errorOf(await back) < late / 1.4, "and with it again");
  assert.deepEqual(errors, []);
  await close();
});

/** Lines of 1 mm, which reports that come every 10 ms are too rare for at 200 mm/s. */
const LINES = `version = 2

[[layer]]
kind = "constant"
friction_fraction = 0.9
region = { x_mm = 20, y_mm = 0, width_mm = 1, height_mm = 80 }
repeat = { columns = 10, dx_mm = 9 }
`;

test("lines that a board without prediction jumps over are said to be missed", async () => {
  const { page, errors, close } = await openWide();
  await page.evaluate((text) => played(text), LINES);
  await page.waitForFunction(() => studioPage.map.frictionAt(20.5, 40) - studioPage.map.frictionAt(25, 40) > 0.1);
  await page.click("#open-lag");
  await page.evaluate(async () => {
    await slide(10, 115, 40, 200);
    await wait(150);
    lift(115, 40);
    await wait(300);
  });
  const words = await page.innerText("#lag-missed");
  const [, missed, lines] = /^, (\d+) of (\d+) missed$/.exec(words) ?? [];
  assert.ok(Number(lines) === 10 && missed >= 3 && missed <= 9, words);
  assert.deepEqual(errors, []);
  await close();
});

test("a faster touch source slides the same stroke again, and its bands are shorter", async () => {
  const { page, errors, close } = await openWide();
  await page.click("#open-lag");
  await wholeStroke(page, 40);
  const [slow, slowDrawn] = [await said(page), await bands(page)];
  const again = nextStroke(page);
  await page.selectOption("#touch", "500");
  await again;
  await page.evaluate(() => wait(3000));
  const [fast, fastDrawn] = [await said(page), await bands(page)];
  assert.ok(fast.reported < 0.6 * slow.reported, JSON.stringify({ slow, fast }));
  assert.ok(fastDrawn.reported < 0.8 * slowDrawn.reported, JSON.stringify({ slowDrawn, fastDrawn }));
  assert.deepEqual(errors, []);
  await close();
});

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
    const { highN } = await engine.check({ "scene.toml": editor.text }, "scene.toml", {});
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
  assert.ok(isAt(voltage.left, -widePx / 2) && isAt(voltage.right, widePx / 2), said);
  assert.ok(isAt((voltage.top + voltage.bottom) / 2, belowPx), said);
  const most = Math.max(50, ...voltageV);
  const area = (widePx * highPx * mean([...voltageV])) / most;
  // Pixels at its edges are in part of another ink.
  assert.ok(voltage.pixels > 0.75 * area && voltage.pixels < 1.1 * area, `${said}, not ${area} pixels`);
}

test("a slow replay has a lens at the finger: contact, reports, predicted place, voltage and force", async () => {
  const { page, errors, close } = await openWide();
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
  assert.deepEqual(errors, []);
  await close();
});

/** Begins a blind comparison of the first scene and another. */
async function compareBlind(page) {
  await page.click("#tab-compare");
  await page.click("text=Keep this scene as A");
  await page.evaluate((text) => played(text), WHOLE_SCREEN_GRATING);
  await page.click("text=Compare A with the scene now");
  await page.locator("body.blind").waitFor();
}

test("the prediction switch ends a blind comparison: the scene plays, not the version that was felt", async () => {
  const { page, errors, close } = await openStudio();
  await compareBlind(page);
  await page.evaluate(() => document.getElementById("prediction").click());
  await page.locator("text=the comparison is over").waitFor();
  assert.equal(await page.locator("body.blind").count(), 0);
  assert.deepEqual(errors, []);
  await close();
});

test("a blind comparison ends a slow replay, and the lens says nothing in one", async () => {
  const { page, errors, close } = await openStudio();
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
  assert.deepEqual(errors, []);
  await close();
});

/** What is played from now on, as `watched.predicts`, one for each time; `watched.replays` counts what slides by itself. */
const watchPlays = (page) =>
  page.evaluate(() => {
    const { engine } = studioPage;
    globalThis.watched = { predicts: [], replays: 0 };
    const [play, replay] = [engine.play.bind(engine), engine.replay.bind(engine)];
    engine.play = (files, entry, options) => {
      watched.predicts.push(!options.withoutPrediction);
      return play(files, entry, options);
    };
    engine.replay = (options) => {
      watched.replays += 1;
      return replay(options);
    };
  });

test("prediction that is off is on again once its panel is closed", async () => {
  const { page, errors, close } = await openStudio();
  await watchPlays(page);
  await page.click("#open-lag");
  await page.locator("#prediction").uncheck();
  await page.waitForFunction(() => watched.predicts.length === 1);
  await page.click("#open-lag");
  await page.waitForFunction(() => watched.predicts.length === 2);
  assert.deepEqual(await page.evaluate(() => watched.predicts), [false, true]);
  await page.click("#open-lag");
  assert.ok(await page.isChecked("#prediction"));
  assert.deepEqual(errors, []);
  await close();
});

test("a setting that could not be played slides no stroke later, and another board has none to slide", async () => {
  const { page, errors, close } = await openStudio();
  await page.click("#open-lag");
  await wholeStroke(page, 40);
  await watchPlays(page);
  await page.evaluate(() => (studioPage.editor.text = "version = 2\n[[layer]]\nkind = 7\n"));
  await page.locator("#problems li.error").first().waitFor();
  await page.selectOption("#touch", "500");
  await page.evaluate(() => wait(500));
  await page.evaluate((text) => played(text), WHOLE_SCREEN_GRATING);
  await page.evaluate(() => wait(500));
  assert.equal(await page.evaluate(() => watched.replays), 0, "after a mistake");
  await page.click("#open-board");
  await page.click("#board-dialog >> text=Simulator");
  await page.waitForFunction(() => watched.predicts.length === 2);
  assert.ok(await page.isDisabled("#replay"));
  await page.locator("#prediction").uncheck();
  await page.waitForFunction(() => watched.predicts.length === 3);
  await page.evaluate(() => wait(500));
  assert.equal(await page.evaluate(() => watched.replays), 0, "on a board after a reset");
  assert.ok(await page.isHidden("#notice"));
  assert.deepEqual(errors, []);
  await close();
});
