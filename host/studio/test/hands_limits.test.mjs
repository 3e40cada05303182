// The page in a browser: how far a hand on the map goes, and what it leaves where it is stopped.

import assert from "node:assert/strict";
import { test } from "node:test";
import { PLATES, dragHandle, holdSlider, onPage, openEditing, press, selected, takeLayer, textOf } from "./editing.mjs";
import { assertSays, give, openStudio, plays, resize, writeScene } from "./page.mjs";
import { pageModule } from "./page_module.mjs";

const KEY = `version = 1
[[layer]]
name = "key"
kind = "constant"
friction_fraction = 0.8
region = { x_mm = 10, y_mm = 10, width_mm = 20, height_mm = 10 }
repeat = { columns = 2, rows = 3, dx_mm = 30, dy_mm = 20 }
`;
/** A text of so many bytes, of letters that have two. */
const long = (bytes) => `version = 1\n# ${"é".repeat((bytes - 14) / 2)}`;

test("with Shift a corner keeps the ratio with all copies on the screen, and follows either axis", async () => {
  const page = await openEditing(KEY, [15, 15]);
  const boxAfter = async (...by) => {
    await page.keyboard.down("Shift");
    await dragHandle(page, "se", ...by);
    await page.keyboard.up("Shift");
    const [, width, height] = /^key, constant, ([\d.]+) by ([\d.]+) mm/.exec(await selected(page));
    await press(page, "Control+z");
    await plays(page);
    return [Number(width), Number(height)];
  };
  // Three rows, 20 mm apart, have room for 30 mm each; two columns for 80 mm.
  assert.deepEqual(await boxAfter(80, 0), [60, 30]);
  assert.deepEqual(await boxAfter(0, 5), [30, 15]);
  assert.deepEqual(await boxAfter(-30, 0), [2, 1]);
});

test("Escape takes a slider's drag back, and the slider follows no more", async () => {
  const page = await openEditing(PLATES, [20, 30]);
  const slider = page.getByLabel("friction of left, of reach", { exact: true });
  const dragTo = await holdSlider(page, slider, 0.5, 0.8);
  assert.notEqual(await textOf(page), PLATES);
  await press(page, "Escape");
  await dragTo(0.2);
  await page.mouse.up();
  assert.equal(await textOf(page), PLATES);
  assert.equal(await slider.inputValue(), "0.5");
  await plays(page);
});

test("a layer for which the text has no room is not there, and no later one is taken for it", async () => {
  const page = await openEditing();
  const text = `${PLATES}# ${"-".repeat(500_000 - PLATES.length - 40)}\n`;
  await writeScene(page, text);
  await page.mouse.click(...(await onPage(page, 20, 30)));
  await press(page, "Control+d");
  await assertSays(page, /the text has 0\.6 MB, more than the 0\.5 MB/);
  assert.equal(await textOf(page), text);
  assert.equal(await page.locator(".layer-box").count(), 2);
  assert.match(await page.locator(".layer-panel [role=status]").textContent(), /no room/);
  // A slider goes on from what fits.
  const number = page.getByLabel("friction of left, of reach, as a number");
  await number.fill("0.25");
  await press(page, "Enter");
  assert.equal(await textOf(page), text.replace("friction_fraction = 0.5", "friction_fraction = 0.25"));
  await takeLayer(page);
  await plays(page);
  assert.match(await selected(page), /^left,/);
  await writeScene(page, PLATES.replace("0.9", "0.8"));
  assert.match(await selected(page), /^left,/, "what was refused is not awaited");
});

