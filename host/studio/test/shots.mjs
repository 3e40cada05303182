// Takes the pictures of docs/design/studio, all that are there: `cargo xtask studio-shots`. Some of them: `cargo xtask
// studio`, then `STUDIO_PAGE=PATH node shots.mjs NAME ...` in this folder. Each picture is looked at before it is kept.

import fs from "node:fs";
import path from "node:path";
import { endFile, endTest, openPage } from "./harness.mjs";
import { openBundled } from "./layout.mjs";
import { give, openStudio } from "./page.mjs";

const OUT = new URL("../../../docs/design/studio/", import.meta.url).pathname;
const wanted = process.argv.slice(2);

/** Opens the studio, with a scene of the gallery; `size` is that of the window. At a first visit tools are closed. */
async function open({ size = { width: 1440, height: 900 }, scheme = "light", isFirstVisit = false, scene }) {
  const page = await openStudio(undefined, { isFirstVisit });
  await page.setViewportSize(size);
  await page.emulateMedia({ colorScheme: scheme });
  await page.waitForTimeout(300);
  if (scene) {
    await openBundled(page, scene);
    await page.waitForTimeout(2000);
  }
  return page;
}

/** Slides twice to the right, and leaves the finger down. */
async function slide(page, yMm = 44) {
  await page.evaluate(async (yMm) => {
    await stroke(15, 105, yMm - 12, 90);
    await slide(20, 88, yMm, 90);
    // The way is simulated a little later than it was made.
    await wait(30);
    document.getElementById("map-hint").hidden = true;
  }, yMm);
}

async function change(page, before, after) {
  await page.evaluate(([before, after]) => {
    const { editor } = studioPage;
    editor.text = editor.text.replace(before, after);
  }, [before, after]);
  await page.waitForTimeout(2000);
}

/** How the studio is opened for each picture, and what leads to what it shows. */
const SHOTS = {
  play: [{ isFirstVisit: true }, (page) => slide(page)],
  sound: [{ scheme: "dark" }, async (page) => {
    await page.click("#tab-sound");
    await page.click("text=Sound on");
    await page.locator("#panel-sound >> text=Sound off").waitFor();
    await slide(page);
  }],
  size: [{}, async (page) => {
    await page.click("summary:has-text('Options')");
    await page.click("#real-size");
    await page.waitForTimeout(300);
  }],
  draft: [{ scene: "grating" }, async (page) => {
    await change(page, "high_n = 0.1", "high_n = 0.2");
    await slide(page);
  }],
  files: [{}, async (page) => {
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
  }],
  mistake: [{ scene: "grating" }, async (page) => {
    await change(page, 'kind = "grating"', 'kind = "gratin"');
    await page.click("#problems button");
    await page.waitForTimeout(400);
  }],
  gallery: [{ scheme: "dark" }, async (page) => {
    await page.click("#open-gallery");
    await page.waitForTimeout(6000);
  }],
  tablet: [{ size: { width: 820, height: 1180 }, isFirstVisit: true }, (page) => slide(page)],
  mockup: [{ scene: "slider" }, async (page) => {
    await page.click("#options summary");
    await page.selectOption("#look", "both");
    await page.keyboard.press("Escape");
    await page.waitForTimeout(500);
    await slide(page);
  }],
  compare: [{}, async (page) => {
    await page.click("#tab-compare");
    await page.click("text=Keep this scene as A");
    await openBundled(page, "grating");
    await page.waitForTimeout(2000);
    await page.click("text=Compare A with the scene now");
    await page.waitForTimeout(800);
    await slide(page);
  }],
  "board-arm": onBoard({ state: "disarmed", needsArm: true }),
  "board-armed": onBoard({ state: "active", needsArm: false }),
  "board-faulted": onBoard({ state: "faulted", needsArm: false, fault: "the arm switch was released" }),
  element: [{ url: new URL("../../../docs/design/gallery/index.html", import.meta.url).href }, async (page) => {
    await page.setViewportSize({ width: 1000, height: 900 });
    const canvas = page.locator("frixel-scene[scene=brick] #map-finger");
    await canvas.waitFor();
    await page.waitForTimeout(4000);
    const box = await canvas.boundingBox();
    await page.mouse.move(box.x + 0.2 * box.width, box.y + 0.4 * box.height);
    await page.waitForTimeout(800);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.8 * box.width, box.y + 0.6 * box.height, { steps: 140 });
  }],
};

/** The header of a studio whose board says that it is so. */
function onBoard(said) {
  const show = async (page) => {
    await page.evaluate((said) => {
      const driving = "NUCLEO-G474RE with an electrode, up to 43.8 V peak";
      const { engine } = studioPage;
      const show = engine.onState;
      // What the simulator reports meanwhile is not shown.
      engine.onState = () => {};
      show({ link: "serial", driving, fault: undefined, ...said });
    }, said);
    // Arm can be pressed some time after it has appeared.
    await page.waitForFunction(() => document.querySelector("#arm[hidden], #arm:enabled"));
    await page.waitForTimeout(300);
  };
  return [{ clip: { x: 0, y: 0, width: 1440, height: 360 } }, show];
}

if (wanted.length === 0) for (const name of fs.readdirSync(OUT)) fs.rmSync(path.join(OUT, name));
for (const [name, [{ url, clip, ...how }, lead]] of Object.entries(SHOTS)) {
  if (wanted.length > 0 && !wanted.includes(name)) continue;
  const page = url ? await openPage(url) : await open(how);
  await lead(page);
  await page.screenshot({ path: path.join(OUT, `${name}.png`), clip });
  await endTest();
}
await endFile();
