// The page in a browser: a person's work is not lost, and what is shown agrees with what is felt.

import assert from "node:assert/strict";
import { after, afterEach, test } from "node:test";
import { cleanUp, endLeftovers } from "./harness.mjs";
import { WHOLE_SCREEN_GRATING, openStudio, undisturbed, wholeStroke } from "./page.mjs";

afterEach(endLeftovers);
after(cleanUp);

const LIVE = WHOLE_SCREEN_GRATING.replace('kind = "grating"', 'name = "ridges"\nkind = "grating"\nlive = true');

test("a reload brings back the scene, its name and its finger", async () => {
  const { page, errors, close } = await openStudio();
  await page.evaluate((text) => played(text), WHOLE_SCREEN_GRATING);
  await page.fill("#scene-name", "ridges");
  await page.press("#scene-name", "Enter");
  await page.selectOption("#finger", "dry");
  await page.reload();
  await page.waitForFunction(() => globalThis.studioPage && document.getElementById("check").textContent === "plays");
  assert.equal(await page.evaluate(() => studioPage.editor.text), WHOLE_SCREEN_GRATING);
  assert.equal(await page.inputValue("#scene-name"), "ridges");
  assert.equal(await page.inputValue("#finger"), "dry");
  const broken = WHOLE_SCREEN_GRATING.replace("grating", "gratin");
  await page.evaluate((text) => (studioPage.editor.text = text), broken);
  await page.reload();
  await page.locator("#map-hint", { hasText: "mend the mistake" }).waitFor();
  assert.equal(await page.evaluate(() => studioPage.editor.text), broken);
  assert.deepEqual(errors, []);
  await close();
});

test("another scene has a history of its own, and the changed one before can be brought back", async () => {
  const { page, errors, close } = await openStudio();
  assert.ok(await page.isDisabled("#undo"), "nothing to undo");
  await page.evaluate((text) => played(text), WHOLE_SCREEN_GRATING);
  assert.ok(await page.isEnabled("#undo"));
  await page.click("#new");
  await page.waitForFunction(() => document.getElementById("scene-name").value === "untitled");
  assert.ok(await page.isDisabled("#undo"), "undo does not lead into the scene before");
  assert.match(await page.evaluate(() => studioPage.editor.text), /^version = 2\n\n# Type/);
  await page.click("text=Back to brick");
  await page.waitForFunction((text) => studioPage.editor.text === text, WHOLE_SCREEN_GRATING);
  assert.equal(await page.inputValue("#scene-name"), "brick");
  assert.deepEqual(errors, []);
  await close();
});

test("a press on the map ends a replay and is felt; the button stops one, too", async () => {
  const { page, errors, close } = await openStudio();
  await wholeStroke(page, 40);
  const button = page.locator("#replay");
  await page.selectOption("#slowness", "25");
  await page.check("#loop");
  const pressOnReplay = async () => {
    const { samples } = studioPage;
    const replay = document.getElementById("replay");
    replay.click();
    while (replay.textContent !== "Stop replay") await wait(20);
    await wait(300);
    const beginS = samples.nowS;
    await slide(20, 60, 20, 80);
    lift(60, 20);
    await wait(200);
    return samples.since(beginS).yMm.filter((mm) => Math.abs(mm - 20) < 2).length;
  };
  const felt = await undisturbed(page, () => page.evaluate(pressOnReplay));
  assert.ok(felt > 200, `${felt} samples of the new stroke`);
  await page.locator("text=Replay slowly").waitFor();
  await button.click();
  await page.locator("text=Stop replay").click();
  await page.locator("text=Replay slowly").waitFor();
  assert.deepEqual(errors, []);
  await close();
});

test("layer and map say that a switch or a gain differs from the scene", async () => {
  const { page, errors, close } = await openStudio();
  await page.evaluate((text) => played(text), LIVE);
  const note = page.locator("#map-note");
  assert.ok(await note.isHidden());
  await page.getByLabel("ridges on").uncheck();
  await page.waitForFunction(() => /Now: ridges off/.test(document.getElementById("map-note").textContent));
  assert.match(await page.locator(".live-note").textContent(), /^Off now/);
  await page.getByLabel("ridges on").check();
  const gain = page.getByLabel("gain of ridges, as a number");
  await gain.fill("0.5");
  await page.waitForFunction(() => /ridges × 0.5/.test(document.getElementById("map-note").textContent));
  await gain.fill("2000");
  await gain.press("Enter");
  await page.waitForFunction(() => /it stays 0.5/.test(document.getElementById("notice").textContent));
  assert.equal(await gain.inputValue(), "0.5");
  await page.evaluate((text) => played(text), WHOLE_SCREEN_GRATING);
  assert.ok(await note.isHidden(), "the scene plays anew");
  assert.deepEqual(errors, []);
  await close();
});

test("a blind comparison is answered after both were felt, and can be cancelled", async () => {
  const { page, errors, close } = await openStudio();
  await page.click("#tab-compare");
  await page.click("text=Keep this scene as A");
  await page.evaluate((text) => played(text), WHOLE_SCREEN_GRATING);
  await page.click("text=Compare A with the scene now");
  assert.ok(await page.isDisabled("text=X is better"));
  await page.click("text=Feel Y");
  assert.ok(await page.isEnabled("text=X is better"));
  await page.click("text=Turn sound on");
  await page.waitForFunction(() => studioPage.sound.isOn);
  await page.click("#panel-compare >> text=Cancel");
  await page.locator("text=it does not count").waitFor();
  assert.equal(await page.locator("body.blind").count(), 0);
  assert.deepEqual(errors, []);
  await close();
});
