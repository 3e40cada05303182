// The page in a browser: the numbers of a layer in the panel of the mode Edit, and where the panel is.

import assert from "node:assert/strict";
import { test } from "node:test";
import { PLATES, holdSlider, onPage, openEditing, press, selected, textOf } from "./editing.mjs";
import { boxes, isWithin } from "./layout.mjs";
import { WHOLE_SCREEN_GRATING, plays, resize, writeScene } from "./page.mjs";

test("a slider of a number that was not written keeps its row and its ends while it is dragged, and then", async () => {
  const page = await openEditing(PLATES, [100, 50]);
  const rows = () =>
    page.locator(".layer-number").evaluateAll((all) =>
      all.map((row) => {
        const { ariaLabel, min, max } = row.querySelector("[type=range]");
        return [ariaLabel, min, max].join(" ");
      }),
    );
  const before = await rows();
  const slider = page.getByLabel("gain of right, ×", { exact: true });
  await holdSlider(page, slider, 0.5, 0.45, 0.4, 0.3);
  assert.deepEqual(await rows(), before, "while it is dragged");
  await page.mouse.up();
  const [, gain] = /\ngain = ([\d.]+)\n/.exec(await textOf(page));
  assert.ok(gain > 0.5 && gain < 0.7, gain);
  await plays(page);
  await press(page, "Escape", "Escape");
  await page.mouse.click(...(await onPage(page, 20, 30)));
  await page.mouse.click(...(await onPage(page, 100, 50)));
  assert.deepEqual(await rows(), before, "when the layer is selected again");
  await page.getByLabel("gain of right, ×, as a number").fill("3");
  await press(page, "Enter");
  assert.equal(await slider.evaluate(({ max, value }) => `${value} of ${max}`), "3 of 5", "for a number beyond its end");
});

test("the right end of a slider of newtons is no more than the drive gives", async () => {
  const page = await openEditing(WHOLE_SCREEN_GRATING, [60, 40]);
  const slider = page.getByLabel("high of grating, N", { exact: true });
  await holdSlider(page, slider, 0.5, 1.3);
  await page.mouse.up();
  await plays(page);
  const [, high] = /high_n = ([\d.]+)\n/.exec(await textOf(page));
  const { reachN, naturalN, isDraft } = await page.evaluate(async () => {
    const { engine, editor } = studioPage;
    return engine.compile({ "a.toml": editor.text }, "a.toml", {});
  });
  const limitN = reachN - naturalN;
  assert.ok(!isDraft && high <= limitN && high > limitN - 2e-4, `${high} of ${limitN}`);
  await slider.focus();
  await press(page, "ArrowRight");
  assert.ok((await textOf(page)).includes(`high_n = ${high}\n`), "a key goes no further");
});

test("the panel says whether its layer is felt, also while a number is dragged, and what numbers mean", async () => {
  const page = await openEditing(PLATES, [20, 30]);
  const verdict = page.locator(".layer-panel .verdict");
  const before = await verdict.textContent();
  const slider = page.getByLabel("friction of left, of reach", { exact: true });
  await holdSlider(page, slider, 0.5, 0.1);
  const isOther = (before) => document.querySelector(".layer-panel .verdict")?.textContent !== before;
  await page.waitForFunction(isOther, before);
  assert.equal(await verdict.textContent(), "not felt");
  assert.ok(await page.evaluate(() => studioPage.player.isHeld));
  await page.mouse.up();
  await page.mouse.click(...(await onPage(page, 100, 50)));
  const words = await page.locator(".layer-number small").allTextContents();
  assert.ok(words.includes("least friction") && words.includes("from one ridge to the next"), `${words}`);
});

const KEYS = `version = 1
[[layer]]
name = "key"
kind = "constant"
friction_fraction = 0.8
region = { x_mm = 10, y_mm = 10, width_mm = 20, height_mm = 20 }
repeat = { columns = 3, rows = 2, dx_mm = 30, dy_mm = 25 }
`;

