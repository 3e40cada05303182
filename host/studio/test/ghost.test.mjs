// The page in a browser, as a stranger meets it: a ghost finger slides until someone presses, and only in the simulator.

import assert from "node:assert/strict";
import { test } from "node:test";
import { setVisibility } from "./harness.mjs";
import { compareBlind, openStudio, plays, resize, showDrawer } from "./page.mjs";

/** Opens the page as a stranger does, and waits for its map, without which no ghost slides. In it, `sent` is what goes to the board as touch. */
async function openAsStranger(options = {}) {
  const page = await openStudio(undefined, { isFirstVisit: true, ...options });
  await page.waitForFunction(() => studioPage.map.frictionN.length > 0);
  await page.evaluate(() => {
    globalThis.sent = [];
    const { engine } = studioPage;
    const send = engine.pointer.bind(engine);
    engine.pointer = (sample) => {
      sent.push(sample);
      send(sample);
    };
    const lift = engine.lift.bind(engine);
    engine.lift = () => {
      sent.push({ down: false });
      lift();
    };
  });
  return page;
}

/** What is sent in this time, ms. */
const sentIn = (page, ms) =>
  page.evaluate(async (ms) => {
    const before = sent.length;
    await wait(ms);
    return sent.slice(before);
  }, ms);

/** How many pictures the page draws in two seconds. */
const drawnInTwoSeconds = (page) =>
  page.evaluate(async () => {
    let count = 0;
    const clear = CanvasRenderingContext2D.prototype.clearRect;
    CanvasRenderingContext2D.prototype.clearRect = function (...box) {
      count += 1;
      clear.apply(this, box);
    };
    await wait(2000);
    CanvasRenderingContext2D.prototype.clearRect = clear;
    return count;
  });

const scope = () => document.querySelector("#scope canvas").toDataURL();

test("after ten seconds without input: one sentence, a scope that moves, and sound", async () => {
  const page = await openAsStranger();
  await page.evaluate(() => wait(10_000));
  const sentences = (await page.locator("#first-sentence").innerText()).match(/[^.!?]+[.!?]/g);
  assert.equal(sentences?.length, 1, `${sentences}`);
  assert.match(await page.innerText("#first-hint"), /ghost finger is sliding: press to take over/);
  const pictures = [];
  for (let count = 0; count < 3; count += 1) {
    pictures.push(await page.evaluate(scope));
    await page.evaluate(() => wait(500));
  }
  assert.equal(new Set(pictures).size, 3, "the scope moves");
  const felt = await page.evaluate(() => {
    const { samples } = studioPage;
    return samples.since(samples.nowS - 3).feltN.filter(Number.isFinite);
  });
  assert.ok(Math.max(...felt) - Math.min(...felt) > 0.05, "the wall is felt");
  assert.ok(await page.isDisabled("#replay"), "there is no stroke of one's own");
  await page.click("#hear");
  await page.locator("#hear", { hasText: "Sound off" }).waitFor();
  assert.ok((await sentIn(page, 3000)).some(({ down }) => down), "the ghost slides on while it is heard");
});

test("a press takes over for good: the ghost lifts first, then the press plays", async () => {
  const page = await openAsStranger();
  await page.evaluate(() => wait(800));
  const pressed = await page.evaluate(async () => {
    const before = sent.length;
    await slide(20, 60, 55, 100);
    const own = sent.slice(before);
    await wait(200);
    const { samples } = studioPage;
    const { xMm, yMm } = samples.since(samples.nowS - 0.7);
    const came = { ups: xMm.filter(Number.isNaN).length, firstYMm: yMm[xMm.findLastIndex(Number.isNaN) + 1] };
    return { sent: own, wasDown: sent[before - 1].down, came };
  });
  assert.ok(pressed.wasDown, "the ghost was sliding");
  const [lift, ...own] = pressed.sent;
  assert.deepEqual([lift.down, own.every(({ down }) => down)], [false, true]);
  assert.ok(own.every(({ yMm }) => Math.abs(yMm - 55) < 0.2), JSON.stringify(own.slice(0, 3)));
  const { came } = pressed;
  assert.ok(came.ups > 20 && Math.abs(came.firstYMm - 55) < 0.2, `no way leads from ghost to press: ${JSON.stringify(came)}`);
  // The board's finger is the person's, and nobody moves it away.
  const places = await page.evaluate(async () => {
    await wait(200);
    const { samples } = studioPage;
    const { xMm, yMm } = samples.since(samples.nowS - 0.1);
    lift(60, 55);
    return { xMm, yMm };
  });
  assert.ok(places.xMm.length > 80 && places.xMm.every((xMm) => Math.abs(xMm - 60) < 1), `${places.xMm.slice(0, 5)}`);
  assert.ok(places.yMm.every((yMm) => Math.abs(yMm - 55) < 0.2), `${places.yMm.slice(0, 5)}`);
  assert.ok((await sentIn(page, 5000)).length <= 1, "but for the lift");
  assert.ok(await page.isHidden("#first-sentence"));
  assert.ok(await page.isVisible("#hear"), "sound is still offered");
});

