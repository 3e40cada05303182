// The page in a browser: its first seconds say nothing that is wrong, and a file takes no more memory than is stated.

import assert from "node:assert/strict";
import { after, afterEach, test } from "node:test";
import { cleanUp, endLeftovers, openPage, pageUrl } from "./harness.mjs";
import { assertSays, give, openStudio } from "./page.mjs";

afterEach(endLeftovers);
after(cleanUp);

const BARE_GLASS = "version = 1\n";

/** Collects, in the page, what the numbers say at each frame until `stop()`; returns the texts of friction and Weber steps. */
function watchNumbers() {
  const texts = [];
  // A hidden unit is not said.
  const visibleText = (each) =>
    [...each.children].filter(({ hidden }) => !hidden).map(({ textContent }) => textContent).join(" ").trim();
  const leave = eachFrame(() => {
    const shown = [...document.querySelectorAll("#numbers dd.felt")].map((each) => visibleText(each));
    texts.push(...shown);
  });
  globalThis.stopWatching = () => {
    leave();
    return [...new Set(texts)];
  };
}

/** A number of at most three digits with its unit, no number, or what to do to get one. */
const SENSIBLE = /^(\d{1,3} mN|\d{1,2}\.\d Weber steps|– (mN|Weber steps)|slide to feel)$/;

test("press and hold, bare glass and standstill say no negative number, but slide to feel", async () => {
  const { page, errors, close } = await openStudio();
  const pressAndHold = async () => {
    slide(40, 40, 30, 80);
    await wait(1500);
    const texts = stopWatching();
    lift(40, 30);
    await wait(300);
    return texts;
  };
  await page.evaluate(watchNumbers);
  const held = await page.evaluate(pressAndHold);
  assert.ok(held.includes("slide to feel"), held.join(", "));
  assert.deepEqual(held.filter((text) => !SENSIBLE.test(text)), []);

  await page.evaluate((text) => played(text), BARE_GLASS);
  const slideAndRest = async () => {
    await slide(15, 105, 30, 80);
    await wait(1000);
    const texts = stopWatching();
    lift(105, 30);
    await wait(300);
    return texts;
  };
  await page.evaluate(watchNumbers);
  const slid = await page.evaluate(slideAndRest);
  assert.ok(slid.includes("slide to feel"), "the finger rests at the end");
  assert.ok(slid.some((text) => /^\d+ mN$/.test(text)), "friction is felt on the way");
  assert.deepEqual(slid.filter((text) => !SENSIBLE.test(text)), []);
  assert.deepEqual(errors, []);
  await close();
});

test("the scope draws from its first sample on", async () => {
  const { page, errors, close } = await openStudio();
  // A scope of the test's own, with a board that has just been switched on.
  const changes = await page.evaluate(async () => {
    const [{ Scope }, { Samples }] = await Promise.all(
      ["page/scope.js", "page/samples.js"].map(async (name) => import(await studio.moduleUrl(name))),
    );
    const box = document.body.appendChild(document.createElement("div"));
    const samples = new Samples();
    const scope = new Scope(samples, box);
    const picture = () => box.querySelector("canvas").toDataURL();
    await wait(300);
    const empty = picture();
    const values = (number) => new Float32Array(100).fill(number);
    const frame = {
      firstTick: 0, ticksPerSample: 40, contact: true, xMm: values(20), yMm: values(20), speedMmPerS: values(80),
      referenceN: values(0.3), feltN: values(0.3), voltageV: values(90),
      predictedXMm: values(20), predictedYMm: values(20), reportedXMm: values(20), reportedYMm: values(20),
      contactRadiusMm: values(4),
    };
    samples.add(frame);
    scope.feel(frame);
    await wait(300);
    box.remove();
    return picture() !== empty;
  });
  assert.ok(changes, "a tenth of a second is drawn");
  assert.deepEqual(errors, []);
  await close();
});

/** A zip of files of zeros, which the page's own library packs: its sizes in bytes, as they are unpacked. */
async function zipOfZeros(page, sizes) {
  const packed = await page.evaluate(async (sizes) => {
    const { zipSync } = await import(await studio.moduleUrl("vendor/studio-vendor.js"));
    const files = sizes.map((size, at) => [`zeros-${at}.png`, new Uint8Array(size)]);
    const bytes = zipSync(Object.fromEntries([["scene.toml", new TextEncoder().encode("version = 1\n")], ...files]));
    let text = "";
    for (const byte of bytes) text += String.fromCharCode(byte);
    return btoa(text);
  }, sizes);
  return Buffer.from(packed, "base64");
}

