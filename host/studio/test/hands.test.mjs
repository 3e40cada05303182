// The page in a browser: layers are edited on the map, by mouse, touch and keys, and their text changes with them.

import assert from "node:assert/strict";
import { test } from "node:test";
import { PLATES, drag, dragHandle, hold, onPage, openEditing, press, selected, textOf, touchScreen } from "./editing.mjs";
import { WHOLE_SCREEN_GRATING, openStudio, plays, writeScene } from "./page.mjs";

test("a drag moves a layer, all else in the text stays, and one undo takes it back", async () => {
  const page = await openEditing();
  await drag(page, [20, 30], [32.6, 25]);
  const moved = PLATES.replace("x_mm = 10.0, y_mm = 20", "x_mm = 22.5, y_mm = 15");
  assert.equal(await textOf(page), moved);
  await plays(page);
  assert.equal(await selected(page), "left, constant, 30 by 30 mm at 22.5, 15");
  await press(page, "Control+z");
  assert.equal(await textOf(page), PLATES);
  await press(page, "Control+y");
  assert.equal(await textOf(page), moved);
});

test("a drag that comes back on its way is still one step, and no other step is lost", async () => {
  const page = await openEditing();
  await drag(page, [20, 30], [25, 30]);
  const before = await textOf(page);
  await hold(page, [20, 30], [25, 30], [20, 30], [20, 40], [30, 45]);
  await page.mouse.up();
  assert.match(await textOf(page), /x_mm = 25\.0, y_mm = 35,/);
  await page.evaluate(() => studioPage.editor.undo());
  assert.equal(await textOf(page), before);
  await page.evaluate(() => studioPage.editor.undo());
  assert.equal(await textOf(page), PLATES);
});

test("handles resize, and a layer of the whole screen gets a region", async () => {
  const page = await openEditing(PLATES, [20, 30]);
  await dragHandle(page, "se", 10, -5);
  await dragHandle(page, "w", 4, 9);
  const resized = "{x_mm = 14.0, y_mm = 20, width_mm = 36, height_mm = 25}";
  assert.equal(await textOf(page), PLATES.replace(/\{x_mm.*\}/, resized));
  await writeScene(page, WHOLE_SCREEN_GRATING);
  await page.mouse.click(...(await onPage(page, 60, 40)));
  await drag(page, [60, 40], [70, 40]);
  const note = await page.locator(".layer-panel [role=status]").textContent();
  assert.match(note, /covers the whole screen: drag a corner/);
  assert.equal(await textOf(page), WHOLE_SCREEN_GRATING);
  await dragHandle(page, "nw", 20, 10);
  const region = 'kind = "grating"\nregion = { x_mm = 20, y_mm = 10, width_mm = 100, height_mm = 70 }';
  assert.equal(await textOf(page), WHOLE_SCREEN_GRATING.replace('kind = "grating"', region));
  await plays(page);
});

test("while a hand moves a layer, check and map follow, and nothing is played until it lets go", async () => {
  const page = await openEditing();
  await page.evaluate(() => {
    globalThis.calls = [];
    const { engine, player } = studioPage;
    for (const name of ["check", "map", "play"]) {
      const call = engine[name].bind(engine);
      engine[name] = (...args) => {
        calls.push(name);
        return call(...args);
      };
    }
    globalThis.statuses = [];
    const before = player.onStatus;
    player.onStatus = (status) => {
      statuses.push(status);
      before(status);
    };
  });
  await page.mouse.move(...(await onPage(page, 20, 30)));
  await page.mouse.down();
  for (let mm = 2; mm <= 20; mm += 2) {
    await page.mouse.move(...(await onPage(page, 20 + mm, 30)));
    // The outline is where the hand is, whatever the worker does.
    assert.equal(await selected(page), `left, constant, 30 by 30 mm at ${10 + mm}, 20`);
  }
  await page.waitForFunction(() => calls.filter((name) => name === "map").length >= 2);
  const { calls, statuses } = await page.evaluate(() => ({ calls, statuses }));
  assert.ok(!calls.includes("play"), `${calls}`);
  assert.ok(calls.filter((name) => name === "check").length <= 10, `no check but the newest waits: ${calls}`);
  assert.deepEqual(statuses, ["loading"], "Arm waits for the scene as it is in the end");
  await page.mouse.up();
  await plays(page);
  assert.deepEqual(await page.evaluate(() => statuses), ["loading", "loaded"]);
  assert.equal((await page.evaluate(() => calls)).filter((name) => name === "play").length, 1);
});

test("a click selects the smallest layer and keeps it; a double click, and Alt, take the next larger one", async () => {
  const all = '\n[[layer]]\nname = "all"\nkind = "speed"\nspeeds_mm_per_s = [1, 9]\nfactors = [1, 1]\n';
  const page = await openEditing(PLATES + all);
  const names = [];
  const place = await onPage(page, 20, 30);
  const note = page.locator(".layer-panel .note");
  const name = async () => names.push((await selected(page)).split(",")[0]);
  for (const clickCount of [1, 1, 2]) {
    await page.mouse.click(...place, { clickCount });
    await name();
  }
  assert.match(await note.textContent(), /^Selected all, the next larger one here\./);
  await page.keyboard.down("Alt");
  await page.mouse.click(...place);
  await page.keyboard.up("Alt");
  await name();
  assert.match(await note.textContent(), /^Selected left, the smallest here\./);
  assert.deepEqual(names, ["left", "left", "all", "left"]);
  // A handle takes none.
  const { x, y, width, height } = await page.locator(".layer-handle[data-side=se]").boundingBox();
  await page.mouse.click(x + width / 2, y + height / 2, { clickCount: 2 });
  await name();
  assert.equal(names.at(-1), "left");
  // A double click whose first click selects does no more.
  await page.mouse.click(...(await onPage(page, 100, 50)), { clickCount: 2 });
  await name();
  assert.equal(names.at(-1), "right");
  await press(page, "Escape");
  assert.equal(await page.locator(".layer-box[aria-current=true]").count(), 0);
  assert.equal(await page.locator(".layer-panel input:visible").count(), 0);
});

