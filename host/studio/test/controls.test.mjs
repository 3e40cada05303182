// The page in a browser: controls of a scene do nothing once another one is there.

import assert from "node:assert/strict";
import { test } from "node:test";
import { liveGrating, openScene, openStudio, writeScene } from "./page.mjs";

test("the gains that are shown are those of the scene that plays, also where one has the focus", async () => {
  const page = await openScene(liveGrating("ridges"));
  await page.click("#tab-layers");
  const gain = page.getByLabel("gain of ridges, as a number");
  await gain.focus();
  await writeScene(page, liveGrating("ridges").replace("live = true", "live = true\ngain = 0.5"));
  assert.equal(await gain.inputValue(), "0.5");
  assert.ok(await gain.evaluate((input) => input === document.activeElement), "the focus stays");
  await writeScene(page, liveGrating("waves"));
  assert.equal(await gain.count(), 0);
  assert.equal(await page.getByLabel("gain of waves, as a number").count(), 1);
});

test("a gain is not sent while another scene is on its way", async () => {
  const page = await openScene(liveGrating("ridges"));
  const sent = await page.evaluate((text) => {
    const { editor, engine } = studioPage;
    const lines = [];
    engine.control = async (line) => lines.push(line);
    editor.text = text;
    document.querySelector("#panel-layers input[type=checkbox]").click();
    return lines;
  }, liveGrating("waves"));
  assert.deepEqual(sent, []);
  await page.getByLabel("waves on").waitFor({ state: "attached" });
});

test("on the full screen the map has the size that a bank card says, and before and after that of its box", async () => {
  const page = await openStudio();
  const scale = () => page.evaluate(() => studioPage.map.scale);
  const fitted = await scale();
  await page.click("#options summary");
  await page.click("#full-screen");
  await page.getByLabel("Width of the card").fill("3.2");
  await page.getByText("Show in real size", { exact: true }).click();
  await page.waitForFunction(() => document.fullscreenElement && studioPage.map.scale === 3.2);
  assert.ok(await page.locator("#scope").isHidden());
  // A press meets the finger's canvas, a centimetre from the map's corner, and Stop where it stands.
  const met = await page.evaluate(() => {
    const at = (id, offset) => {
      const { left, top } = document.getElementById(id).getBoundingClientRect();
      return document.elementFromPoint(left + offset, top + offset)?.id;
    };
    return [at("map-finger", 32), at("stop", 8)];
  });
  assert.deepEqual(met, ["map-finger", "stop"]);
  await page.evaluate(() => document.exitFullscreen());
  await page.waitForFunction((fitted) => Math.abs(studioPage.map.scale - fitted) < 0.01, fitted);
});
