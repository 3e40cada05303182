// <frixel-scene> in a document of one's own, from a file and from a server.

import assert from "node:assert/strict";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { assertFelt, lineOf, slideOver } from "./element.mjs";
import { openPage, required } from "./harness.mjs";
import { serve } from "./web_server.mjs";

const SCRIPT = path.join(path.dirname(required("STUDIO_PAGE")), "frixel-scene.js");
const GRATING = fs.readFileSync(new URL("../../../scenes/grating.toml", import.meta.url), "utf8");

/** A folder with a document of these elements, beside the script. */
function documentOf(body, files = {}) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "frixel-element-"));
  fs.symlinkSync(SCRIPT, path.join(folder, "frixel-scene.js"));
  const page = `<!doctype html><meta charset="utf-8"><body>${body}<script src="frixel-scene.js"></script>`;
  for (const [name, content] of Object.entries({ "index.html": page, ...files })) {
    fs.mkdirSync(path.dirname(path.join(folder, name)), { recursive: true });
    fs.writeFileSync(path.join(folder, name), content);
  }
  return folder;
}

const urlOf = (folder) => pathToFileURL(path.join(folder, "index.html")).href;

test("from a file, bundled scenes and scenes inside of the element play", async () => {
  const folder = documentOf(`
    <frixel-scene id="bundled" scene="constant"><img alt="before the script is here"></frixel-scene>
    <frixel-scene id="inside">${GRATING}</frixel-scene>
    <frixel-scene id="draft">version = 1\n[[layer]]\nkind = "constant"\nfriction_n = 9</frixel-scene>
    <frixel-scene id="wrong">version = 1\n[[layer]]\nkind = "gratin"</frixel-scene>
    <frixel-scene id="absent" src="other.toml"></frixel-scene>
    <frixel-scene id="empty"></frixel-scene>`);
  const page = await openPage(urlOf(folder), { isSimulated: true });
  assert.equal(await lineOf(page, "#bundled"), "constant.toml");
  assertFelt(await slideOver(page, "#bundled"));
  assert.equal(await lineOf(page, "#inside"), "scene.toml");
  assertFelt(await slideOver(page, "#inside"));
  assert.match(await lineOf(page, "#draft"), /draft/);
  assert.match(await lineOf(page, "#wrong"), /scene\.toml:3: .*grating/);
  assert.match(await lineOf(page, "#empty"), /has no scene/);
  assert.match(await lineOf(page, "#absent"), /opened from a file/);
});

test("what stands below a scene stays in its place when the scene comes", async () => {
  const scene = '<frixel-scene scene="constant"><img alt="before the script is here"></frixel-scene>';
  const folder = documentOf(`${scene}<h1 id="below">Below</h1>`);
  const init = () => {
    const top = () => document.getElementById("below").getBoundingClientRect().top;
    customElements.whenDefined("frixel-scene").then(() => (globalThis.topsPx = [top()]));
    addEventListener("ready", () => topsPx.push(top()), { capture: true });
  };
  const page = await openPage(urlOf(folder), { init, isSimulated: true });
  await page.waitForFunction(() => globalThis.topsPx?.length === 2);
  const [before, after] = await page.evaluate(() => topsPx);
  assert.ok(Math.abs(after - before) < 1, `from ${before} to ${after} px`);
});

/** Runs in the page before its scripts: counts what lives on outside of elements. */
function countLiving() {
  globalThis.living = { workers: new Set(), frames: new Set(), observers: new Set() };
  const ends = [["Worker", "workers", "terminate"], ["ResizeObserver", "observers", "disconnect"], ["IntersectionObserver", "observers", "disconnect"]];
  for (const [name, kind, end] of ends) {
    const Native = globalThis[name];
    globalThis[name] = class extends Native {
      constructor(...given) {
        super(...given);
        living[kind].add(this);
      }
      [end]() {
        living[kind].delete(this);
        super[end]();
      }
    };
  }
  const request = requestAnimationFrame;
  globalThis.requestAnimationFrame = (act) => {
    const frame = (ms) => {
      living.frames.delete(frame);
      act(ms);
    };
    living.frames.add(frame);
    return request(frame);
  };
  globalThis.countOf = () => Object.fromEntries(Object.entries(living).map(([name, all]) => [name, all.size]));
  /** Replaces what stands in the document by a scene, and waits until it is shown. */
  globalThis.replace = async () => {
    const element = document.createElement("frixel-scene");
    element.setAttribute("scene", "constant");
    const ready = new Promise((resolve) => element.addEventListener("ready", resolve));
    document.querySelector("#place").replaceChildren(element);
    await ready;
  };
}

