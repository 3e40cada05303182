// The site that `cargo xtask studio --site` makes, on a web server: kept for use without a network, and installable.

import assert from "node:assert/strict";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import { assertFelt, lineOf, slideOver } from "./element.mjs";
import { openPage, required } from "./harness.mjs";
import { serve } from "./web_server.mjs";

const SITE = required("STUDIO_SITE");
const PAGE_MAX_BYTES = 2_000_000;
/** Largest module of <frixel-scene>, as a web server sends it, bytes. */
const MODULE_MAX_BYTES = 900_000;

const plays = (page) =>
  page.waitForFunction(() => globalThis.studioPage && document.documentElement.dataset.state === "active");

/** The site keeps all of its files. */
const isKept = (page) => page.evaluate(async () => void (await navigator.serviceWorker.ready));

/** Opens the site of a folder, which keeps it: the page, its address, and what ends the server. */
async function visit(context, folder = SITE) {
  const { address, end } = await serve(folder);
  context.after(end);
  const page = await openPage(address, { isSimulated: true });
  await plays(page);
  await isKept(page);
  return { page, address, end };
}

test("from the second visit on, page, gallery and links open without the server", async (context) => {
  const { page, address, end } = await visit(context);
  const link = await page.evaluate(async () => {
    const { linkOf } = await import(await studio.moduleUrl("page/share.js"));
    return linkOf("mine", 'version = 1\n[[layer]]\nkind = "constant"\nfriction_fraction = 0.5\n', []);
  });
  assert.ok(link.startsWith(`${address}#`), link);
  end();
  await page.goto("about:blank");
  await page.goto(link);
  await page.waitForFunction(() => document.getElementById("scene-name")?.value === "mine");
  await plays(page);
  await page.goto(`${address}gallery/`);
  // Its picture comes from beside the module.
  assert.equal(await lineOf(page, 'frixel-scene[scene="brick"]'), "brick.toml");
  assertFelt(await slideOver(page, 'frixel-scene[scene="brick"]'));
});

test("a newer version is offered, and takes the place of the one before once a person wants it", async (context) => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "frixel-site-"));
  fs.cpSync(SITE, folder, { recursive: true });
  const { page, address } = await visit(context, folder);
  const cachesOf = () => page.evaluate(() => caches.keys());
  await page.evaluate(() => caches.open("of somebody else"));
  const [before] = await cachesOf();
  const worker = path.join(folder, "service-worker.js");
  fs.writeFileSync(worker, fs.readFileSync(worker, "utf8").replace(/"version":"[^"]*"/, '"version":"newer"'));
  await page.goto(address);
  await plays(page);
  // Chromium looks for a newer version once the machine has time: a page that plays took it all on a busy one.
  await page.evaluate(() => studioPage.engine.close());
  await page.getByText("Load it", { exact: true }).waitFor();
  assert.ok((await cachesOf()).includes(before), "the version before goes on");
  await Promise.all([page.waitForEvent("load"), page.getByText("Load it", { exact: true }).click()]);
  await plays(page);
  const after = await cachesOf();
  assert.ok(after.length === 2 && !after.includes(before) && after.includes("of somebody else"), after.join());
});

test("Chromium would install it", async (context) => {
  const { page } = await visit(context);
  const devTools = await page.context().newCDPSession(page);
  const { errors, data } = await devTools.send("Page.getAppManifest");
  assert.deepEqual(errors, []);
  assert.equal(JSON.parse(data).display, "standalone");
  const { installabilityErrors } = await devTools.send("Page.getInstallabilityErrors");
  // The tests have windows that keep nothing, in which nothing is installed.
  const others = installabilityErrors.filter(({ errorId }) => errorId !== "in-incognito");
  assert.deepEqual(others, []);
});

test("the page and the element's module are small enough", (context) => {
  const { size } = fs.statSync(required("STUDIO_PAGE"));
  const { length } = gzipSync(fs.readFileSync(path.join(SITE, "frixel-scene.module.js")), { level: 9 });
  context.diagnostic(`${size} and ${length} bytes`);
  assert.ok(size <= PAGE_MAX_BYTES && length <= MODULE_MAX_BYTES, `${size} and ${length} bytes`);
});
