// The page in a browser: layers come into a scene and out of it on the map, and what the panel of a layer says.

import assert from "node:assert/strict";
import fs from "node:fs";
import { test } from "node:test";
import { PLATES, drag, hold, onPage, openEditing, press, selected, takeLayer, textOf } from "./editing.mjs";
import { WHOLE_SCREEN_GRATING, assertSays, openStudio, plays } from "./page.mjs";

const EMPTY = "version = 1\n";
const JPEG = new URL("../../../scenes/textures/wood.jpg", import.meta.url).pathname;
const panel = (page) => page.locator(".layer-panel");
const note = (page) => panel(page).locator("[role=status]").textContent();
test("Add puts a layer where there is room, selected, in one step of undo", async () => {
  const page = await openEditing(EMPTY);
  assert.match(await panel(page).innerText(), /^This scene has no layer yet: add one\./);
  const texts = [EMPTY];
  const places = new Set();
  for (const name of ["stripes", "button"]) {
    await page.getByRole("button", { name: `Add ${name}`, exact: true }).click();
    const [, place] = new RegExp(`^${name}, .*30 by 28 mm (at .*)$`).exec(await selected(page));
    places.add(place);
    texts.push(await textOf(page));
    await plays(page);
  }
  assert.equal(places.size, 2);
  for (const text of texts.slice(0, -1).reverse()) {
    await press(page, "Control+z");
    assert.equal(await textOf(page), text);
  }
});

test("Duplicate puts a copy beside its layer, and one undo takes it back", async () => {
  const page = await openEditing(PLATES, [20, 30]);
  await press(page, "Control+d");
  const copy = `[[layer]]
name = "left 2"     # its name
kind = "constant"
region = {x_mm = 15.0, y_mm = 25, width_mm = 30, height_mm = 30} # a box
friction_fraction = 0.5`;
  const at = PLATES.indexOf("\n\n# The upper");
  assert.equal(await textOf(page), `${PLATES.slice(0, at)}\n\n${copy}${PLATES.slice(at)}`);
  assert.equal(await selected(page), "left 2, constant, 30 by 30 mm at 15, 25");
  await plays(page);
  assert.equal(await selected(page), "left 2, constant, 30 by 30 mm at 15, 25");
  await press(page, "Control+z");
  assert.equal(await textOf(page), PLATES);
});

test("a layer that is taken from the gallery while layers are edited is selected", async () => {
  const page = await openEditing();
  const name = await takeLayer(page);
  await page.waitForFunction(() => document.querySelectorAll(".layer-box").length === 3);
  await plays(page);
  assert.ok((await selected(page)).startsWith(name), await selected(page));
});

test("a picture of one's own begins a scene and is added to one, by its aspect", async () => {
  const page = await openStudio();
  const choose = async (action, name, buffer) => {
    const [chooser] = await Promise.all([page.waitForEvent("filechooser"), action()]);
    await chooser.setFiles([{ name, mimeType: "image/jpeg", buffer }]);
  };
  const begin = async (name, buffer) => {
    await page.click("#new");
    await choose(() => page.click("text=Choose a picture…"), name, buffer);
  };
  const wood = fs.readFileSync(JPEG);
  await begin("notes.txt", Buffer.from("x"));
  await assertSays(page, /^notes\.txt: expected /);
  await begin("bad.jpg", Buffer.from([0xff, 0xd8, 0xff, 0xe0, 0, 1, 2, 3]));
  await assertSays(page, /^bad\.jpg: it is damaged /);
  await begin("my wood.jpg", wood);
  await page.waitForFunction(() => studioPage.editor.text.includes('picture = "my wood.jpg"'));
  await plays(page);
  assert.equal(await page.inputValue("#scene-name"), "my wood");
  await page.locator(".layer-box[aria-current=true]").waitFor();
  const [, width, height] = /^my wood, bitmap, ([\d.]+) by ([\d.]+) mm at/.exec(await selected(page));
  const pixels = await page.evaluate(async () => {
    const image = await createImageBitmap(new Blob([await studio.bytes("scenes/textures/wood.jpg")]));
    return image.width / image.height;
  });
  assert.ok(Math.abs(width / height / pixels - 1) < 0.01, `${width} by ${height}, ${pixels}`);
  await choose(() => page.click("[aria-label='Add picture']"), "my wood.jpg", wood);
  await page.locator(".layer-box").nth(1).waitFor();
  await plays(page);
  assert.match(await selected(page), /^my wood 2, bitmap/);
  // The same file again is the same file.
  assert.equal((await textOf(page)).match(/picture = "my wood\.jpg"/g).length, 2);
  await press(page, "Control+z");
  await plays(page);
  assert.equal(await page.locator(".layer-box").count(), 1);
});

test("Ctrl+Z undoes wherever the focus is, but in a field and a dialog", async () => {
  const page = await openEditing();
  await drag(page, [20, 30], [25, 30]);
  const moved = await textOf(page);
  await page.evaluate(() => document.activeElement.blur());
  assert.equal(await page.evaluate(() => document.activeElement.tagName), "BODY");
  await press(page, "Control+z");
  assert.equal(await textOf(page), PLATES);
  await page.getByRole("button", { name: "Feel", exact: true }).click();
  await press(page, "Control+Shift+z");
  assert.equal(await textOf(page), moved);
  await page.locator("#scene-name").focus();
  await press(page, "Control+z");
  await page.click("#open-about");
  await page.locator("#about").waitFor();
  await press(page, "Control+z");
  assert.equal(await textOf(page), moved);
});

