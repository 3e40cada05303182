// The place of every layer of the gallery: as the text says it, it is as the compiler says it, before and after a hand
// has changed the text.

import assert from "node:assert/strict";
import { before, test } from "node:test";
import { openStudio } from "./page.mjs";
import { forAllTests } from "./harness.mjs";

/** One page for all tests, which only run functions in it. */
let page;
before(async () => {
  page = await forAllTests(openStudio);
});

/** What is said of friction, or of a place inside the layer, where a layer has gone elsewhere. */
const FELT = /\d of the reach\), and at|lies \d+ mm outside its `region`|the picture is stretched by/;

/** Scenes of what the gallery does not show, by name. */
const MORE = {
  pixels: `version = 1
[design]
width_px = 1200
height_px = 400
[defaults]
region = { x_px = 100, y_mm = 10, width_px = 200, height_mm = 20 }
[[layer]]
kind = "constant"
friction_fraction = 0.5
[[layer]]
kind = "edge"
x_px = 600
y_px = 200
width_mm = 3
ridge_fraction = 0.4
repeat = { columns = 2, rows = 3, dx_px = 300, dy_mm = 15 }
`,
  polygons: `version = 1
[defaults]
region = { shape = "polygon", points_mm = [[10, 10], [40, 10], [25.5, 30]] }
[[layer]]
kind = "constant"
friction_fraction = 0.5
repeat = { columns = 2, dx_mm = -5 }
[[layer]]
kind = "constant"
friction_fraction = 0.5
region.shape = "polygon"
region.points_mm = [
  [60, 10], # a corner
  [90, 20],
  [70, 60],
]
`,
  pictures: `version = 1
[[layer]]
kind = "bitmap"
picture = "textures/brick.png"
x_mm = 20
y_mm = 10
width_mm = 20
[[layer]]
kind = "bitmap"
picture = "textures/brick.png"
x_mm = 60
y_mm = 20
width_mm = 30
height_mm = 20
angle_deg = 30
[[layer]]
kind = "bitmap"
picture = "textures/brick.png"
region = { x_mm = 10, y_mm = 50, width_mm = 20, height_mm = 20 }
`,
  included: `version = 1
include = ["parts/b.toml"]
[[layer]]
kind = "constant"
friction_fraction = 0.5
[[layer]]
kind = "edge"
width_mm = 3
ridge_fraction = 0.4
region = { x_px = 500, y_px = 100, width_px = 400, height_px = 200 }
[[layer]]
kind = "edge"
x_mm = 60
width_mm = 3
ridge_fraction = 0.4
region = { x_px = 500, y_px = 100, width_px = 400, height_px = 200 }
`,
};

/** What the last of them includes: the place of a layer, and the size of a pixel, stand in other files. */
const INCLUDED = {
  "parts/b.toml": `version = 1
include = ["../c.toml"]
[design]
width_px = 1200
height_px = 400
[defaults]
x_px = 600
y_px = 200
`,
  "c.toml": `version = 1
[defaults]
x_mm = 10
region = { x_px = 100, y_mm = 10, width_px = 200, height_mm = 20 }
`,
};

