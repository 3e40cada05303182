// The page in a browser: layers come into a scene and out of it on the map, and what the panel of a layer says.

import assert from "node:assert/strict";
import fs from "node:fs";
import { test } from "node:test";
import { PLATES, drag, dragHandle, hold, onPage, openEditing, press, selected, textOf } from "./editing.mjs";
import { WHOLE_SCREEN_GRATING, assertSays, give, openStudio, plays, writeScene } from "./page.mjs";

const EMPTY = "version = 1\n";
const JPEG = new URL("../../../scenes/textures/wood.jpg", import.meta.url).pathname;
const panel = (page) => page.locator(".layer-panel");
const note = (page) => panel(page).locator("[role=status]").textContent();
/** Where the layers are, as the map shows them, and whether any two of them overlap. */
const boxes = (page) =>
  page.locator(".layer-box").evaluateAll((all) => all.map((each) => each.getBoundingClientRect().toJSON()));
const overlap = (one, other) =>
  one.left < other.right && other.left < one.right && one.top < other.bottom && other.top < one.bottom;

test("Add puts a layer where there is room, selected, in one step of undo", async () => {
  const page = await openEditing(EMPTY);
  assert.match(await panel(page).textContent(), /^This scene has no layer yet: add one\./);
  const texts = [EMPTY];
  for (const [name, found] of [
    ["stripes", "stripes, grating, 30 by 28 mm"],
    ["button", "button, 30 by 28 mm"],
    ["noise", "noise, 30 by 28 mm"],
    ["slider", "slider, edge, 12 by 16 mm"],
    ["notification", "notification, vibration"],
  ]) {
    await page.getByRole("button", { name: `Add ${name}`, exact: true }).click();
    assert.ok((await selected(page)).startsWith(found), `${await selected(page)}, not ${found}`);
    texts.push(await textOf(page));
    await plays(page);
    await page.locator(".layer-panel .verdict").waitFor();
    assert.equal(await page.locator(".layer-panel .verdict").textContent(), "felt", name);
  }
  // The last one covers the screen.
  const found = (await boxes(page)).slice(0, -1);
  for (const [at, one] of found.entries())
    for (const other of found.slice(at + 1)) assert.ok(!overlap(one, other), JSON.stringify([one, other]));
  for (const [at, text] of texts.slice(1).entries()) assert.ok(text.startsWith(texts[at]), text);
  for (const text of texts.slice(0, -1).reverse()) {
    await press(page, "Control+z");
    assert.equal(await textOf(page), text);
  }
});

test("Duplicate puts a copy beside its layer, also of one in an array, and one undo takes it back", async () => {
  const page = await openEditing();
  await page.mouse.click(...(await onPage(page, 20, 30)));
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
  const region = "{ x_mm = 80, y_mm = 40, width_mm = 40, height_mm = 40 }";
  const one = `{ kind = "constant", friction_fraction = 0.5, region = ${region} }`;
  await writeScene(page, `version = 1\nlayer = [${one}]\n`);
  await page.mouse.click(...(await onPage(page, 100, 60)));
  await page.getByRole("button", { name: "Duplicate" }).click();
  const moved = one.replace("x_mm = 80, y_mm = 40", "x_mm = 75, y_mm = 35");
  assert.equal(await textOf(page), `version = 1\nlayer = [${one}, ${moved}]\n`);
  await plays(page);
  assert.equal(await page.locator(".layer-box").count(), 2);
});

test("a layer that is taken from the gallery while layers are edited is selected", async () => {
  const page = await openEditing();
  await page.click("#open-gallery");
  const card = page.locator("#gallery article", { has: page.locator('h3:text-is("constant")') });
  await card.locator("summary").click();
  const take = card.locator("li button").first();
  const name = (await take.getAttribute("aria-label")).replace("Take over ", "");
  await take.click();
  await page.locator("#gallery >> text=Close").click();
  await page.waitForFunction(() => document.querySelectorAll(".layer-box").length === 3);
  await plays(page);
  assert.ok((await selected(page)).startsWith(name), await selected(page));
});