test("a small zip that unpacks to more than 32 MB is refused with its size", async () => {
  const { page, errors, close } = await openStudio();
  const bomb = await zipOfZeros(page, Array(6).fill(7_000_000));
  assert.ok(bomb.length < 100_000, `${bomb.length} bytes`);
  await give(page, ["bomb.zip", bomb]);
  await assertSays(page, /unpacks to 7 files of together 42\.0 MB; .* at most 100 files of together 32 MB/);
  await give(page, ["many.zip", await zipOfZeros(page, Array(150).fill(1))]);
  await assertSays(page, /unpacks to 151 files/);
  const shared = await zipOfZeros(page, [1000, 1000]);
  // The first entry of the list at the end says that its file has more packed bytes than the zip.
  shared.writeUInt32LE(shared.length, shared.indexOf(Buffer.from("PK\x01\x02", "latin1")) + 20);
  await give(page, ["shared.zip", shared]);
  await assertSays(page, /The files of this zip lie over one another/);
  assert.match(await page.evaluate(() => studioPage.editor.text), /brick/, "the scene before stays");
  assert.deepEqual(errors, []);
  await close();
});

test("the map of a long screen has as many pixels along its longer side as any", async () => {
  const { page, errors, close } = await openStudio();
  const sizes = await page.evaluate(async () => {
    const { player } = studioPage;
    const before = player.onMap;
    const sizes = [];
    player.onMap = (map, check) => {
      sizes.push([map.widthPx, map.heightPx]);
      before(map, check);
    };
    for (const [widthMm, heightMm] of [[5, 2000], [2000, 5]]) {
      await played(`version = 1\n[screen]\nwidth_mm = ${widthMm}\nheight_mm = ${heightMm}\n`);
      while (sizes.length === 0 || sizes.at(-1)[0] > sizes.at(-1)[1] !== widthMm > heightMm) await wait(20);
    }
    return sizes;
  });
  assert.ok(sizes.some(([widthPx, heightPx]) => widthPx < heightPx / 50), "the long screen stands");
  for (const [widthPx, heightPx] of sizes) assert.ok(Math.max(widthPx, heightPx) <= 960, `${widthPx} x ${heightPx}`);
  assert.deepEqual(errors, []);
  await close();
});

test("the columns stand before the engine is ready, and where they are then, also at the next visit", async () => {
  const init = () => {
    globalThis.widths = [];
    const look = () => {
      const card = document.querySelector(".map-card");
      const numbers = document.querySelectorAll("#numbers div").length;
      // The scripts have begun once the numbers are there.
      if (card && numbers > 0) {
        const said = document.getElementById("map-hint").textContent;
        widths.push({ width: Math.round(card.getBoundingClientRect().width), isStarting: said === "starting…" });
      }
      requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
    // The engine is ready after a picture of the page without it, however fast the machine is.
    const compile = WebAssembly.compile;
    WebAssembly.compile = async (bytes) => {
      while (!widths.some(({ isStarting }) => isStarting)) await new Promise(requestAnimationFrame);
      return compile(bytes);
    };
  };
  const { page, errors, close } = await openPage(pageUrl, { init });
  const seen = async () => {
    await page.waitForFunction(() => document.getElementById("check")?.textContent === "plays");
    await page.waitForFunction(() => widths.some(({ isStarting }) => !isStarting));
    const all = await page.evaluate(() => widths);
    assert.ok(all.some(({ isStarting }) => isStarting), "the columns were there before");
    return [...new Set(all.map(({ width }) => width))];
  };
  assert.equal((await seen()).length, 1);
  await page.waitForFunction(() => globalThis.studioPage);
  await give(page, ["wide.toml", "version = 1\n[screen]\nwidth_mm = 150\nheight_mm = 60\n"]);
  await page.waitForFunction(() => studioPage.map.screen.widthMm === 150);
  await page.reload();
  const again = await seen();
  assert.equal(again.length, 1, `${again}`);
  assert.equal(await page.evaluate(() => studioPage.map.screen.widthMm), 150);
  assert.deepEqual(errors, []);
  await close();
});