test("sixty replacements leave the workers, frames and observers of one element, and the last one none", async () => {
  const folder = documentOf('<div id="place"></div>');
  const page = await openPage(urlOf(folder), { init: countLiving });
  await page.evaluate(() => customElements.whenDefined("frixel-scene"));
  await page.evaluate(() => replace());
  const one = await page.evaluate(() => countOf());
  assert.deepEqual(one, { workers: 3, frames: 3, observers: 2 });
  const after = await page.evaluate(async () => {
    for (let count = 0; count < 60; count += 1) await replace();
    return countOf();
  });
  assert.deepEqual(after, one);
  await page.evaluate(() => document.querySelector("#place").replaceChildren());
  await page.waitForFunction(() => Object.values(countOf()).every((count) => count === 0));
  await page.evaluate(() => replace());
  // An element that is moved keeps the engine, and begins anew.
  await page.evaluate(async () => {
    const element = document.querySelector("frixel-scene");
    const ready = new Promise((resolve) => element.addEventListener("ready", resolve));
    document.body.append(element);
    await ready;
  });
  assert.deepEqual(await page.evaluate(() => countOf()), one);
});

/** The address of a folder's document on a server, with a content security policy if there is one. */
async function served(folder, context, policy) {
  const { address, end } = await serve(folder, policy && { "content-security-policy": policy });
  context.after(end);
  return address;
}

test("under the content security policy of docs/design a scene plays, and under less a sentence says what it needs", async (context) => {
  const text = fs.readFileSync(new URL("../../../docs/design/studio.md", import.meta.url), "utf8");
  const [policy] = text.match(/default-src .*/);
  const folder = documentOf('<frixel-scene id="there" scene="constant"></frixel-scene>');
  const page = await openPage(await served(folder, context, policy), { isSimulated: true });
  assert.equal(await lineOf(page, "#there"), "constant.toml");
  assertFelt(await slideOver(page, "#there"));
  await page.context().close();
  const refusals = [
    [" 'wasm-unsafe-eval'", ""],
    ["worker-src blob:", "worker-src 'self'"],
    ["script-src 'self' blob:", "script-src 'self'"],
  ];
  for (const [allowed, less] of refusals) {
    assert.ok(policy.includes(allowed), allowed);
    const refused = policy.replace(allowed, less);
    const page = await openPage(await served(folder, context, refused), { mayFail: true });
    // A function, since the policy lets no text be evaluated.
    await page.waitForFunction(() => {
      const words = document.querySelector("#there").shadowRoot?.textContent;
      return /must allow script-src blob: 'wasm-unsafe-eval'/.test(words);
    });
  }
});

test("from a server, `src` names a scene with its files", async (context) => {
  const part = 'version = 1\n[[layer]]\nkind = "bitmap"\npicture = "wall.png"\nx_mm = 0\ny_mm = 0\nwidth_mm = 80\n';
  const folder = documentOf('<frixel-scene id="there" src="scenes/mine.toml"></frixel-scene>', {
    "scenes/mine.toml": 'version = 1\ninclude = ["parts/wall.toml"]\n',
    "scenes/parts/wall.toml": part,
    "scenes/parts/wall.png": fs.readFileSync(new URL("../../../scenes/textures/leather.png", import.meta.url)),
  });
  const page = await openPage(await served(folder, context), { isSimulated: true, mayFail: true });
  assert.equal(await lineOf(page, "#there"), "mine.toml");
  assertFelt(await slideOver(page, "#there"));
  await page.evaluate(() => document.querySelector("#there").setAttribute("src", "none.toml"));
  await page.waitForFunction(() => {
    const line = document.querySelector("#there").shadowRoot.querySelector(".line");
    return /404/.test(line.textContent);
  });
});