test("the copies of a layer are numbers of its panel, as many as the screen has room for", async () => {
  const page = await openEditing(KEYS, [15, 15]);
  const slider = (name) => page.getByLabel(`${name} of key`, { exact: true });
  const most = (name) => slider(name).evaluate(({ max }) => Number(max));
  assert.deepEqual([await most("columns"), await most("rows")], [4, 3]);
  for (const name of ["columns", "rows"]) {
    await slider(name).focus();
    await press(page, "ArrowLeft", "ArrowLeft");
  }
  assert.equal(await textOf(page), KEYS.replace("columns = 3, rows = 2", "columns = 1, rows = 1"));
  await plays(page);
  assert.match(await selected(page), /^key, constant, 20 by 20 mm at 10, 10$/);
  for (let times = 0; times < 6; times += 1) await press(page, "ArrowRight");
  assert.match(await textOf(page), /columns = 1, rows = 3,/);
  await plays(page);
});

test("while a number is dragged its slider stays where it is, whatever is said of the layer", async () => {
  const page = await openEditing();
  await page.click("#toggle-drawer");
  for (const size of [[1366, 657], [390, 844]]) {
    await resize(page, size);
    await page.mouse.click(...(await onPage(page, 100, 50)));
    await page.evaluate(() => {
      globalThis.checks = 0;
      const { player } = studioPage;
      const before = player.onCheck;
      player.onCheck = (...args) => {
        before(...args);
        checks += 1;
      };
    });
    const slider = page.getByLabel("low of right, of reach", { exact: true });
    await slider.scrollIntoViewIfNeeded();
    const { y } = await slider.boundingBox();
    const dragTo = await holdSlider(page, slider, 0.05);
    const heights = new Set();
    for (const part of [0.1, 0.3, 0.5, 0.7, 0.85]) {
      const checks = await page.evaluate(() => checks);
      await dragTo(part);
      await page.waitForFunction((before) => checks > before, checks);
      heights.add(Math.round((await slider.boundingBox()).y));
    }
    await page.mouse.up();
    await plays(page);
    heights.add(Math.round((await slider.boundingBox()).y));
    assert.deepEqual([...heights], [Math.round(y)], JSON.stringify(size));
  }
});

test("the panel shows all of a layer in a usual window, and a side that is no number is as before", async () => {
  const page = await openEditing();
  await page.click("#toggle-drawer");
  await resize(page, [1366, 657]);
  await page.getByRole("button", { name: "Add button", exact: true }).click();
  await plays(page);
  const [shown, whole] = await page.locator(".layer-panel").evaluate((each) => [each.clientHeight, each.scrollHeight]);
  assert.ok(whole <= shown, `${whole} of ${shown}`);
  const left = page.locator(".layer-sides input").first();
  const before = await left.inputValue();
  await left.focus();
  await press(page, "Control+a");
  await page.keyboard.type("-");
  await press(page, "Enter");
  assert.equal(await left.inputValue(), before);
});

test("handles at the edge of the screen are whole", async () => {
  const page = await openEditing(WHOLE_SCREEN_GRATING);
  await resize(page, [390, 844]);
  await page.mouse.click(...(await onPage(page, 60, 40)));
  const map = await page.locator("#map").boundingBox();
  for (const handle of await page.locator(".layer-handle:visible").all()) {
    const { x, y, width, height } = await handle.boundingBox();
    const [left, top] = [x + width / 2 - 7, y + height / 2 - 7];
    assert.ok(left >= map.x && left + 14 <= map.x + map.width, `${left} of ${JSON.stringify(map)}`);
    assert.ok(top >= map.y && top + 14 <= map.y + map.height, `${top} of ${JSON.stringify(map)}`);
  }
});

