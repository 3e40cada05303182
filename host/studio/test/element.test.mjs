// <frixel-scene> in a document of one's own, from a file and from a server.

import assert from "node:assert/strict";
import fs from "node:fs";
import http from "node:http";
import os from "node:os";
import path from "node:path";
import { after, afterEach, test } from "node:test";
import { pathToFileURL } from "node:url";
import { assertFelt, lineOf, slideOver } from "./element.mjs";
import { cleanUp, endLeftovers, openPage, required } from "./harness.mjs";

const SCRIPT = path.join(path.dirname(required("STUDIO_PAGE")), "frixel-scene.js");
const GRATING = fs.readFileSync(new URL("../../../scenes/grating.toml", import.meta.url), "utf8");

afterEach(endLeftovers);
after(cleanUp);

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

test("from a file, bundled scenes and scenes inside of the element play", async () => {
  const folder = documentOf(`
    <frixel-scene id="bundled" scene="constant"><img alt="before the script is here"></frixel-scene>
    <frixel-scene id="inside">${GRATING}</frixel-scene>
    <frixel-scene id="draft">version = 2\n[[layer]]\nkind = "constant"\nfriction_n = 9</frixel-scene>
    <frixel-scene id="wrong">version = 2\n[[layer]]\nkind = "gratin"</frixel-scene>
    <frixel-scene id="absent" src="other.toml"></frixel-scene>
    <frixel-scene id="empty"></frixel-scene>`);
  const url = pathToFileURL(path.join(folder, "index.html")).href;
  const { page, errors, close } = await openPage(url, { isSimulated: true });
  assert.equal(await lineOf(page, "#bundled"), "constant.toml");
  assertFelt(await slideOver(page, "#bundled"));
  assert.equal(await lineOf(page, "#inside"), "scene.toml");
  assertFelt(await slideOver(page, "#inside"));
  assert.match(await lineOf(page, "#draft"), /draft/);
  assert.match(await lineOf(page, "#wrong"), /scene\.toml:3: .*grating/);
  assert.match(await lineOf(page, "#empty"), /has no scene/);
  assert.match(await lineOf(page, "#absent"), /opened from a file/);
  assert.deepEqual(errors, []);
  await close();
});

test("what stands below a scene stays in its place when the scene comes", async () => {
  const scene = '<frixel-scene scene="constant"><img alt="before the script is here"></frixel-scene>';
  const folder = documentOf(`${scene}<h1 id="below">Below</h1>`);
  const url = pathToFileURL(path.join(folder, "index.html")).href;
  const init = () => {
    const top = () => document.getElementById("below").getBoundingClientRect().top;
    customElements.whenDefined("frixel-scene").then(() => (globalThis.topsPx = [top()]));
    addEventListener("ready", () => topsPx.push(top()), { capture: true });
  };
  const { page, close } = await openPage(url, { init, isSimulated: true });
  await page.waitForFunction(() => globalThis.topsPx?.length === 2);
  const [before, after] = await page.evaluate(() => topsPx);
  assert.ok(Math.abs(after - before) < 1, `from ${before} to ${after} px`);
  await close();
});

test("from a server, `src` names a scene with its files", async (context) => {
  const part = 'version = 2\n[[layer]]\nkind = "bitmap"\npicture = "wall.png"\nx_mm = 0\ny_mm = 0\nwidth_mm = 80\n';
  const folder = documentOf('<frixel-scene id="there" src="scenes/mine.toml"></frixel-scene>', {
    "scenes/mine.toml": 'version = 2\ninclude = ["parts/wall.toml"]\n',
    "scenes/parts/wall.toml": part,
    "scenes/parts/wall.png": fs.readFileSync(new URL("../../../scenes/textures/leather.png", import.meta.url)),
  });
  const server = http.createServer((request, answer) => {
    const file = path.join(folder, path.normalize(new URL(request.url, "http://a").pathname));
    if (fs.existsSync(file)) answer.writeHead(200, { "content-type": "text/html" }).end(fs.readFileSync(file));
    else answer.writeHead(404).end();
  });
  context.after(() => server.close());
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  const { page, close } = await openPage(`http://127.0.0.1:${server.address().port}/index.html`, { isSimulated: true });
  assert.equal(await lineOf(page, "#there"), "mine.toml");
  assertFelt(await slideOver(page, "#there"));
  await page.evaluate(() => document.querySelector("#there").setAttribute("src", "none.toml"));
  await page.waitForFunction(() => {
    const line = document.querySelector("#there").shadowRoot.querySelector(".line");
    return /404/.test(line.textContent);
  });
  await close();
});