test("a text that is too long is not taken from the clipboard, a link or a zip, and what was open stays", async () => {
  const page = await openStudio();
  const before = await textOf(page);
  await page.locator(".cm-content").focus();
  const [link, zip] = await page.evaluate(async (text) => {
    const data = new DataTransfer();
    data.setData("text/plain", "# a line of a comment\n".repeat(100_000));
    const paste = new ClipboardEvent("paste", { clipboardData: data, bubbles: true, cancelable: true });
    document.querySelector(".cm-content").dispatchEvent(paste);
    const module = async (name) => import(await studio.moduleUrl(`page/${name}.js`));
    const [{ linkOf }, { zipOf }] = [await module("share"), await module("archive")];
    const files = [["parts.toml", text]];
    const scene = { name: "long", entry: "long.toml", text: "version = 1\n", files, profiles: {} };
    return [linkOf("long", text, []), [...zipOf(scene)]];
  }, long(500_002));
  await assertSays(page, /^the text has 2\.3 MB, more than the 0\.5 MB/);
  await page.evaluate((link) => (location.hash = new URL(link).hash), link);
  await assertSays(page, /^long\.toml: the text has 0\.6 MB, more than the 0\.5 MB/);
  await give(page, ["long.zip", Buffer.from(zip)]);
  await assertSays(page, /^parts\.toml: the text has 0\.6 MB/);
  assert.equal(await textOf(page), before);
  assert.equal(await page.inputValue("#scene-name"), "brick");
  await plays(page);
});

test("a text fits by its bytes, not its characters, and a picture is no text", async () => {
  const { assertTextsFit } = await pageModule("project.js");
  assert.doesNotThrow(() => assertTextsFit({ name: "a", text: long(500_000), files: [["b.png", new Uint8Array(1e6)]] }));
  assert.throws(() => assertTextsFit({ name: "a", text: "", files: [["b.toml", long(500_002)]] }), /^Error: b\.toml: /);
});

test("Ctrl+D that is held makes one copy, and no key acts on layers behind a dialog", async () => {
  const page = await openEditing(PLATES, [20, 30]);
  await page.keyboard.down("Control");
  for (let times = 0; times < 3; times += 1) await page.keyboard.down("d");
  await page.keyboard.up("d");
  await page.keyboard.up("Control");
  const one = await textOf(page);
  assert.equal(one.match(/\[\[layer\]\]/g).length, 3);
  await press(page, "Control+Shift+d");
  await page.evaluate(() => document.getElementById("about").showModal());
  await page.evaluate(() => document.activeElement.blur());
  await press(page, "Control+z", "Control+d");
  assert.equal(await textOf(page), one);
});

test("in a scene without a layer the keys lead from the map to Add", async () => {
  const page = await openEditing("version = 1\n");
  await page.evaluate(() => document.getElementById("options").querySelector("summary").focus());
  await press(page, "Tab", "Space");
  assert.equal(await page.evaluate(() => document.activeElement.getAttribute("aria-label")), "Add stripes");
  await press(page, "Enter");
  assert.match(await selected(page), /^stripes, grating/);
});

test("the verdict keeps the focus, and copies their row, while nothing of them changes", async () => {
  const page = await openEditing(KEY.replace("x_mm = 10", "x_mm = 95").replace("columns = 2", "columns = 1"), [100, 15]);
  assert.equal(await page.getByLabel("columns of key", { exact: true }).count(), 1);
  const button = page.locator(".layer-felt button");
  await button.focus();
  await resize(page, [1300, 850]);
  assert.ok(await button.evaluate((each) => each === document.activeElement));
});

test("a check of other layers says nothing of what is felt", async () => {
  const { EditedLayers } = await pageModule("edited_layers.js");
  const layers = new EditedLayers({ textOf: () => undefined });
  const layer = (name, index, felt = "") => ({ name, index, felt, kind: "constant", perceived: null });
  layers.all = [layer("a", 1, "before"), layer("a 2", 0), layer("b", 2, "before")].map((each) => ({ layer: each }));
  const felt = () => layers.all.map((each) => each.layer.felt);
  layers.feel([layer("a", 1, "now"), layer("b", 2, "now")]);
  assert.deepEqual(felt(), ["before", "", "before"]);
  layers.feel([layer("a", 1, "1"), layer("a 2", 2, "2"), layer("b", 3, "3")]);
  assert.deepEqual(felt(), ["1", "2", "3"]);
});