test("numbers of a layer are tuned in the panel", async () => {
  const page = await openEditing(PLATES, [100, 50]);
  const slider = page.getByLabel("wavelength of right, mm", { exact: true });
  assert.deepEqual(await slider.evaluate(({ min, max, value }) => [min, max, value]), ["0.5", "20", "4"]);
  await holdSlider(page, slider, 0.2, 0.3, 0.5, 0.7);
  await page.mouse.up();
  const [, mm] = /wavelength_mm = (\d+(?:\.\d)?)\n/.exec(await textOf(page));
  assert.ok(mm > 10 && mm < 18, mm);
  await press(page, "Control+z");
  assert.equal(await textOf(page), PLATES, "a slider's drag is one step");
  await plays(page);
  await page.getByLabel("width of right, mm").fill("30");
  await press(page, "Enter");
  assert.equal(await textOf(page), PLATES.replace("width_mm = 40", "width_mm = 30"));
  await plays(page);
});

test("a slider lets go where its key goes up elsewhere, and a number that no scene has is not shown", async () => {
  const page = await openEditing(PLATES, [20, 30]);
  const slider = page.getByLabel("friction of left, of reach", { exact: true });
  await slider.focus();
  await page.keyboard.down("ArrowRight");
  assert.ok(await page.evaluate(() => studioPage.player.isHeld));
  await press(page, "Tab");
  await page.keyboard.up("ArrowRight");
  await plays(page);
  assert.match(await textOf(page), /friction_fraction = 0\.51\n/);
  const number = page.getByLabel("friction of left, of reach, as a number");
  await number.fill("1000");
  await press(page, "Enter");
  assert.equal(await number.inputValue(), "0.51");
});

test("sliders are for the numbers that count, and end where the finger does", async () => {
  const text = WHOLE_SCREEN_GRATING.replace("\n[[", "\n[defaults]\nlow_fraction = 0.1\n\n[[");
  const page = await openEditing(text, [60, 40]);
  const labels = await page.locator(".layer-numbers [type=range]").evaluateAll((all) => all.map((each) => each.ariaLabel));
  assert.deepEqual(labels.filter((label) => /^low/.test(label)), ["low of grating, N"]);
  const most = () => page.getByLabel("high of grating, N", { exact: true }).evaluate(({ max }) => max);
  const before = await most();
  const names = await page.locator("#finger option").evaluateAll((all) => all.map(({ value }) => value));
  await page.locator("#options summary").click();
  await page.selectOption("#finger", names.find((name) => /dry/.test(name)));
  await page.waitForFunction(
    (before) => document.querySelector('[aria-label="high of grating, N"]').max !== before,
    before,
  );
  await plays(page);
  await page.selectOption("#finger", "");
});

const GRAINS = `version = 1
[[layer]]
name = "sand"
kind = "noise"
wavelength_min_mm = 3.0
wavelength_max_mm = 8.0
low_n = 0.0
high_n = 0.05
`;

test("a decimal comma is a point, and a slider has its usual ends back when its number is usual again", async () => {
  const page = await openEditing(GRAINS, [60, 40]);
  const number = page.getByLabel("wavelength max of sand, mm, as a number", { exact: true });
  await number.click();
  await press(page, "Control+a");
  await page.keyboard.type("9,5");
  await press(page, "Enter");
  assert.match(await textOf(page), /wavelength_max_mm = 9\.5\n/);
  const most = () => page.getByLabel("wavelength max of sand, mm", { exact: true }).evaluate(({ max }) => Number(max));
  const usual = await most();
  await writeScene(page, GRAINS.replace("max_mm = 8.0", "max_mm = 150.0"));
  assert.equal(await most(), 200);
  await writeScene(page, GRAINS);
  assert.equal(await most(), usual);
});

