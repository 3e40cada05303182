// The page in a browser: texts of scenes, their mistakes, layers and drafts.

import assert from "node:assert/strict";
import { after, afterEach, test } from "node:test";
import { cleanUp, endLeftovers } from "./harness.mjs";
import { assertSays, openIncluding, openStudio, tabsOf, wholeStroke } from "./page.mjs";

afterEach(endLeftovers);
after(cleanUp);

test("completion offers what the kind of a layer has, and the kind first", async () => {
  const { page, errors, close } = await openStudio();
  const offered = async (layer) => {
    await page.evaluate((text) => (studioPage.editor.text = text), `version = 1\n[[layer]]\n${layer}\n`);
    await page.evaluate(() => studioPage.editor.goTo(undefined, 99));
    await page.keyboard.press("Control+Space");
    const labels = page.locator(".cm-tooltip-autocomplete .cm-completionLabel");
    await labels.first().waitFor();
    const found = await labels.allTextContents();
    await page.keyboard.press("Escape");
    return found;
  };
  assert.equal((await offered(""))[0], "kind");
  assert.ok((await offered('kind = "grating"')).includes("duty"));
  const constant = await offered('kind = "constant"');
  assert.ok(constant.includes("friction_n") && !constant.includes("duty") && !constant.includes("x_px"), `${constant}`);
  assert.deepEqual(errors, []);
  await close();
});

test("bad scenes are sentences", async () => {
  const { page, errors, close } = await openStudio();
  for (const [text, expected] of [
    ["", /no `version`/],
    ["]]][[[ = = \u0000", /not TOML/],
    ['version = 1\n[[layer]]\nkind = "<img src=x onerror=alert(1)>"\n', /<img src=x onerror=alert\(1\)>/],
    [
      'version = 1\n[[layer]]\nkind = "bitmap"\npicture = "../../etc/passwd"\nx_mm = 0\ny_mm = 0\nwidth_mm = 9\n',
      /passwd/,
    ],
    [`version = 1\n${'[[layer]]\nkind = "constant"\nfriction_n = 0.3\n'.repeat(2000)}`, /the board takes 64/],
  ]) {
    await page.evaluate((text) => (studioPage.editor.text = text), text);
    await assertSays(page, expected);
  }
  assert.equal(await page.locator("#problems img").count(), 0, "text stays text");
  assert.deepEqual(errors, []);
  await close();
});

test("a mistake in an included file is marked in that file", async () => {
  const { page, errors, close } = await openIncluding();
  assert.deepEqual(await tabsOf(page), ["play.toml", "keys.toml"]);
  await page.click("#file-tabs >> text=keys.toml");
  await page.evaluate(() => studioPage.editor.goTo("keys.toml", 5));
  await page.keyboard.press("End");
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.type("x");
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
  await page.waitForFunction(() => document.getElementById("check").textContent === "plays");
  assert.deepEqual(errors, []);
  await close();
});

test("layers of other files and with copies have their places, switches and gains", async () => {
  const { page, errors, close } = await openIncluding();
  const titles = await page.locator("#panel-layers .layer > div:first-child").allTextContents();
  assert.deepEqual(titles, ["key constant × 3, keys.toml", "wood bitmap, keys.toml", "strip constant"]);
  const gain = page.getByLabel("gain of key, as a number");
  assert.deepEqual(await gain.evaluate(({ value, min, max }) => [value, min, max]), ["0.5", "-100", "100"]);
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
  assert.deepEqual(errors, []);
  await close();
});

test("a scene that a board refuses plays as a draft, and is called so", async () => {
  const { page, errors, close } = await openStudio();
  const heavy = 'version = 1\n[[layer]]\nkind = "constant"\nfriction_n = 0.9\n';
  await page.evaluate((text) => played(text), heavy);
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
  await page.evaluate((text) => played(text), heavy.replace("0.9", "0.3"));
  await page.waitForFunction(() => document.getElementById("check").textContent === "plays");
  assert.ok(await page.locator(".scope-card .draft").isHidden());
  await markedAs(false);
  assert.deepEqual(errors, []);
  await close();
});

test("the line that a person writes stays in sight when the list of mistakes opens below it", async () => {
  const { page, errors, close } = await openStudio();
  await page.setViewportSize({ width: 1366, height: 657 });
  const lines = Array.from({ length: 40 }, (_, at) => `# line ${at + 1}`);
  const text = `${lines.join("\n")}\nversion = 1\n`;
  await page.evaluate((text) => played(text), text);
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
  assert.deepEqual(errors, []);
  await close();
});
