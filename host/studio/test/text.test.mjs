// The page in a browser: texts of scenes, their mistakes, layers and drafts.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  WHOLE_SCREEN_GRATING, assertSays, openIncluding, openScene, openStudio, plays, resize, tabsOf, wholeStroke,
  writeScene,
} from "./page.mjs";

/** Types a letter into the word in quotation marks at the end of a line. */
async function typeAtEnd(page, file, line) {
  await page.evaluate(([file, line]) => studioPage.editor.goTo(file, line), [file, line]);
  for (const key of ["End", "ArrowLeft", "x"]) await page.keyboard.press(key);
}

test("a mistake that is typed is said and marked, also while the text is closed, and the scene before plays on", async () => {
  const page = await openScene(WHOLE_SCREEN_GRATING);
  const marks = () =>
    page.evaluate(() => ["felt", "panel-layers"].map((id) => getComputedStyle(document.getElementById(id), "::before").content));
  assert.deepEqual(await marks(), ["none", "none"]);
  await typeAtEnd(page, undefined, 4);
  const shown = page.locator("#problems li.error");
  await shown.waitFor();
  assert.match(await shown.textContent(), /gratingx/);
  await page.locator(".cm-lintRange-error").waitFor();
  assert.equal(await page.evaluate(() => document.documentElement.dataset.state), "active");
  for (const mark of await marks()) assert.match(mark, /the version before/);
  await page.click("#toggle-drawer");
  await page.locator("#mistakes", { hasText: "1" }).waitFor();
  assert.equal(await page.locator("#mistakes").getAttribute("aria-label"), "1 mistake");
  assert.match(await page.textContent("#check"), /1 mistake; the one before plays/);
  await page.click("#toggle-drawer");
  assert.ok(await shown.isVisible(), "the button leads to it");
  await page.focus(".cm-content");
  await page.keyboard.press("Backspace");
  await plays(page);
  assert.equal(await shown.count(), 0);
  assert.deepEqual(await marks(), ["none", "none"]);
  assert.equal(await page.evaluate(() => studioPage.editor.text), WHOLE_SCREEN_GRATING);
});

test("what a scene says stays text in the sentence about it", async () => {
  const page = await openStudio();
  const kind = "<img src=x onerror=alert(1)>";
  await page.evaluate((text) => (studioPage.editor.text = text), `version = 1\n[[layer]]\nkind = "${kind}"\n`);
  await assertSays(page, /<img src=x onerror=alert\(1\)>/);
  assert.equal(await page.locator("#problems img").count(), 0);
});

test("a mistake in an included file is marked in that file", async () => {
  const page = await openIncluding();
  assert.deepEqual(await tabsOf(page), ["play.toml", "keys.toml"]);
  await page.click("#file-tabs >> text=keys.toml");
  await typeAtEnd(page, "keys.toml", 5);
  await page.locator(".cm-lintRange-error").waitFor();
  assert.equal(await page.locator("#problems li button").textContent(), "keys.toml, line 5");
  assert.match(await page.locator("#problems li").textContent(), /constantx/);
  assert.deepEqual(await tabsOf(page), ["play.toml", "keys.toml1"]);
  await page.click("#file-tabs >> text=play.toml");
  assert.equal(await page.locator(".cm-lintRange-error").count(), 0, "the scene itself has no mistake");
  await page.click("#problems li button");
  await page.locator(".cm-lintRange-error").waitFor();
  await page.keyboard.press("End");
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("Backspace");
  await plays(page);
});