test("an arrow says why a layer does not move, until it does", async () => {
  const page = await openEditing(WHOLE_SCREEN_GRATING, [60, 40]);
  await press(page, "ArrowRight");
  assert.match(await note(page), /covers the whole screen: drag a corner/);
  await page.getByLabel("width of grating, mm").fill("60");
  await press(page, "Enter");
  assert.equal(await note(page), "");
  await plays(page);
});

test("with Shift a layer moves along one axis; with Alt it rests anywhere", async () => {
  const page = await openEditing();
  await page.keyboard.down("Shift");
  await drag(page, [20, 30], [32, 33]);
  await page.keyboard.up("Shift");
  assert.equal(await selected(page), "left, constant, 30 by 30 mm at 22, 20");
  await page.keyboard.down("Alt");
  await drag(page, [30, 30], [28.7, 30]);
  await page.keyboard.up("Alt");
  assert.equal(await selected(page), "left, constant, 30 by 30 mm at 20.7, 20");
});

test("a drag that Escape takes back, or that ends where it began, is no step of undo", async () => {
  const page = await openEditing();
  const isUndone = () => page.isEnabled("#undo");
  await drag(page, [20, 30], [25, 30]);
  await press(page, "Control+z");
  const [text, redo] = [await textOf(page), await page.isEnabled("#redo")];
  assert.ok(redo);
  const before = await isUndone();
  await hold(page, [20, 30], [40, 30]);
  await press(page, "Escape");
  await page.mouse.up();
  assert.deepEqual([await textOf(page), await isUndone(), await page.isEnabled("#redo")], [text, before, true]);
  await hold(page, [20, 30], [40, 30], [20, 30]);
  await page.mouse.up();
  assert.deepEqual([await textOf(page), await isUndone(), await page.isEnabled("#redo")], [text, before, true]);
  await plays(page);
  await press(page, "Control+y");
  assert.match(await textOf(page), /x_mm = 15\.0/);
});

test("layers are taken out one after the other, faster than any check", async () => {
  const page = await openEditing(PLATES, [20, 30]);
  await press(page, "Delete");
  await page.mouse.click(...(await onPage(page, 100, 50)));
  await press(page, "Delete");
  assert.doesNotMatch(await textOf(page), /\[\[layer\]\]/);
  assert.match(await panel(page).innerText(), /^This scene has no layer yet/);
  await press(page, "Control+z", "Control+z");
  assert.equal(await textOf(page), PLATES);
  await plays(page);
});

test("Delete says which layer it takes out and offers the way back, on which the layer is selected again", async () => {
  const page = await openEditing(PLATES, [100, 50]);
  await press(page, "Delete");
  const notice = page.locator("#notice");
  assert.equal(await notice.locator("span").textContent(), "Removed right.");
  await notice.getByRole("button", { name: "Undo", exact: true }).click();
  assert.equal(await textOf(page), PLATES);
  await page.locator(".layer-box[aria-current=true]").waitFor();
  assert.equal(await selected(page), "right, rings, 40 by 40 mm at 70, 20");
  await press(page, "ArrowDown");
  assert.match(await textOf(page), /region\.y_mm = 21 /, "the keys act on it");
  const isBack = page.locator("[aria-current=true][aria-label='right, rings, 40 by 40 mm at 70, 20']");
  await press(page, "Control+z");
  await isBack.waitFor();
  await press(page, "Control+d");
  assert.match(await selected(page), /^right 2, /);
  await press(page, "Control+z");
  await isBack.waitFor();
  // What was taken out before other changes comes back by Undo alone.
  await press(page, "Delete");
  await notice.waitFor();
  await press(page, "Control+z");
  await page.waitForFunction(() => document.getElementById("notice").hidden);
  assert.equal(await textOf(page), PLATES);
});

test("the offer of Delete undoes nothing else, also where the text is the same again", async () => {
  const page = await openEditing(PLATES, [100, 50]);
  await press(page, "Delete");
  await page.locator("#notice").getByRole("button", { name: "Undo", exact: true }).waitFor();
  const without = await textOf(page);
  const now = await page.evaluate(() => {
    const { editor } = studioPage;
    const { text } = editor;
    editor.text = `${text}z`;
    editor.text = text;
    [...document.querySelectorAll("#notice button")].find(({ textContent }) => textContent === "Undo").click();
    return editor.text;
  });
  assert.equal(now, without);
  assert.match(await page.locator("#notice span").textContent(), /has changed since/);
});

test("what an undo brings back is selected in the mode Edit alone", async () => {
  const page = await openEditing(PLATES, [100, 50]);
  await press(page, "Delete");
  await plays(page);
  await page.getByRole("button", { name: "Feel", exact: true }).click();
  await press(page, "Control+z");
  await plays(page);
  assert.equal(await textOf(page), PLATES);
  await press(page, "Control+d");
  assert.equal(await textOf(page), PLATES, "nothing is selected that could be doubled");
});
