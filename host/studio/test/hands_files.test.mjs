// The page in a browser: which layers the mode Edit edits as files and checks come, and which one stays selected.

import assert from "node:assert/strict";
import { test } from "node:test";
import { PLATES, drag, onPage, openEditing, press, selected, textOf } from "./editing.mjs";
import { KEYS, PLAY, give, openIncluding, openStudio, plays, settled, writeScene } from "./page.mjs";

test("a layer of another file is moved there, and one whose file is not here says why it is not", async () => {
  const page = await openIncluding();
  await page.click("text=Edit");
  const keys = () => page.evaluate(() => studioPage.editor.textOf("keys.toml"));
  const before = await keys();
  // The third copy of the key: all of them move.
  await drag(page, [82, 40], [82, 50]);
  assert.equal(await keys(), before.replace("y_mm = 20", "y_mm = 30").replace(/y_mm = 30(?=\nwidth)/, "y_mm = 20"));
  assert.match(await selected(page), /^key, constant, 10 by 40 mm at 20, 30, 3 copies$/);
  await plays(page);
  await writeScene(page, 'version = 1\ninclude = ["constant.toml"]\n');
  await page.mouse.click(...(await onPage(page, 100, 40)));
  const note = page.locator(".layer-panel [role=status]");
  assert.match(await note.textContent(), /^This layer comes from constant\.toml: open that file/);
  assert.equal(await page.locator(".layer-panel input:visible").count(), 0);
});

test("a file with Windows line ends that a scene includes is edited on the map", async () => {
  const page = await openStudio();
  const key = KEYS.slice(0, KEYS.indexOf('\n[[layer]]\nname = "wood"'));
  await give(page, ["keys.toml", key.replaceAll("\n", "\r\n")], ["play.toml", PLAY]);
  await page.waitForFunction(() => document.querySelectorAll("#panel-layers .layer").length === 2);
  await page.getByRole("button", { name: "Edit", exact: true }).click();
  await settled(page);
  await drag(page, [22, 40], [22, 30]);
  assert.equal(await page.evaluate(() => studioPage.editor.textOf("keys.toml")), key.replace("y_mm = 20", "y_mm = 10"));
  await plays(page);
});

test("what is selected stays selected where layers come and go before it, and in no other scene", async () => {
  const page = await openEditing(PLATES, [20, 30]);
  await press(page, "Delete");
  await page.locator(".layer-box").nth(1).waitFor({ state: "detached" });
  await plays(page);
  await page.mouse.click(...(await onPage(page, 100, 50)));
  assert.match(await selected(page), /^right,/);
  await press(page, "Control+z");
  await page.locator(".layer-box").nth(1).waitFor();
  await plays(page);
  assert.match(await selected(page), /^right,/);
  await press(page, "Delete");
  assert.equal(await textOf(page), PLATES.slice(0, PLATES.indexOf("\n# The upper")));
  await press(page, "Control+z");
  await page.locator(".layer-box").nth(1).waitFor();
  await plays(page);
  await page.mouse.click(...(await onPage(page, 20, 30)));
  assert.match(await selected(page), /^left,/);
  await give(page, ["other.toml", PLATES.replace("# Two", "# Two other")]);
  await page.waitForFunction(() => studioPage.editor.text.startsWith("# Two other"));
  await plays(page);
  assert.equal(await page.locator(".layer-box[aria-current=true]").count(), 0);
});

test("a scene with a byte order mark is edited on the map like any other", async () => {
  const page = await openEditing();
  await writeScene(page, `\uFEFF${PLATES}`);
  await plays(page);
  assert.ok(await page.locator("#notice").isHidden());
  await drag(page, [20, 30], [25, 30]);
  assert.equal((await textOf(page)).replace("\uFEFF", ""), PLATES.replace("x_mm = 10.0", "x_mm = 15.0"));
});
