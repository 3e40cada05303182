// The page in a browser: files, links and zips.

import assert from "node:assert/strict";
import fs from "node:fs";
import { test } from "node:test";
import { deflateRawSync } from "node:zlib";
import { strToU8, zipSync } from "../vendor/studio-vendor.js";
import { pageUrl } from "./harness.mjs";
import {
  KEYS, PLAY, WHOLE_SCREEN_GRATING, assertSays, give, openIncluding, openStudio, plays, tabsOf, writeScene,
} from "./page.mjs";
import { pageModule } from "./page_module.mjs";

test("bad files and big ones are sentences", async () => {
  const page = await openStudio();
  const png = fs.readFileSync(new URL("../../../scenes/textures/leather.png", import.meta.url));
  await give(page, ["bad.png", Buffer.from("not a picture")]);
  await assertSays(page, /bad\.png: it is neither a PNG nor a JPEG file/);
  await give(page, ["bad.png", png.subarray(0, 900)]);
  await assertSays(page, /bad\.png: it is damaged/);
  for (const [name, mb] of [["big.toml", 20], ["big.png", 33], ["big.zip", 33]]) {
    await give(page, [name, Buffer.alloc(mb * 1e6, 0x41)]);
    await assertSays(page, new RegExp(`${name}: the file has ${mb}\\.0 MB`));
  }
  // As large as what it may unpack to.
  await give(page, ["large.zip", Buffer.alloc(31e6, 0x41)]);
  await assertSays(page, /large\.zip: .*cannot be read/);
  await give(page, ["broken.zip", png]);
  await assertSays(page, /broken\.zip: .*cannot be read/);
  const before = await page.evaluate(() => studioPage.editor.text);
  await give(page, ["empty.toml", Buffer.from(" \n")]);
  await assertSays(page, /empty\.toml: this file is empty/);
  assert.equal(await page.evaluate(() => studioPage.editor.text), before);
  await give(page, ["song.mp3", png]);
  await assertSays(page, /song\.mp3: expected a scene/);
});

test("a small zip that unpacks to more than 32 MB or 100 files is refused, and one whose settings are null opens", async () => {
  const { projectOf } = await pageModule("archive.js");
  const zipOf = (more) => Buffer.from(zipSync({ "scene.toml": strToU8("version = 1\n"), ...more }));
  const zeros = (count, size) => Object.fromEntries(Array.from({ length: count }, (_, at) => [`${at}.png`, new Uint8Array(size)]));
  const bomb = zipOf(zeros(6, 7_000_000));
  assert.ok(bomb.length < 100_000, `${bomb.length} bytes`);
  const limits = /unpacks to 7 files of together 42\.0 MB; .* at most 100 files of together 32 MB/;
  assert.throws(() => projectOf(bomb), limits);
  assert.throws(() => projectOf(zipOf(zeros(150, 1))), /unpacks to 151 files/);
  const shared = zipOf(zeros(2, 1000));
  // The first entry of the list at the end says that its file has more packed bytes than the zip.
  shared.writeUInt32LE(shared.length, shared.indexOf(Buffer.from("PK\x01\x02", "latin1")) + 20);
  assert.throws(() => projectOf(shared), /The files of this zip lie over one another/);
  assert.equal(projectOf(zipOf({ "studio.json": strToU8("null") })).text, "version = 1\n");
});

test("a picture and a part are found by their names in other characters", async () => {
  const page = await openStudio();
  const wood = fs.readFileSync(new URL("../../../scenes/textures/wood.jpg", import.meta.url));
  const layer = '[[layer]]\nkind = "bitmap"\npicture = "caf\u00e9.jpg"\nx_mm = 0\ny_mm = 0\nwidth_mm = 20\n';
  const scene = `version = 1\ninclude = ["gru\u0308n.toml"]\n${layer}`;
  // One form in the scene, the other in the names of the files.
  await give(page, ["scene.toml", scene], ["cafe\u0301.jpg", wood], ["gr\u00fcn.toml", `version = 1\n${layer}`]);
  await page.waitForFunction(() => studioPage.editor.text.includes("caf\u00e9.jpg"));
  await plays(page);
  assert.equal(await page.evaluate(() => studioPage.editor.text), scene);
});

test("a link with rubbish is a sentence, and the first scene plays", async () => {
  const packed = (text) => deflateRawSync(Buffer.from(text)).toString("base64url");
  const bomb = packed(`{"name":"a","text":"${"#".repeat(30_000_000)}"}`).slice(0, 60_000);
  const page = await openStudio(`${pageUrl}#scene=%%%`);
  await assertSays(page, /link does not hold a scene/);
  for (const rubbish of ["abcd", packed("{}"), packed("[1,2"), bomb]) {
    await page.evaluate((hash) => (location.hash = hash), `scene=${rubbish}`);
    await assertSays(page, /link does not hold a scene/);
    assert.ok((await page.evaluate(() => studioPage.editor.text)).includes("brick"));
  }
});

test("a touch source is chosen, or dropped as a file, and stays with the work", async () => {
  const page = await openStudio();
  await writeScene(page, WHOLE_SCREEN_GRATING);
  await page.click("#open-lag");
  await page.selectOption("#touch", "500");
  await plays(page);
  await page.reload();
  await plays(page);
  assert.equal(await page.inputValue("#touch"), "500");
  await give(page, ["panel.toml", "reports_per_s = 0\nlatency_ms = 8\n"]);
  await page.locator("#problems", { hasText: "reports_per_s" }).waitFor();
  assert.equal(await page.inputValue("#touch"), "panel");
  await give(page, ["panel.toml", "reports_per_s = 120\nlatency_ms = 8\n"]);
  await plays(page);
  assert.equal(await page.inputValue("#touch"), "panel");
});

test("a scene of several files goes into a link and a zip, and comes back", async () => {
  const page = await openIncluding();
  await page.locator("#options summary").click();
  await page.selectOption("#finger", "dry");
  const [saved] = await Promise.all([page.waitForEvent("download"), page.click("#save")]);
  const zip = fs.readFileSync(await saved.path());
  // A picture of 36 kB is too big for a link: without it, the rest fits.
  await page.click("#share");
  await assertSays(page, /too big for a link/);
  await page.evaluate(() => studioPage.editor.show("keys.toml"));
  const flat = KEYS.slice(0, KEYS.indexOf("[[layer]]"));
  await give(page, ["keys.toml", flat]);
  await page.waitForFunction(() => document.querySelectorAll("#panel-layers .layer").length === 2);
  await page.click("#share");
  await page.waitForFunction(() => location.hash.startsWith("#scene="));
  await assertSays(page, /pastes the link into the page/);
  const link = page.url();
  const shared = await openStudio();
  await shared.evaluate((link) => {
    const clipboardData = new DataTransfer();
    clipboardData.setData("text/plain", link);
    const target = document.querySelector(".cm-content");
    target.dispatchEvent(new ClipboardEvent("paste", { clipboardData, bubbles: true, cancelable: true }));
  }, link);
  await shared.waitForFunction(() => document.querySelectorAll("#panel-layers .layer").length === 2);
  assert.deepEqual(await tabsOf(shared), ["play.toml", "keys.toml"]);
  assert.equal(await shared.evaluate(() => studioPage.editor.text), PLAY);
  await give(shared, ["mine.zip", zip]);
  await shared.waitForFunction(() => document.querySelectorAll("#panel-layers .layer").length === 3);
  assert.equal(await shared.inputValue("#finger"), "dry");
});
