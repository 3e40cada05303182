// Takes the pictures of docs/design/studio, all that are there: `cargo xtask studio-shots`. Some of them: `cargo xtask
// studio`, then `STUDIO_PAGE=PATH node shots.mjs NAME ...` in this folder. Each picture is looked at before it is kept.

import fs from "node:fs";
import path from "node:path";
import { endFile, endTest, openPage } from "./harness.mjs";
import { give, openStudio } from "./page.mjs";

const OUT = new URL("../../../docs/design/studio/", import.meta.url).pathname;
const wanted = process.argv.slice(2);

/** Opens the studio; `size` is that of the window. With `isFirstVisit`, text and tools are closed. */
async function open({ size = { width: 1440, height: 900 }, scheme = "light", isFirstVisit = false } = {}) {
  const page = await openStudio(undefined, { isFirstVisit });
  await page.setViewportSize(size);
  await page.emulateMedia({ colorScheme: scheme });
  await page.waitForTimeout(300);
  return page;
}

/** Slides twice to the right, and leaves the finger down. */
async function slide(page, yMm = 44) {
  await page.evaluate(async (yMm) => {
    await slide(15, 105, yMm - 12, 90);
    await wait(120);
    lift(105, yMm - 12);
    await wait(150);
    await slide(20, 88, yMm, 90);
    // The way is simulated a little later than it was made.
    await wait(30);
    document.getElementById("map-hint").hidden = true;
  }, yMm);
}

/** Opens a bundled scene from the gallery. */
async function bundled(page, name) {
  await page.click("#open-gallery");
  await page.click(`text="Open ${name}"`);
  await page.waitForFunction((name) => document.getElementById("scene-name").value === name, name);
  await page.waitForTimeout(2000);
}

async function change(page, before, after) {
  await page.evaluate(([before, after]) => {
    const { editor } = studioPage;
    editor.text = editor.text.replace(before, after);
  }, [before, after]);
  await page.waitForTimeout(2000);
}

const shot = (page, name) => page.screenshot({ path: path.join(OUT, `${name}.png`) });

const SHOTS = {
  async play() {
    const page = await open({ isFirstVisit: true });
    await slide(page);
    await shot(page, "play");
  },
  async sound() {
    const page = await open({ scheme: "dark" });
    await page.click("#tab-sound");
    await page.click("text=Sound on");
    await page.locator("#panel-sound >> text=Sound off").waitFor();
    await slide(page);
    await shot(page, "sound");
  },
  async size() {
    const page = await open();
    await page.click("summary:has-text('Options')");
    await page.click("#real-size");
    await page.waitForTimeout(300);
    await shot(page, "size");
  },
  async draft() {
    const page = await open();
    await bundled(page, "grating");
    await change(page, "high_n = 0.1", "high_n = 0.2");
    await slide(page);
    await shot(page, "draft");
  },
  async files() {
    const page = await open();
    const keys = `version = 1

# Twelve keys.
[[layer]]
name = "key"
kind = "button"
rim_fraction = 0.9
rim_width_mm = 2
face_fraction = 0.4
region = { x_mm = 12, y_mm = 12, width_mm = 20, height_mm = 14 }
repeat = { columns = 4, dx_mm = 25, rows = 3, dy_mm = 20 }
live = true
`;
    await give(page, ["keys.toml", keys], ["phone.toml", 'version = 1\ninclude = ["keys.toml"]\n']);
    await page.click("#file-tabs >> text=keys.toml");
    await page.waitForTimeout(2500);
    await page.evaluate(() => studioPage.editor.goTo("keys.toml", 9));
    await page.keyboard.press("Home");
    await page.keyboard.press("Delete");
    await page.waitForTimeout(2500);
    await page.click("#problems button");
    await page.waitForTimeout(500);
    await shot(page, "files");
  },
  async mistake() {
    const page = await open();
    await bundled(page, "grating");
    await change(page, 'kind = "grating"', 'kind = "gratin"');
    await page.click("#problems button");
    await page.waitForTimeout(400);
    await shot(page, "mistake");
  },
  async gallery() {
    const page = await open({ scheme: "dark" });
    await page.click("#open-gallery");
    await page.waitForTimeout(6000);
    await shot(page, "gallery");
  },
  async tablet() {
    const page = await open({ size: { width: 820, height: 1180 }, isFirstVisit: true });
    await slide(page);
    await shot(page, "tablet");
  },
  async mockup() {
    const page = await open();
    await bundled(page, "slider");
    await page.click("#options summary");
    await page.selectOption("#look", "both");
    await page.keyboard.press("Escape");
    await page.waitForTimeout(500);
    await slide(page);
    await shot(page, "mockup");
  },
  async compare() {
    const page = await open();
    await page.click("#tab-compare");
    await page.click("text=Keep this scene as A");
    await bundled(page, "grating");
    await page.click("text=Compare A with the scene now");
    await page.waitForTimeout(800);
    await slide(page);
    await shot(page, "compare");
  },
  async board() {
    for (const [name, state] of Object.entries({
      "board-arm": { link: "serial", state: "disarmed", needsArm: true },
      "board-armed": { link: "serial", state: "active", needsArm: false },
      "board-faulted": { link: "serial", state: "faulted", needsArm: false, fault: "the arm switch was released" },
    })) {
      const page = await open();
      await page.evaluate((state) => {
        const driving = "board nucleo-g474re with an electrode, up to 50 V peak";
        const { engine } = studioPage;
        const show = engine.onState;
        // What the simulator reports meanwhile is not shown.
        engine.onState = () => {};
        show({ driving, fault: undefined, ...state });
      }, state);
      await page.waitForTimeout(300);
      await page.screenshot({ path: path.join(OUT, `${name}.png`), clip: { x: 0, y: 0, width: 1440, height: 360 } });
    }
  },
  async element() {
    const page = await openPage(new URL("../../../docs/design/gallery/index.html", import.meta.url).href);
    await page.setViewportSize({ width: 1000, height: 900 });
    const canvas = page.locator("frixel-scene[scene=brick] #map-finger");
    await canvas.waitFor();
    await page.waitForTimeout(4000);
    const box = await canvas.boundingBox();
    await page.mouse.move(box.x + 0.2 * box.width, box.y + 0.4 * box.height);
    await page.waitForTimeout(800);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.8 * box.width, box.y + 0.6 * box.height, { steps: 140 });
    await page.screenshot({ path: path.join(OUT, "element.png") });
  },
};

if (wanted.length === 0) for (const name of fs.readdirSync(OUT)) fs.rmSync(path.join(OUT, name));
for (const [name, take] of Object.entries(SHOTS)) {
  if (wanted.length > 0 && !wanted.includes(name)) continue;
  await take();
  await endTest();
}
await endFile();