test("layers of other files and with copies have their places, switches and gains", async () => {
  const page = await openIncluding();
  const titles = await page.locator("#panel-layers .layer > div:first-child").allTextContents();
  assert.deepEqual(titles, ["key constant × 3, keys.toml", "wood bitmap, keys.toml", "strip constant"]);
  const gain = page.getByLabel("gain of key, as a number");
  assert.equal(await page.getByLabel("gain of key", { exact: true }).inputValue(), "0.5");
  await page.evaluate(() => {
    const { engine } = studioPage;
    globalThis.lines = [];
    const control = engine.control.bind(engine);
    engine.control = (line) => control(line).then(() => lines.push(line));
  });
  await gain.fill("0.25");
  await page.waitForFunction(() => lines.length === 3);
  assert.deepEqual(await page.evaluate(() => lines.sort()), [1, 2, 3].map((copy) => `layer 1.${copy} gain 0.25`));
  await page.click("#panel-layers >> text=wood");
  const line = await page.evaluate(() => {
    const { editor } = studioPage;
    return [editor.files.find(({ isShown }) => isShown).name, document.querySelector(".cm-activeLine").textContent];
  });
  assert.deepEqual(line, ["keys.toml", "[[layer]]"]);
  await page.locator("#panel-layers .layer", { hasText: "wood" }).locator("text=Make live").click();
  await page.getByLabel("wood on").waitFor();
  assert.match(await page.evaluate(() => globalThis.studioPage.editor.text), /^version = 1\ninclude/);
});

test("a scene that a board refuses plays as a draft, and is called so", async () => {
  const heavy = 'version = 1\n[[layer]]\nkind = "constant"\nfriction_n = 0.9\n';
  const page = await openStudio();
  await writeScene(page, heavy);
  assert.match(await page.locator("#check").textContent(), /1 mistake; draft/);
  assert.match(await page.locator("#problems li.error").textContent(), /line 4.*newton|line 4.* N/s);
  assert.ok(await page.locator(".scope-card .draft").isVisible());
  const most = Math.max(...(await wholeStroke(page, 40)).voltageV);
  assert.ok(most > 140, `clamped to the largest voltage, found ${most} V`);
  await page.click("#scope-options summary");
  const [saved] = await Promise.all([page.waitForEvent("download"), page.click("#save-csv")]);
  assert.match(saved.suggestedFilename(), /draft/);
  /** Waits until the map is marked as a draft, with black in its corner, or is not. */
  const markedAs = (isDraft) =>
    page.waitForFunction((isDraft) => {
      const canvas = document.getElementById("map-picture");
      const finger = document.getElementById("map-finger").getBoundingClientRect();
      const box = canvas.getBoundingClientRect();
      const inset = 4;
      const place = [finger.x - box.x + inset, finger.y - box.y + inset].map((px) => px * devicePixelRatio);
      const [red, green, blue, alpha] = canvas.getContext("2d").getImageData(...place, 1, 1).data;
      return alpha === 255 && (isDraft ? red + green + blue === 0 : blue > 0);
    }, isDraft);
  await markedAs(true);
  await writeScene(page, heavy.replace("0.9", "0.3"));
  await plays(page);
  assert.ok(await page.locator(".scope-card .draft").isHidden());
  await markedAs(false);
});

test("the line that a person writes stays in sight when the list of mistakes opens below it", async () => {
  const page = await openStudio();
  await resize(page, [1366, 657]);
  const lines = Array.from({ length: 40 }, (_, at) => `# line ${at + 1}`);
  const text = `${lines.join("\n")}\nversion = 1\n`;
  await writeScene(page, text);
  await page.evaluate(() => studioPage.editor.goTo(undefined, 1));
  const isSeen = () => {
    const [editor, cursor] = ["#editor .cm-scroller", "#editor .cm-cursor"].map((each) =>
      document.querySelector(each)?.getBoundingClientRect(),
    );
    return cursor !== undefined && cursor.top >= editor.top && cursor.bottom <= editor.bottom;
  };
  // As low as the editor shows.
  const shown = await page.evaluate(() => {
    const { clientHeight } = document.querySelector("#editor .cm-scroller");
    return Math.floor(clientHeight / document.querySelector("#editor .cm-line").clientHeight);
  });
  for (let down = 1; down < shown - 1; down += 1) await page.keyboard.press("ArrowDown");
  await page.keyboard.press("End");
  await page.keyboard.type("\nx = 0,05");
  await page.locator("#problems li.error").waitFor();
  await page.waitForFunction(isSeen);
});