/** Runs in the page: moves and resizes each layer of the scenes, and returns what the compiler says of it. */
async function changeAll([more, included]) {
  const module = async (name) => import(await studio.moduleUrl(`page/${name}.js`));
  const [{ TomlText }, { placeOf, bounds }] = [await module("toml_text"), await module("place")];
  const names = studio.names("scenes/").filter((name) => /^scenes\/[^/]+\.toml$/.test(name));
  const gallery = await Promise.all(names.map(async (name) => [name, await studio.text(name)]));
  const textures = Object.fromEntries(
    await Promise.all(
      studio.names("scenes/textures/").map(async (name) => [name.slice("scenes/".length), await studio.bytes(name)]),
    ),
  );
  const files = { ...textures, ...included };
  const check = (text) => studioPage.engine.compile({ ...files, "a.toml": text }, "a.toml", {});
  const list = (box) => [box.x, box.y, box.width, box.height];
  const found = [];
  for (const [name, text] of [...gallery, ...Object.entries(more)]) {
    const before = await check(text);
    const toml = new TomlText(text, before.defaults["a.toml"]);
    for (const layer of before.layers) {
      const at = toml.layerAt(layer.from[0]);
      const place = placeOf(toml, at, layer, before.screen);
      const about = { name: `${name} ${layer.name}`, isWhole: place.isWholeScreen };
      found.push({ ...about, what: "place", expected: list(bounds(place.box, place.copies)), actual: layer.boxMm });
      const make = async (what, changes, expected) => {
        const after = await check(toml.with(changes));
        const { boxMm } = after.layers.find(({ index }) => index === layer.index);
        const others = ({ layers }) =>
          JSON.stringify(layers.filter(({ index }) => index !== layer.index).map((each) => each.boxMm));
        const known = before.problems.map(({ message }) => message);
        const problems = after.problems.map(({ message }) => message).filter((each) => !known.includes(each));
        const areOthersSame = others(after) === others(before);
        found.push({ ...about, what, expected, actual: boxMm, problems, areOthersSame });
      };
      const { x, y, width, height } = bounds(place.box, place.copies);
      if (!place.whyNotMoved) {
        const { widthMm } = before.screen;
        const [dx, dy] = [Math.min(3, widthMm - x - width), Math.max(-4, -y)];
        await make("moved", place.move(3, -4), place.isWholeScreen ? null : [x + dx, y + dy, width, height]);
      }
      if (place.whyNotResized) continue;
      const { box } = place;
      const part = place.keepsRatio ? 0.5 : 0.8;
      const to = { x: box.x + 2, y: box.y + 1, width: box.width * 0.5, height: box.height * part };
      await make("resized", place.resize(to), list(bounds(to, place.isWholeScreen ? [[0, 0]] : place.copies)));
    }
  }
  return found;
}

test("the place of a layer in its text is the compiler's, also after it was moved and resized", async () => {
  const found = await page.evaluate(changeAll, [MORE, INCLUDED]);
  for (const { name, what, expected, actual, isWhole, problems = [], areOthersSame = true } of found) {
    const about = `${name}, ${what}: ${JSON.stringify({ expected, actual, problems })}`;
    assert.deepEqual(problems.filter((problem) => !FELT.test(problem)), [], about);
    assert.ok(areOthersSame, `other layers stay, ${about}`);
    if ((isWhole && what === "place") || expected === null) assert.equal(actual, null, about);
    // A pixel of the design is 0.1 mm wide and 0.2 mm high.
    else for (const [side, mm] of expected.entries()) assert.ok(Math.abs(mm - actual[side]) < 0.11, about);
  }
  const count = (what) => found.filter((each) => each.what === what).length;
  assert.ok(count("moved") > 20 && count("resized") > 30, `${count("moved")} moved, ${count("resized")} resized`);
});

/** Runs in the page: the text of a file once its layer has moved, on a screen of 120 by 80 mm. */
async function movedIn({ text, byMm }) {
  const module = async (name) => import(await studio.moduleUrl(`page/${name}.js`));
  const [{ TomlText }, { placeOf }] = [await module("toml_text"), await module("place")];
  const toml = new TomlText(text);
  const layer = { kind: "constant", boxMm: [10, 4, 4, 4] };
  return toml.with(placeOf(toml, 0, layer, { widthMm: 120, heightMm: 80, pixelMm: [0.4, 0.4] }).move(byMm, 0));
}

test("pixels stay whole, unless one has a part or a step is finer", async () => {
  const text = (x) => `[[layer]]\nregion = { x_px = ${x}, y_px = 10, width_px = 10, height_px = 10 }\n`;
  const xAfter = async (x, byMm) => /x_px = ([\d.]+)/.exec(await page.evaluate(movedIn, { text: text(x), byMm }))[1];
  assert.equal(await xAfter("30", 1), "33");
  assert.equal(await xAfter("30", 0.1), "30.25");
  assert.equal(await xAfter("30.5", 1), "33.0");
  assert.equal(await xAfter("30.5", 0.4), "31.5");
});
