// Changes of values in a TOML text: an independent parser sees that value changed and no other, and what the change did
// not have to touch stays as it was, byte by byte.

import assert from "node:assert/strict";
import fs from "node:fs";
import { test } from "node:test";
import { parse as parseTables } from "smol-toml";
import { pageModule } from "./page_module.mjs";

const { TomlText, numberText, replaced } = await pageModule("toml_text.js");
/** Its tables have no prototype, which deepEqual would compare. */
const parse = (text) => structuredClone(parseTables(text));

const folder = new URL("../../../scenes/", import.meta.url);
const gallery = fs.readdirSync(folder).filter((name) => name.endsWith(".toml"));
const FORMS = `# 🖐 a head
version = 1 # two

[ defaults ]
y_mm=40
region.x_mm = 1.50
region . y_mm = +2

# above
[[layer]] # first
  "kind" = 'rings'
  region.x_mm = 3   # left
  region.shape = "ellipse"
  points = [ [0, 1.0],
    [2.5, 1_000], # inside
  ]
# below

[layer.burst]
period_ms = 1e3

[[layer]]
region = {x_mm = 1.0, "y_mm" = 2,width_mm=3}
burst = {}

# the last one
[[layer]]
# empty
[layer.region]
x_mm = -0.5#close`;
const texts = [FORMS, ...gallery.map((name) => fs.readFileSync(new URL(name, folder), "utf8"))];
const ARRAY = `version = 1
layer = [
  { kind = "constant", friction_n = 0.3 }, # one
  { kind = "stream", region.x_mm = 1 },
]
`;
texts.push(ARRAY);

/** Forms that only a hand writes: words of tables in a string, hexadecimal, a table out of order, comments inside. */
const ODD = `version = 1

[[layer]]
kind = "rings"
gain = 0x1F
note = """
[[layer]] # no table
gain = 7
"""
region = { x_mm = 1, # left
  y_mm = 0b11, width_mm = 5 }

[design]
width_px = 1200

[layer.repeat]
columns = 0o17
dx_mm = 4

[[layer]]
gain = 2
`;
texts.push(ODD);
texts.push(FORMS.replaceAll("\n", "\r\n"));

/** Small numbers in an order that is the same at each run. */
function* random(seed) {
  for (let state = seed; ; ) {
    state = (1103515245 * state + 12345) % 2 ** 31;
    yield state / 2 ** 31;
  }
}

function numbersIn(value, path = []) {
  if (typeof value === "number") return [path];
  if (typeof value !== "object") return [];
  const keys = Array.isArray(value) ? value.keys() : Object.keys(value);
  return [...keys].flatMap((key) => numbersIn(value[key], [...path, key]));
}

/** A copy of a value in which that at a path is another. */
function withValue(value, path, other) {
  const copy = structuredClone(value);
  let at = copy;
  for (const key of path.slice(0, -1)) at = at[key] ??= {};
  at[path.at(-1)] = other;
  return copy;
}

test("a number is changed where it stands, and nothing else", () => {
  const numbers = random(7);
  let changed = 0;
  for (const text of texts) {
    const toml = new TomlText(text);
    const before = parse(text);
    for (const path of numbersIn(before)) {
      assert.equal(toml.value(path), before[path[0]] && path.reduce((at, key) => at[key], before), path.join("."));
      for (let times = 0; times < 20; times += 1) {
        const decimals = Math.floor(3 * numbers.next().value);
        const value = (numbers.next().value - 0.4) * 10 ** (4 * numbers.next().value);
        const rounded = Number(value.toFixed(decimals)) || 0;
        const found = toml.replacements([{ path, value, decimals }]);
        const edited = replaced(text, found);
        assert.deepEqual(parse(edited), withValue(before, path, rounded), `${path} = ${value}`);
        assert.ok(found.length <= 1);
        for (const { from, to, insert } of found) {
          assert.match(text.slice(from, to), /^([-+\d._e]+|0[xob][\dA-F]+)$/, "only the digits of the number go");
          assert.match(insert, /^-?\d+(\.\d{1,2})?$/);
          changed += 1;
        }
      }
    }
  }
  assert.ok(changed > 3000, `${changed} changes`);
});

test("several numbers are changed at once", () => {
  const toml = new TomlText(FORMS);
  const changes = [
    { path: ["layer", 1, "region", "width_mm"], value: 4.25, decimals: 2 },
    { path: ["layer", 0, "points", 1, 0], value: 7, decimals: 2 },
    { path: ["layer", 1, "region", "x_mm"], value: 6, decimals: 2 },
  ];
  const edited = replaced(FORMS, toml.replacements(changes));
  const expected = FORMS.replace("[2.5,", "[7.0,").replace("{x_mm = 1.0", "{x_mm = 6.0").replace("=3}", "=4.25}");
  assert.equal(edited, expected);
});

