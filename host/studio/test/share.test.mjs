// The page in a browser: a scene as a link, and as a zip: what is said of it, and how it comes back.

import assert from "node:assert/strict";
import { test } from "node:test";
import { WHOLE_SCREEN_GRATING, openStudio, resize } from "./page.mjs";

test("Share says that the scene has a mistake, and Save where the file is", async () => {
  const page = await openStudio();
  const said = page.locator("#notice span");
  await page.click("#share");
  await said.filter({ hasText: "holds the whole scene" }).waitFor();
  assert.doesNotMatch(await said.innerText(), /mistake/);
  // Pressed before the page has checked the text.
  await page.evaluate((text) => {
    studioPage.editor.text = text;
    document.getElementById("share").click();
  }, WHOLE_SCREEN_GRATING.replace("grating", "gratin"));
  await said.filter({ hasText: "The scene has 1 mistake: whoever opens the link" }).waitFor();
  assert.equal(await page.getAttribute("#notice", "role"), "alert");
  await Promise.all([page.waitForEvent("download"), page.click("#save")]);
  await said.filter({ hasText: "brick.zip is among your downloads" }).waitFor();
});

test("a link is pasted into Open, also on a phone, and what is none is a sentence", async () => {
  const page = await openStudio();
  const link = await page.evaluate(async (text) => {
    const { linkOf } = await import(await studio.moduleUrl("page/share.js"));
    return linkOf("ridges", text, []);
  }, WHOLE_SCREEN_GRATING);
  await resize(page, [390, 844]);
  const open = async () => {
    await page.evaluate(() => document.getElementById("open-files").click());
    await page.locator("#open h3").first().waitFor();
  };
  await open();
  const field = page.getByLabel("Link of a scene");
  await field.fill("https://example.org/");
  await page.click("text=Open the link");
  assert.match(await page.innerText("#open [role=alert]"), /no link of a scene/);
  await field.fill(` ${link} `);
  await field.press("Enter");
  await page.waitForFunction((text) => studioPage.editor.text === text, WHOLE_SCREEN_GRATING);
  assert.equal(await page.inputValue("#scene-name"), "ridges");
  assert.ok(await page.locator("#open").isHidden());
  await open();
  await page.evaluate((link) => {
    const clipboardData = new DataTransfer();
    clipboardData.setData("text/plain", link);
    const field = document.querySelector("#open input");
    field.dispatchEvent(new ClipboardEvent("paste", { clipboardData, bubbles: true, cancelable: true }));
  }, link);
  await page.locator("#open").waitFor({ state: "hidden" });
});