test("a picture of one's own begins a scene and is added to one, by its aspect, in a frame that fits the screen", async () => {
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
  await assertSays(page, /^bad\.jpg: this picture cannot be read$/);
  await begin("my wood.jpg", wood);
  await page.waitForFunction(() => studioPage.editor.text.includes('picture = "my wood.jpg"'));
  await plays(page);
  assert.equal(await page.inputValue("#scene-name"), "my wood");
  await page.locator(".layer-box[aria-current=true]").waitFor();
  const [, width, height] = /^my wood, bitmap, ([\d.]+) by ([\d.]+) mm at/.exec(await selected(page));
  const aspect = await page.evaluate(async () => {
    const image = await createImageBitmap(new Blob([await studio.bytes("scenes/textures/wood.jpg")]));
    return image.width / image.height;
  });
  assert.ok(Math.abs(width / height / aspect - 1) < 0.01, `${width} by ${height}, ${aspect}`);
  await choose(() => page.click("[aria-label='Add picture']"), "my wood.jpg", wood);
  await page.locator(".layer-box").nth(1).waitFor();
  await plays(page);
  assert.match(await selected(page), /^my wood 2, bitmap/);
  // The same file again is the same file.
  assert.equal((await textOf(page)).match(/picture = "my wood\.jpg"/g).length, 2);
  await press(page, "Control+z");
  await plays(page);
  assert.equal(await page.locator(".layer-box").count(), 1);
  await give(page, ["wide.toml", "width_mm = 300.0\nheight_mm = 60.0\n"]);
  await page.waitForFunction(() => studioPage.map.screen.widthMm === 300);
  await begin("wood.jpg", wood);
  await page.waitForFunction(() => studioPage.editor.text.includes('picture = "wood.jpg"'));
  const [, x, y, long] = /x_mm = ([\d.]+)\ny_mm = ([\d.]+)\nwidth_mm = ([\d.]+)/.exec(await textOf(page)).map(Number);
  assert.ok(Math.abs(x + long / 2 - 150) <= 0.5 && y >= 0 && y < 15, `${x}, ${y}, ${long}`);
  await plays(page);
  await page.locator(".layer-box[aria-current=true]").waitFor();
});

test("the frame of a picture without a region is where the picture is", async () => {
  const page = await openEditing();
  const layer = 'kind = "bitmap"\npicture = "textures/wood.jpg"\nx_mm = 15\ny_mm = 10\nwidth_mm = 90\n';
  const text = `version = 1\n[[layer]]\n${layer}`;
  await writeScene(page, text);
  await page.mouse.click(...(await onPage(page, 60, 40)));
  assert.match(await selected(page), /^bitmap, 90 by [\d.]+ mm at 15, 10$/);
  await drag(page, [60, 40], [50, 35]);
  assert.equal(await textOf(page), text.replace("x_mm = 15\ny_mm = 10", "x_mm = 5\ny_mm = 5"));
  await plays(page);
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

test("Enter goes to the numbers and Escape back to the layer; an arrow says why a layer does not move", async () => {
  const page = await openEditing();
  await page.mouse.click(...(await onPage(page, 20, 30)));
  await press(page, "Enter");
  assert.equal(await page.evaluate(() => document.activeElement.getAttribute("aria-label")), "left of left, mm");
  await press(page, "Escape", "ArrowRight");
  assert.equal(await textOf(page), PLATES.replace("x_mm = 10.0", "x_mm = 11.0"));
  await writeScene(page, WHOLE_SCREEN_GRATING);
  await page.mouse.click(...(await onPage(page, 60, 40)));
  await press(page, "ArrowRight");
  assert.match(await note(page), /covers the whole screen: drag a corner/);
  // What was said is over once it has a place.
  await page.getByLabel("width of grating, mm").fill("60");
  await press(page, "Enter");
  assert.equal(await note(page), "");
  await plays(page);
});

test("with Shift a layer moves along one axis, and a corner keeps the ratio; with Alt it rests anywhere", async () => {
  const page = await openEditing();
  await page.keyboard.down("Shift");
  await drag(page, [20, 30], [32, 33]);
  await page.keyboard.up("Shift");
  assert.equal(await selected(page), "left, constant, 30 by 30 mm at 22, 20");
  await page.keyboard.down("Alt");
  await drag(page, [30, 30], [28.7, 30]);
  await page.keyboard.up("Alt");
  assert.equal(await selected(page), "left, constant, 30 by 30 mm at 20.7, 20");
  await page.keyboard.down("Shift");
  await dragHandle(page, "se", -10, 0);
  await page.keyboard.up("Shift");
  const [, width, height] = /30 by 30|([\d.]+) by ([\d.]+) mm/.exec(await selected(page));
  assert.ok(width === height && width < 21, `${width} by ${height}`);
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
  const page = await openEditing();
  await page.mouse.click(...(await onPage(page, 20, 30)));
  await press(page, "Delete");
  await page.mouse.click(...(await onPage(page, 100, 50)));
  await press(page, "Delete");
  assert.doesNotMatch(await textOf(page), /\[\[layer\]\]/);
  assert.match(await panel(page).textContent(), /^This scene has no layer yet/);
  await press(page, "Control+z", "Control+z");
  assert.equal(await textOf(page), PLATES);
  await plays(page);
});

test("Delete says which layer it takes out and offers the way back, on which the layer is selected again", async () => {
  const page = await openEditing();
  await page.mouse.click(...(await onPage(page, 100, 50)));
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
  const page = await openEditing();
  await page.mouse.click(...(await onPage(page, 100, 50)));
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
  const page = await openEditing();
  await page.mouse.click(...(await onPage(page, 100, 50)));
  await press(page, "Delete");
  await plays(page);
  await page.getByRole("button", { name: "Feel", exact: true }).click();
  await press(page, "Control+z");
  await plays(page);
  assert.equal(await textOf(page), PLATES);
  await press(page, "Control+d");
  assert.equal(await textOf(page), PLATES, "nothing is selected that could be doubled");
});