test("a mistake that a hand makes is said in the panel until it is mended, and moves no slider", async () => {
  const page = await openEditing(GRAINS, [60, 40]);
  const slider = page.getByLabel("wavelength min of sand, mm", { exact: true });
  const note = page.locator(".layer-panel .note");
  const { y } = await slider.boundingBox();
  const dragTo = await holdSlider(page, slider, 0.13, 0.7);
  await note.filter({ hasText: "wavelength_min_mm" }).waitFor();
  assert.equal((await slider.boundingBox()).y, y);
  await dragTo(0.2);
  await page.waitForFunction(() => document.querySelector(".layer-panel .note").textContent === "");
  await page.mouse.up();
  await plays(page);
  assert.equal((await slider.boundingBox()).y, y);
  // A number that is again what it was before is played, too.
  const number = page.getByLabel("wavelength min of sand, mm, as a number", { exact: true });
  const before = await number.inputValue();
  await number.fill("9");
  await number.fill(before);
  await press(page, "Enter");
  await plays(page);
});

test("the verdict of a layer that is added, and why a board refuses a draft, are read without scrolling", async () => {
  const page = await openEditing();
  await page.getByRole("button", { name: "Add edge", exact: true }).click();
  await page.locator(".layer-felt .verdict").waitFor();
  const assertRead = async (...parts) => {
    const { ".layer-panel": panel, ...found } = await boxes(page, [".layer-panel", ".layer-felt .verdict", ...parts]);
    for (const box of Object.values(found)) assert.ok(isWithin(box, panel), JSON.stringify([box, panel]));
  };
  await assertRead();
  await writeScene(page, PLATES.replace("friction_fraction = 0.5", "friction_n = 0.5"));
  const note = page.locator(".layer-panel .note");
  for (const xMm of [20, 90]) {
    await page.mouse.click(...(await onPage(page, xMm, 30)));
    await note.filter({ hasText: /^A board refuses this draft: layer 1 "left" / }).waitFor();
    await assertRead(".layer-panel .note");
  }
  await writeScene(page, PLATES);
  assert.equal(await note.textContent(), "");
});

const NOTIFIED = `version = 1
[[layer]]
name = "buzz"
kind = "vibration"
live = true
start = "off"
frequency_hz = 90
low_fraction = 0
high_fraction = 0.9
burst = { period_ms = 1000, on_ms = 500, ramp_ms = 50 }
`;

test("Play once plays a layer that starts off under a finger that slides, and nothing of it before or after", async () => {
  const page = await openEditing(NOTIFIED, [60, 40]);
  const felt = await page.evaluate(async () => {
    const { samples } = studioPage;
    const add = samples.add;
    const voltages = [];
    samples.add = (frame) => {
      voltages.push(...frame.voltageV.filter((_, at) => frame.speedMmPerS[at] > 20));
      add.call(samples, frame);
    };
    await wait(500);
    const before = voltages.length;
    [...document.querySelectorAll(".layer-actions button")].find(({ textContent }) => textContent === "Play once").click();
    await wait(2500);
    samples.add = add;
    const driven = voltages.filter((volts) => volts > 20).length;
    return { before, driven, slid: voltages.length, first: voltages[0], last: voltages.at(-1) };
  });
  assert.equal(felt.before, 0, "no finger slides while layers are edited");
  assert.ok(felt.driven > 0.15 * felt.slid && felt.driven < 0.6 * felt.slid, JSON.stringify(felt));
  assert.ok(felt.first < 5 && felt.last < 5, JSON.stringify(felt));
});

test("the shape of a wave is chosen from those that the kind of the layer has", async () => {
  const page = await openEditing(NOTIFIED, [60, 40]);
  const wave = page.getByLabel("wave of buzz", { exact: true });
  assert.deepEqual(await wave.locator("option").allTextContents(), ["sine", "square"]);
  assert.equal(await wave.inputValue(), "sine");
  await wave.selectOption("square");
  assert.match(await textOf(page), /wave = "square"\n/);
  await plays(page);
  await press(page, "Control+z");
  assert.equal(await textOf(page), NOTIFIED);
  await plays(page);
  assert.equal(await wave.inputValue(), "sine");
});