test("a key that is missing is added in the form that its table has", () => {
  const add = (path, value, after) => {
    const edited = replaced(FORMS, new TomlText(FORMS).replacements([{ path, value, decimals: 2, after }]));
    assert.deepEqual(parse(edited), withValue(parse(FORMS), path, value), path.join("."));
    return edited;
  };
  const lines = (from, to) => [FORMS, FORMS.replace(from, to)][1];
  assert.equal(
    add(["layer", 0, "region", "y_mm"], 4),
    lines('  region.shape = "ellipse"', '  region.shape = "ellipse"\n  region.y_mm = 4'),
  );
  assert.equal(add(["layer", 1, "region", "height_mm"], 4), lines("width_mm=3}", "width_mm=3, height_mm = 4}"));
  assert.equal(add(["layer", 1, "burst", "on_ms"], 4), lines("burst = {}", "burst = { on_ms = 4 }"));
  assert.equal(add(["layer", 1, "gain"], 0.5), lines("burst = {}", "burst = {}\ngain = 0.5"));
  assert.equal(add(["layer", 2, "gain"], 0.5), lines("[[layer]]\n# empty", "[[layer]]\ngain = 0.5\n# empty"));
  assert.equal(add(["layer", 2, "region", "y_mm"], 1), lines("-0.5#close", "-0.5#close\ny_mm = 1"));
  assert.equal(
    add(["layer", 0, "gain"], 2, "kind"),
    lines("\"kind\" = 'rings'", "\"kind\" = 'rings'\n  gain = 2"),
  );
  assert.equal(
    add(["layer", 2, "repeat"], { columns: 2, dx_mm: 3 }),
    lines("[[layer]]\n# empty", "[[layer]]\nrepeat = { columns = 2, dx_mm = 3 }\n# empty"),
  );
});

test("a key is added to a table of an odd form", () => {
  const add = (path, value) => {
    const edited = replaced(ODD, new TomlText(ODD).replacements([{ path, value, decimals: 2 }]));
    assert.deepEqual(parse(edited), withValue(parse(ODD), path, value), path.join("."));
    return edited;
  };
  const lines = (from, to) => ODD.replace(from, to);
  assert.equal(add(["layer", 0, "region", "height_mm"], 4), lines("width_mm = 5 }", "width_mm = 5, height_mm = 4 }"));
  assert.equal(add(["layer", 0, "angle_deg"], 4), lines("width_mm = 5 }", "width_mm = 5 }\nangle_deg = 4"));
  assert.equal(add(["layer", 0, "repeat", "rows"], 2), lines("dx_mm = 4", "dx_mm = 4\nrows = 2"));
});

test("a layer is taken out with its comment, and every other layer stays", () => {
  for (const text of texts) {
    const before = parse(text);
    for (const at of before.layer.keys()) {
      const edited = replaced(text, new TomlText(text).removals(at));
      const layer = before.layer.filter((_, other) => other !== at);
      assert.deepEqual({ layer: [], ...parse(edited) }, { ...before, layer });
      assert.ok(!/\n\n\n|\n\n$/.test(edited), "no gap is left");
    }
  }
  const without = (at) => replaced(FORMS, new TomlText(FORMS).removals(at));
  assert.equal(without(2), `${FORMS.slice(0, FORMS.indexOf("\n\n# the last one"))}\n`);
  assert.equal(without(0), FORMS.slice(0, FORMS.indexOf("# above")) + FORMS.slice(FORMS.indexOf("[[layer]]\nregion")));
  // The comment at the head of a file says what the scene is.
  const head = "# a scene\n[[layer]]\nkind = 1\n";
  assert.equal(replaced(head, new TomlText(head).removals(0)), "# a scene\n");
});

test("the last element of an array is taken out, and the comment of the one before stays", () => {
  for (const [text, expected] of [
    [ARRAY, ARRAY.replace(/\n.*stream.*/, "")],
    ["layer = [{ a = 1 }, { b = 2 }]", "layer = [{ a = 1 }]"],
    ["layer = [{ a = 1 }, # one\n  { b = 2 }]", "layer = [{ a = 1 }, # one\n]"],
    ["layer = [{ a = 1 }, # one\n  { b = 2 } # 2, 3\n]", "layer = [{ a = 1 }, # one\n]"],
    ["layer = [\n  { a = 1 }, # one\n  { b = 2 } # two, too\n  , # end\n]", "layer = [\n  { a = 1 }, # one\n]"],
  ]) {
    assert.equal(replaced(text, new TomlText(text).removals(1)), expected);
    assert.deepEqual(parse(expected), { ...parse(text), layer: [parse(text).layer[0]] });
  }
});

test("a table that stands between those of a layer stays", () => {
  const head = "version = 1\n\n";
  const design = "# the design\n[design]\nwidth_px = 10 # wide\nheight_px = 20\n\n";
  const layer = '[[layer]]\nkind = "constant"\n\n';
  const text = `${head}${layer}${design}# where\n[layer.region]\nx_px = 1\n\n${layer}`;
  const toml = new TomlText(text);
  assert.equal(replaced(text, toml.removals(0)), `${head}${design}${layer}`);
  assert.equal(replaced(text, toml.removals(1)), text.slice(0, -layer.length - 1));
});

test("a layer is found by its line", () => {
  const toml = new TomlText(FORMS);
  const lines = FORMS.split("\n").flatMap((line, at) => (line.startsWith("[[layer]]") ? [at + 1] : []));
  assert.deepEqual(lines.map((line) => toml.layerAt(line)), [0, 1, 2]);
  assert.equal(toml.layerAt(lines[0] + 1), undefined);
  assert.deepEqual(new TomlText(ARRAY).layerAt(4), 1);
});

test("numbers are written as a person writes them", () => {
  assert.equal(numberText(1e-9, 2), "0");
  assert.equal(numberText(-0.001, 2), "0");
  assert.equal(numberText(64, 2, "64"), "64");
  assert.equal(numberText(64, 2, "63.5"), "64.0");
  assert.equal(numberText(0.1 + 0.2, 2), "0.3");
  assert.equal(numberText(123456.789, 2), "123456.79");
  for (const value of [NaN, Infinity]) assert.throws(() => numberText(value, 2), /no number of a scene/);
});
