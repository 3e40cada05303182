// The widget of notebooks (`frixel.widget`) in a page without a notebook, whose models have what Python sends.
//
// `host/python/tests/test_widget.py` runs this, with the file of those models in WIDGETS and their module in WIDGET_MODULE.

import assert from "node:assert/strict";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { assertFelt, lineOf, slideOver } from "./element.mjs";
import { openPage, required } from "./harness.mjs";

/** An empty document. */
function emptyDocument() {
  const file = path.join(fs.mkdtempSync(path.join(os.tmpdir(), "frixel-widget-")), "index.html");
  fs.writeFileSync(file, '<!doctype html><meta charset="utf-8"><body>');
  return pathToFileURL(file).href;
}

/** Runs in the page: renders each model with a module of its own, as anywidget does. */
async function renderAll([script, states]) {
  globalThis.models = [];
  globalThis.removers = [];
  for (const [at, state] of states.entries()) {
    const url = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    const { default: widget } = await import(url);
    const acts = new Map();
    const model = {
      get: (name) => state[name],
      on: (event, act) => acts.set(event, act),
      off: (event) => acts.delete(event),
      set(name, value) {
        state[name] = value;
        acts.get(`change:${name}`)?.();
      },
    };
    for (const [name, base64] of Object.entries(state.scene.files)) {
      const bytes = Uint8Array.from(` ${atob(base64)}`, (character) => character.charCodeAt(0));
      state.scene.files[name] = new DataView(bytes.buffer, 1);
    }
    const el = document.body.appendChild(document.createElement("div"));
    el.id = `cell-${at}`;
    models.push(model);
    removers.push(await widget.render({ model, el }));
  }
}

/** How many colours the map has between two parts of its width, below the ruler. */
function coloursOf(page, selector, [from, to]) {
  return page.evaluate(
    ([selector, from, to]) => {
      const picture = document.querySelector(selector).shadowRoot.querySelector("#map-picture");
      const { width, height } = picture;
      const { data } = picture.getContext("2d").getImageData(from * width, 0.3 * height, (to - from) * width, 0.6 * height);
      return new Set(new Uint32Array(data.buffer)).size;
    },
    [selector, from, to],
  );
}

test("widgets show their scenes, play, change, and go, and the page loads nothing", async () => {
  const widgets = JSON.parse(fs.readFileSync(required("WIDGETS"), "utf8"));
  const module = fs.readFileSync(required("WIDGET_MODULE"), "utf8");
  const page = await openPage(emptyDocument(), { isSimulated: true });
  const requests = [];
  page.on("request", (request) => requests.push(request.url()));
  await page.evaluate(renderAll, [module, widgets]);

  const [first, second] = ["#cell-0 frixel-scene", "#cell-1 frixel-scene"];
  assert.equal(await lineOf(page, first), "scene.toml");
  assert.ok((await coloursOf(page, first, [0.15, 0.45])) > 20, "a picture on the left");
  assert.equal(await coloursOf(page, first, [0.7, 0.8]), 1, "nothing on the right");
  assertFelt(await slideOver(page, first));
  assert.equal(await lineOf(page, second), "scene.toml");
  assertFelt(await slideOver(page, second));
  for (const name of ["finger", "screen", "touch"]) {
    assert.equal(await page.locator(second).getAttribute(name), widgets[1].scene[name] ?? widgets[1][name] ?? null);
  }

  const draft = { text: 'version = 1\n[[layer]]\nkind = "constant"\nfriction_n = 9', files: {}, finger: null, screen: null };
  await page.evaluate((draft) => models[0].set("scene", draft), draft);
  assert.match(await lineOf(page, first), /draft/);
  await page.evaluate(() => removers[0]());
  assert.equal(await page.locator("frixel-scene").count(), 1);
  assert.deepEqual(requests.filter((url) => !url.startsWith("blob:")), []);
});
