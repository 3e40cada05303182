// The page in a browser: what it tells a person, where, and for how long; and what Ctrl+S saves.

import assert from "node:assert/strict";
import fs from "node:fs";
import { test } from "node:test";
import { boxes } from "./layout.mjs";
import { WHOLE_SCREEN_GRATING, give, liveGrating, openScene, openStudio, plays, resize, settled } from "./page.mjs";

const JPEG = new URL("../../../scenes/textures/wood.jpg", import.meta.url);
/** Distance at which a notice stands beside its control at most, CSS pixels. */
const BESIDE_MAX_PX = 16;
/** Longer than any good news stays, ms. */
const GONE_AFTER_MS = 30_000;

/** Distance between two boxes, along x and y. */
function distance(one, other) {
  const along = (from, to) => Math.max(0, one[from] - other[to], other[from] - one[to]);
  return Math.max(along("left", "right"), along("top", "bottom"));
}

const PARTS = ["#map-finger", "#numbers", "#scope", "#editor", "header"];

/** Says bad news, beside an element if there is one. */
const failBeside = (page, id) =>
  page.evaluate(async (id) => {
    const { notify } = await import(await studio.moduleUrl("page/notices.js"));
    notify("It failed.", undefined, { beside: document.getElementById(id) ?? undefined });
  }, id);

/** Presses Stop, which fails. */
async function failToStop(page) {
  await page.evaluate(() => {
    studioPage.engine.stop = () => Promise.reject(new Error("the board does not answer"));
  });
  await page.click("#stop");
  await page.locator("#notice").waitFor();
}

test("good news floats beside its control and goes, bad news stays", async () => {
  const page = await openStudio();
  const notice = page.locator("#notice");
  await page.waitForFunction(() => studioPage.map.frictionN.length > 0);
  await settled(page);
  const before = await boxes(page, PARTS);
  await page.click("#share");
  // The page's time goes on while the test measures: a notice under the pointer stays.
  await notice.hover();
  assert.deepEqual(await boxes(page, PARTS), before, "nothing moves");
  assert.equal(await notice.getAttribute("role"), "status");
  // Between both are the map's tools.
  const { "#notice": said, "#share": share, ".map-tools": tools } = await boxes(page, ["#notice", "#share", ".map-tools"]);
  const below = { ...share, bottom: tools.bottom };
  assert.ok(distance(said, below) <= BESIDE_MAX_PX, `${JSON.stringify([said, share])}: away from Share`);
  await page.mouse.move(5, 400);
  await page.evaluate((ms) => wait(ms), GONE_AFTER_MS);
  assert.ok(await notice.isHidden(), "good news goes");

  await failToStop(page);
  assert.equal(await notice.getAttribute("role"), "alert");
  assert.deepEqual(await boxes(page, PARTS), before, "nothing moves");
  const { "#notice": bad, "#stop": stop } = await boxes(page, ["#notice", "#stop"]);
  assert.ok(distance(bad, stop) <= BESIDE_MAX_PX, `${JSON.stringify([bad, stop])}: away from Stop`);
  assert.ok(bad.right <= (await page.evaluate(() => innerWidth)), "within the window");
  await page.evaluate((ms) => wait(ms), GONE_AFTER_MS);
  assert.ok(await notice.isVisible(), "bad news stays");
  await page.click("#notice >> [aria-label=Dismiss]");
  assert.ok(await notice.isHidden());
});

test("a notice lies over no tool of the map, is whole, and goes at Escape or, where it is good news, at a press elsewhere", async () => {
  const page = await openStudio(undefined, { isFirstVisit: true });
  const notice = page.locator("#notice");
  const share = () => page.evaluate(() => document.getElementById("share").click());
  for (const [width, height] of [[1440, 789], [1024, 768], [390, 844], [390, 664]]) {
    await resize(page, [width, height]);
    await share();
    await notice.waitFor();
    const { "#notice": box, ".map-tools": tools, header } = await boxes(page, ["#notice", ".map-tools", "header"]);
    const size = `${width}x${height}: ${JSON.stringify([box, tools])}`;
    assert.ok(box.top >= tools.bottom || box.left >= tools.right, size);
    assert.ok(box.top >= header.bottom && box.bottom <= height && box.left >= 0 && box.right <= width, size);
    const isCut = await page.evaluate(() => {
      const said = document.querySelector("#notice span");
      return said.scrollHeight > said.clientHeight;
    });
    assert.ok(!isCut, size);
    await page.keyboard.press("Escape");
    assert.ok(await notice.isHidden(), "Escape removes it");
    await share();
    await notice.waitFor();
    await page.mouse.click(box.left + 20, (box.top + box.bottom) / 2);
    assert.ok(await notice.isVisible(), "it is read under the pointer");
    await page.mouse.click(width / 2, height - 4);
    assert.ok(await notice.isHidden(), "a press elsewhere removes it");
  }
  await failToStop(page);
  await page.mouse.click(195, 660);
  assert.ok(await notice.isVisible(), "what failed stays");
  await page.keyboard.press("Escape");
  assert.ok(await notice.isHidden());
});

test("one Escape closes one thing: a menu before the notice, and in Edit the notice where no layer is selected", async () => {
  const page = await openStudio(undefined, { isFirstVisit: true });
  const notice = page.locator("#notice");
  const fail = () => failBeside(page);
  await page.click("#options summary");
  await fail();
  await page.keyboard.press("Escape");
  assert.ok(!(await page.locator("#options").evaluate(({ open }) => open)), "the menu is closed");
  assert.ok(await notice.isVisible(), "and the notice stays");
  await page.keyboard.press("Escape");
  assert.ok(await notice.isHidden());
  await page.click("text='Edit'");
  await page.locator(".layer-box").first().focus();
  await fail();
  await page.keyboard.press("Escape");
  assert.ok(await notice.isVisible(), "a layer is deselected");
  await page.keyboard.press("Escape");
  assert.ok(await notice.isHidden(), "and then the notice goes");
});