test("a key and a click take over, too; a pointer that only passes and Tab do not", async () => {
  for (const act of [
    (page) => page.keyboard.press("ArrowRight"),
    (page) => page.evaluate(() => document.getElementById("map-finger").click()),
  ]) {
    const page = await openAsStranger();
    await page.locator("#map-finger").hover({ position: { x: 30, y: 30 } });
    await page.focus("#map-finger");
    await page.keyboard.press("Shift");
    const passed = await sentIn(page, 1200);
    assert.ok(passed.filter(({ down }) => down).length > 50, "the ghost goes on");
    await act(page);
    await page.evaluate(() => wait(100));
    assert.deepEqual(await sentIn(page, 3000), []);
  }
});

test("hidden, in a blind comparison and stopped, it lifts and sends nothing; it goes on when the page is back", async () => {
  const page = await openAsStranger();
  const isLifted = async (what) => {
    assert.equal(await page.evaluate(() => sent.at(-1).down), false, what);
    assert.deepEqual(await sentIn(page, 3000), [], what);
  };
  await page.evaluate(() => wait(800));
  await setVisibility(page, "hidden");
  await isLifted("hidden");
  await setVisibility(page, "visible");
  await page.waitForFunction(() => document.documentElement.dataset.state === "active");
  assert.ok((await sentIn(page, 2000)).some(({ down }) => down), "it goes on");
  await page.click("#stop");
  await page.waitForFunction(() => document.documentElement.dataset.state === "disarmed");
  await page.evaluate(() => wait(100));
  await isLifted("stopped");
  assert.equal(await drawnInTwoSeconds(page), 0, "and nothing is drawn");
  await page.click("#stop");
  assert.ok((await sentIn(page, 2000)).some(({ down }) => down), "it goes on");
  await showDrawer(page);
  await compareBlind(page);
  await page.evaluate(() => wait(100));
  await isLifted("blind");
});

test("after a minute it rests, and its pictures end", async () => {
  const page = await openAsStranger();
  assert.ok((await sentIn(page, 55_000)).some(({ down }) => down));
  await page.evaluate(() => wait(12_000));
  assert.deepEqual(await sentIn(page, 5000), []);
  assert.equal(await page.innerText("#first-hint"), "Press and slide to feel it.");
  assert.equal(await drawnInTwoSeconds(page), 0, "nothing is drawn in an idle page");
});

test("who asks for less motion sees none before a press, but the words and the sound", async () => {
  const page = await openAsStranger();
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.reload();
  await plays(page);
  const touched = await page.evaluate(async () => {
    await wait(5000);
    const { samples } = studioPage;
    return samples.since(0).xMm.filter(Number.isFinite).length;
  });
  assert.equal(touched, 0);
  assert.equal(await page.innerText("#first-hint"), "Press and slide to feel it.");
  assert.ok(await page.isVisible("#hear"));
});

test("once a board is connected it sends nothing, and the words go and stay away", async () => {
  const page = await openAsStranger();
  assert.ok((await sentIn(page, 2000)).some(({ down }) => down));
  for (const link of ["serial", "simulator"]) {
    await page.evaluate((link) => {
      const { engine } = studioPage;
      Object.defineProperty(engine, "state", { value: { ...engine.state, link }, configurable: true });
      engine.onState(engine.state);
    }, link);
    await page.evaluate(() => wait(100));
    assert.deepEqual(await sentIn(page, 3000), [], link);
    assert.ok(await page.isHidden("#first-words"), link);
  }
});

test("a slide that begins on the words is one on the map, and leads to no other page", async () => {
  const page = await openAsStranger();
  for (const [width, height] of [[390, 844], [1366, 657]]) {
    await resize(page, [width, height]);
    const met = await page.evaluate(() =>
      ["first-sentence", "first-hint", "hear", "first-dismiss"].map((id) => {
        const { x, y, width, height } = document.getElementById(id).getBoundingClientRect();
        const found = document.elementFromPoint(x + width / 2, y + height / 2);
        return [found.id, getComputedStyle(found).touchAction];
      }),
    );
    const map = ["map-finger", "none"];
    assert.deepEqual(met, [map, map, ["hear", "none"], ["first-dismiss", "none"]], `${width}`);
  }
  const over = await page.evaluate(() => [document.documentElement, document.querySelector("main")]
    .map((each) => getComputedStyle(each).overscrollBehaviorX));
  assert.deepEqual(over, ["none", "none"]);
});

test("a page or a board that is held up makes no finger shoot over the map", async () => {
  const page = await openAsStranger();
  for (const name of ["page", "board"]) {
    const felt = await page.evaluate(async (name) => {
      // In the middle of a stroke.
      const isMidway = () => sent.length > 40 && sent.slice(-40).every(({ down }) => down);
      sent.length = 0;
      while (!isMidway()) await wait(8);
      const { samples } = studioPage;
      const fromS = samples.nowS;
      if (name === "page") await hang(300);
      else {
        const worker = workersOfPage.board.at(-1);
        worker.step = async () => {};
        await wait(300);
        delete worker.step;
      }
      await wait(600);
      const { speedMmPerS, xMm } = samples.since(fromS);
      return { fastest: Math.max(...speedMmPerS.filter(Number.isFinite)), slid: xMm.filter(Number.isFinite).length };
    }, name);
    assert.ok(felt.slid > 200 && felt.fastest < 200, `${name}: ${JSON.stringify(felt)}`);
  }
});