test("a press takes a smaller layer that lies on the one that is selected, and drags it", async () => {
  const below = 'version = 1\n[[layer]]\nname = "ground"\nkind = "constant"\nfriction_n = 0.3\n';
  const text = PLATES.replace("version = 1\n", below);
  const page = await openEditing(text, [60, 70]);
  assert.match(await selected(page), /^ground, /);
  await drag(page, [20, 30], [25, 30]);
  assert.match(await selected(page), /^left, /);
  assert.equal(await textOf(page), text.replace("x_mm = 10.0", "x_mm = 15.0"));
  // What a double click took stays selected at a press there, and at no other place.
  await page.mouse.dblclick(...(await onPage(page, 25, 30)));
  assert.match(await selected(page), /^ground, /);
  await page.mouse.click(...(await onPage(page, 25, 30)));
  assert.match(await selected(page), /^ground, /);
  await page.mouse.click(...(await onPage(page, 35, 40)));
  assert.match(await selected(page), /^left, /);
});

test("a finger on a touch screen moves a layer", async () => {
  const page = await openEditing();
  const { touch, detach } = await touchScreen(page);
  await touch("touchStart", await onPage(page, 20, 30));
  for (let mm = 2; mm <= 20; mm += 2) await touch("touchMove", await onPage(page, 20 + mm, 30));
  await touch("touchEnd");
  await detach();
  assert.equal(await textOf(page), PLATES.replace("x_mm = 10.0", "x_mm = 30.0"));
  await plays(page);
});

test("everything works by keys alone", async () => {
  const page = await openStudio();
  await writeScene(page, PLATES);
  await page.getByRole("button", { name: "Edit", exact: true }).focus();
  await press(page, "Enter");
  // The map follows what stands above it.
  await page.evaluate(() => document.getElementById("options").querySelector("summary").focus());
  await press(page, "Tab");
  assert.equal(await selected(page), "left, constant, 30 by 30 mm at 10, 20");
  await press(page, "Shift+ArrowRight", "ArrowDown", "Alt+ArrowLeft");
  assert.match(await textOf(page), /\{x_mm = 14\.9, y_mm = 21,/);
  await press(page, "PageDown");
  assert.equal(await selected(page), "right, rings, 40 by 40 mm at 70, 20");
  await press(page, "Control+ArrowLeft");
  await press(page, "Control+z");
  assert.match(await textOf(page), /\{x_mm = 15\.0, y_mm = 21,/);
  await press(page, "Control+z", "Control+z");
  assert.equal(await textOf(page), PLATES);
  await plays(page);
  // The numbers, and back.
  const focused = () => page.evaluate(() => document.activeElement.getAttribute("aria-label"));
  await press(page, "Space");
  assert.equal(await focused(), "left of left, mm");
  await press(page, "Tab", "Tab", "Tab", "Tab", "ArrowRight", "ArrowRight");
  assert.match(await textOf(page), /friction_fraction = 0\.52\n/);
  await press(page, "Escape");
  assert.equal(await focused(), await selected(page));
  await press(page, "Tab");
  assert.equal(await focused(), "Name of left", "the panel comes next");
  await page.evaluate(() => document.getElementById("options").querySelector("summary").focus());
  await press(page, "Tab", "PageDown", "Control+Enter");
  await page.waitForFunction(() => document.activeElement.classList.contains("cm-content"));
  assert.equal(await page.locator(".cm-activeLine").textContent(), "[[layer]]");
  await page.keyboard.type("# ");
  assert.match(await textOf(page), /# The upper one\.\n# \[\[layer\]\]\n/);
});

test("an arrow key that is held is one step of undo", async () => {
  const page = await openEditing(PLATES, [20, 30]);
  for (let times = 0; times < 5; times += 1) await page.keyboard.down("ArrowRight");
  await page.keyboard.up("ArrowRight");
  assert.equal(await textOf(page), PLATES.replace("x_mm = 10.0", "x_mm = 15.0"));
  await press(page, "Control+z");
  assert.equal(await textOf(page), PLATES);
});

test("in the mode Feel a press slides the finger, also after the mode Edit", async () => {
  const page = await openEditing();
  await drag(page, [20, 30], [25, 30]);
  await page.getByRole("button", { name: "Feel", exact: true }).click();
  const text = await textOf(page);
  await plays(page);
  await page.evaluate(() => {
    globalThis.places = [];
    eachFrame(({ xMm }) => places.push(...xMm));
  });
  await hold(page, [20, 30], [60, 30]);
  await page.waitForFunction(() => places.some((xMm) => Math.abs(xMm - 60) < 1));
  await page.mouse.up();
  assert.equal(await textOf(page), text);
  assert.ok(await page.locator(".hands").isHidden());
});
