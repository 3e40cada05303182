// The page in a browser: how late friction comes, with prediction and without.

import assert from "node:assert/strict";
import { test } from "node:test";
import { SPEED_MM_PER_S, STRIPES_MM, WHOLE_SCREEN_GRATING, openStudio, openWide, wholeStroke, writeScene } from "./page.mjs";

/** The page takes a border as crossed 12 % of the difference behind that mean: so far behind it, mm. */
const BEHIND_MM = (STRIPES_MM / (2 * Math.PI)) * Math.asin(2 * 0.12);
/** How far the finger goes in the 10 ms by which every report is late. Until the next one it goes as far again. */
const LATE_MM = 0.01 * SPEED_MM_PER_S;
const INKS = { predicted: [0x7d, 0xff, 0xb0], reported: [0xff, 0x7a, 0x1a] };

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

/** Most that is felt beside what the scene asks for, over the swing of that. */
const ERROR_MAX = 0.25;

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
  const page = await openWide();
  assert.deepEqual(await bands(page), { predicted: 0, reported: 0 }, "no band before one asks");
  await page.click("#open-lag");
  const stroke = await wholeStroke(page, 40);
  const lags = lagsOf(stroke);
  const shown = await said(page);
  context.diagnostic(`off by ${shown.predicted} mm with prediction, ${shown.reported} mm without`);
  for (const by of ["predicted", "reported"]) assert.ok(Math.abs(shown[by] - lags[by]) < 0.2, JSON.stringify({ shown, lags }));
  assert.ok(shown.predicted < 0.6 && shown.reported > LATE_MM, JSON.stringify(shown));
  await page.evaluate(() => wait(3000));
  const drawn = await bands(page);
  assert.ok(drawn.reported > 1.5 * drawn.predicted && drawn.predicted > 0, `${JSON.stringify(drawn)} pixels stay after the trail`);
  await page.click("#open-lag");
  await page.evaluate(() => wait(100));
  assert.deepEqual(await bands(page), { predicted: 0, reported: 0 });
});

test("the switch slides the same stroke again without prediction, which is felt and heard late", async (context) => {
  const page = await openWide();
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
  assert.ok(late > 1.4 * before && before < ERROR_MAX, `${late}, ${before}`);
  const shown = await said(page);
  assert.ok(shown.predicted < 0.6 && shown.reported > LATE_MM, `both are known of each stroke: ${JSON.stringify(shown)}`);
  const back = nextStroke(page);
  await page.locator("#prediction").check();
  assert.ok(errorOf(await back) < late / 1.4, "and with it again");
  const faster = nextStroke(page);
  await page.selectOption("#touch", "500");
  await faster;
  assert.ok((await said(page)).reported < 0.6 * shown.reported, "a faster touch source is followed more closely");
});

/** Lines of 1 mm, which reports that come every 10 ms are too rare for at 200 mm/s. */
const LINES = `version = 1

[[layer]]
kind = "constant"
friction_fraction = 0.9
region = { x_mm = 20, y_mm = 0, width_mm = 1, height_mm = 80 }
repeat = { columns = 10, dx_mm = 9 }
`;

test("lines that a board without prediction jumps over are said to be missed", async () => {
  const page = await openWide();
  await writeScene(page, LINES);
  await page.waitForFunction(() => studioPage.map.frictionAt(20.5, 40) - studioPage.map.frictionAt(25, 40) > 0.1);
  await page.click("#open-lag");
  await page.evaluate(() => stroke(10, 115, 40, 200));
  const words = await page.innerText("#lag-missed");
  // Its mean is of the others alone.
  const [, felt, lines, missed] = /^, at (\d+) of (\d+) lines: it missed (\d+)$/.exec(words) ?? [];
  assert.ok(Number(lines) === 10 && missed >= 3 && missed <= 9 && Number(felt) === lines - missed, words);
  assert.match(await page.innerText("#lag .fine"), /A missed line is not felt/);
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
  const page = await openStudio();
  await watchPlays(page);
  await page.click("#open-lag");
  await page.locator("#prediction").uncheck();
  await page.waitForFunction(() => watched.predicts.length === 1);
  await page.click("#open-lag");
  await page.waitForFunction(() => watched.predicts.length === 2);
  assert.deepEqual(await page.evaluate(() => watched.predicts), [false, true]);
  await page.click("#open-lag");
  assert.ok(await page.isChecked("#prediction"));
});

test("a setting that could not be played slides no stroke later, and another board has none to slide", async () => {
  const page = await openStudio();
  await page.click("#open-lag");
  await wholeStroke(page, 40);
  await watchPlays(page);
  await page.evaluate(() => (studioPage.editor.text = "version = 1\n[[layer]]\nkind = 7\n"));
  await page.locator("#problems li.error").first().waitFor();
  await page.selectOption("#touch", "500");
  await page.evaluate(() => wait(500));
  await writeScene(page, WHOLE_SCREEN_GRATING);
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
});
