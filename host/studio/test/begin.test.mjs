// The page in a browser: what a scene of one's own begins with.

import assert from "node:assert/strict";
import { test } from "node:test";
import { openStudio, plays } from "./page.mjs";

/** What the engine says of the scene that stands in the editor. */
const problems = (page, text) =>
  page.evaluate(async (text) => {
    const files = { "new.toml": text };
    for (const name of studio.names("scenes/textures/")) files[name.slice("scenes/".length)] = await studio.bytes(name);
    const check = await studioPage.engine.compile(files, "new.toml", {});
    return { isDraft: check.isDraft, layers: check.layers?.length, said: check.problems.map(({ message }) => message) };
  }, text);

test("a browser whose store answers late plays the first scene, and the next one", async () => {
  const page = await openStudio(undefined, {
    init: () => {
      const request = LockManager.prototype.request;
      LockManager.prototype.request = async function (...args) {
        // Real time, which the check of the scene takes, too.
        await new Promise((resolve) => setTimeout(resolve, 3000));
        return request.apply(this, args);
      };
    },
  });
  await page.click("#new");
  await page.locator("#new-scene article", { hasText: "stripes" }).locator("button.primary").click();
  await page.waitForFunction(() => document.getElementById("scene-name").value === "stripes");
  await plays(page);
});

test("New offers scenes with pictures, which play, and whose layer is selected", async () => {
  const page = await openStudio();
  await page.click("#new");
  await page.waitForFunction(() => [...document.querySelectorAll("#new-scene canvas")].every(({ width }) => width === 240));
  const names = await page.locator("#new-scene h3").allTextContents();
  for (const name of ["stripes", "button", "picture", "noise", "notification"]) assert.ok(names.includes(name), `${names}`);
  await page.click("text=Begin with picture");
  await page.waitForFunction(() => document.getElementById("scene-name").value === "picture");
  await plays(page);
  assert.ok(await page.isHidden("#new-scene"));
  await page.locator(".layer-box[aria-current=true]:focus").waitFor();
});

test("completion offers what the kind of a layer has, and inserts what one of its kind needs, which plays", async () => {
  const page = await openStudio();
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
  const completed = async (kind, more = "") => {
    const before = `version = 1\n[[layer]]\n${more}`;
    await page.evaluate((text) => (studioPage.editor.text = text), before);
    await page.evaluate(() => studioPage.editor.goTo(undefined, 99));
    await page.locator(".cm-content").press("Control+End");
    // The editor closes the quotation mark by itself.
    await page.keyboard.type('kind = "');
    await page.keyboard.type(kind.slice(0, 3));
    const option = page.locator(".cm-tooltip-autocomplete li", { hasText: `"${kind}"` });
    await option.waitFor();
    // What the check says moves the text, and the options with it.
    await page.waitForFunction(() => studioPage.player.status === "mistaken");
    await page.evaluate(() => wait(200));
    await option.click();
    return page.evaluate(() => studioPage.editor.text);
  };
  const kinds = await page.evaluate(async () => {
    const schema = JSON.parse(await studio.text("docs/design/scene.schema.json"));
    return schema.definitions.shared_layer.properties.kind.enum;
  });
  assert.equal(kinds.length, 12);
  for (const kind of kinds) {
    const text = await completed(kind);
    const found = await problems(page, text);
    assert.deepEqual([found.layers, found.isDraft], [1, false], `${text}\n${found.said.join("\n")}`);
  }
  assert.match(await completed("edge"), /\nridge_fraction = 0\.8\b/);
  const kept = await completed("grating", "wavelength_mm = 3\nlow_n = 0.0\n");
  assert.match(kept, /^version = 1\n\[\[layer\]\]\nwavelength_mm = 3\nlow_n = 0\.0\nkind = "grating"\nhigh_fraction = 0\.8$/);
});

