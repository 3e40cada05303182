// The site in Firefox: `cargo xtask soak firefox`, which says in the environment where the site and the browser are.

import assert from "node:assert/strict";
import { after, test } from "node:test";
import puppeteer from "puppeteer-core";
import { serve } from "../web_server.mjs";

const { STUDIO_SITE, FIREFOX } = process.env;
/** Longest wait: a busy machine may be slow, ms. */
const WAIT_MAX_MS = 120_000;

const browser = await puppeteer.launch({ browser: "firefox", executablePath: FIREFOX, headless: true });
after(() => browser.close());

const plays = (page) =>
  page.waitForFunction(() => globalThis.studioPage && document.documentElement.dataset.state === "active");

/** A stroke of the mouse over the map; returns the least and the largest friction that was felt, N. */
async function slide(page) {
  const canvas = await page.$("#map-finger");
  const { x, y, width, height } = await canvas.boundingBox();
  const [left, right, middle] = [x + 0.2 * width, x + 0.8 * width, y + 0.5 * height];
  await page.mouse.move(left, middle);
  await page.mouse.down();
  for (let at = left; at < right; at += 8) await page.mouse.move(at, middle);
  await page.mouse.up();
  await page.waitForFunction(() => studioPage.samples.since(0).feltN.filter(Number.isFinite).length > 100);
  return page.evaluate(() => {
    const felt = [...studioPage.samples.since(0).feltN].filter((value) => value > 0.05);
    return [Math.min(...felt), Math.max(...felt)];
  });
}

test("Firefox plays the page, is felt under the mouse, and opens it again without the server", async (context) => {
  const { address, end } = await serve(STUDIO_SITE);
  context.after(end);
  const page = await browser.newPage();
  page.setDefaultTimeout(WAIT_MAX_MS);
  const errors = [];
  page.on("pageerror", ({ message }) => errors.push(message));
  await page.goto(address);
  await plays(page);
  const [least, most] = await slide(page);
  assert.ok(most - least > 0.02, `the friction changes: from ${least} to ${most} N`);
  await page.evaluate(async () => void (await navigator.serviceWorker.ready));
  end();
  await page.goto(address);
  await plays(page);
  assert.deepEqual(errors, []);
});