test("a notice follows its control when the page scrolls, and stays below the header", async () => {
  const page = await openStudio(undefined, { isFirstVisit: true });
  await resize(page, [390, 480]);
  const scroll = (to) => page.evaluate(async (to) => {
    document.querySelector("main").scrollTo(0, to);
    for (let frames = 0; frames < 2; frames += 1) await new Promise(requestAnimationFrame);
  }, to);
  await scroll(10_000);
  await failBeside(page, "pause");
  for (const to of [10_000, 60, 10_000]) {
    await scroll(to);
    const { "#notice": said, "#pause": pause } = await boxes(page, ["#notice", "#pause"]);
    assert.ok(distance(said, pause) <= BESIDE_MAX_PX, `${to}: ${JSON.stringify([said, pause])}`);
  }
  await failBeside(page, "scene-name");
  const { "#notice": said, header } = await boxes(page, ["#notice", "header"]);
  assert.ok(said.top >= header.bottom, JSON.stringify([said, header]));
});

test("a serial port that nobody chose is no failure, and a browser that gives none is a sentence", async () => {
  const page = await openStudio();
  const choose = async (name) => {
    await page.evaluate((name) => {
      globalThis.asked = false;
      const requestPort = () => {
        globalThis.asked = true;
        return Promise.reject(new DOMException("No port selected by the user.", name));
      };
      Object.defineProperty(navigator, "serial", { value: { requestPort, getPorts: async () => [] }, configurable: true });
    }, name);
    await page.click("#open-board");
    await page.click("text=Board on a USB port");
    await page.waitForFunction(() => globalThis.asked);
    await page.evaluate(() => wait(300));
  };
  await choose("NotFoundError");
  assert.ok(await page.locator("#notice").isHidden());
  assert.equal(await page.textContent("#board"), "Simulator: playing");
  await choose("SecurityError");
  assert.equal(await page.textContent("#notice span"), "The browser does not let this page use a serial port.");
});

test("Ctrl+S saves, wherever the focus is", async () => {
  const page = await openStudio();
  for (const focused of ["#editor .cm-content", "#map-finger"]) {
    await page.focus(focused);
    const [saved] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("Control+s")]);
    assert.equal(saved.suggestedFilename(), "brick.zip");
  }
});

test("names are cut at 64 characters", async () => {
  const page = await openStudio();
  const long = "n".repeat(300);
  const link = await page.evaluate(async ([name, text]) => {
    const { linkOf } = await import(await studio.moduleUrl("page/share.js"));
    return new URL(linkOf(name, text, [])).hash;
  }, [long, WHOLE_SCREEN_GRATING]);
  await page.evaluate((link) => (location.hash = link), link);
  await page.waitForFunction(() => document.getElementById("scene-name").value.startsWith("nnn"));
  assert.equal((await page.inputValue("#scene-name")).length, 64);
  assert.equal(await page.title(), `${"n".repeat(64)} · frixel studio`);
  await give(page, [`${"p".repeat(200)}.jpg`, fs.readFileSync(JPEG)]);
  await page.locator(".picture").waitFor();
  assert.equal(await page.textContent(".picture b"), `${"p".repeat(63)}…`);
  assert.ok((await page.textContent("#notice span")).length < 100, "and in what is said of it");
  const isWide = () => document.scrollingElement.scrollWidth > innerWidth;
  assert.ok(!(await page.evaluate(isWide)));
});

test("the slider of a gain ends where the drive does, and is never refused", async () => {
  const page = await openScene(liveGrating("ridges"));
  const slider = page.getByLabel("gain of ridges", { exact: true });
  const most = Number(await slider.getAttribute("max"));
  assert.ok(most > 1 && most < 2, `the grating of 0.1 N takes a gain of ${most}`);
  const sent = (gain) =>
    page.evaluate((gain) => studioPage.engine.control(`layer 1 gain ${gain}`).then(
      ({ notice }) => notice,
      ({ message }) => message,
    ), gain);
  assert.doesNotMatch((await sent(most)) ?? "", /can be reached/);
  assert.match((await sent(most + 0.05)) ?? "", /can be reached/, "the end of the slider is that of the drive");
});

test("Add as a layer writes what the board takes, in the shape of the picture", async () => {
  const page = await openStudio();
  await give(page, ["wide.jpg", fs.readFileSync(JPEG)]);
  const picture = page.locator(".picture", { hasText: "wide.jpg" });
  await picture.locator("text=Add as a layer").click();
  await page.waitForFunction(() => studioPage.editor.text.includes('picture = "wide.jpg"'));
  await plays(page);
  const ratio = await picture.locator("img").evaluate(({ naturalWidth, naturalHeight }) => naturalWidth / naturalHeight);
  const text = await page.evaluate(() => studioPage.editor.text);
  const [, x, y, width] = /name = "wide"[^[]*?x_mm = ([\d.]+)\ny_mm = ([\d.]+)\nwidth_mm = ([\d.]+)/.exec(text).map(Number);
  // The screen of brick.toml, mm.
  const [widthMm, heightMm] = [120, 110];
  assert.ok(x + width <= widthMm && y + width / ratio <= heightMm && width > 0.5 * widthMm, text);
});
