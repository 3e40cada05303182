// The page in a browser, on a phone: nothing lies over the board for good, moves by itself, or is cut.

import assert from "node:assert/strict";
import { test } from "node:test";
import { openStudio, resize, settled } from "./page.mjs";

async function openPhone(options) {
  const page = await openStudio(undefined, options);
  await resize(page, [390, 844]);
  if (!options) await page.click("#toggle-drawer");
  await page.evaluate(() => document.querySelector("main").scrollTo(0, 0));
  await page.waitForFunction(() => innerWidth === 390);
  return page;
}

test("Lag leaves the board where it is, and its numbers move nothing when they come", async () => {
  const page = await openPhone();
  const placesOf = () =>
    page.evaluate(() => ["#options", "#map-finger", "#scope"].map((each) => document.querySelector(each).getBoundingClientRect().top));
  const [options, map] = await placesOf();
  await page.click("#open-lag");
  const open = await placesOf();
  assert.deepEqual(open.slice(0, 2), [options, map]);
  const rows = await page.locator(".lag-by").evaluateAll((all) => all.map((each) => each.offsetTop));
  await page.evaluate(() => stroke(15, 105, 40, 150));
  assert.match(await page.innerText("#lag-reported"), /mm$/);
  // The longest words.
  await page.evaluate(() => (document.getElementById("lag-missed").textContent = ", at 5 of 18 lines: it missed 13"));
  assert.deepEqual(await placesOf(), open);
  assert.deepEqual(await page.locator(".lag-by").evaluateAll((all) => all.map((each) => each.offsetTop)), rows);
});

test("the offer of sound leaves the board at a press on its cross", async () => {
  const page = await openPhone({ isFirstVisit: true });
  await page.evaluate(() => document.getElementById("map-finger").click());
  assert.ok(await page.isVisible("#hear"));
  await page.click("#first-dismiss");
  assert.ok(await page.isHidden("#hear"));
});

test("on its side a phone shows all of the screen, also with the lag and in the mode Edit", async () => {
  const page = await openPhone();
  await resize(page, [844, 390]);
  const isWhole = async (how) => {
    await settled(page);
    const { top, bottom, header } = await page.evaluate(() => {
      const { top, bottom } = document.getElementById("map-finger").getBoundingClientRect();
      return { top, bottom, header: document.querySelector("header").getBoundingClientRect().bottom };
    });
    assert.ok(top >= header && bottom <= 390, `${how}: ${top} to ${bottom}`);
    assert.ok(bottom - top > 200, `${how}: ${bottom - top} high`);
    assert.ok((await page.locator("#options").boundingBox()).y >= header, `${how}: the tools`);
  };
  await isWhole("at first");
  await page.click("#open-lag");
  await isWhole("with the lag");
  await page.evaluate(() => document.querySelector("main").scrollTo(0, 1000));
  await isWhole("scrolled");
  await page.getByRole("button", { name: "Edit", exact: true }).click();
  await isWhole("edited");
});
