// The page in a browser: each number says what it is, to a press and to keys, and nothing is said of another scene.

import assert from "node:assert/strict";
import { test } from "node:test";
import { KEYS, WHOLE_SCREEN_GRATING, openScene, openStudio, plays, resize, wholeStroke, writeScene } from "./page.mjs";

/** Stripes on the right half; bare glass on the left. */
const RIGHT_HALF = `${WHOLE_SCREEN_GRATING}region = { x_mm = 60, y_mm = 0, width_mm = 60, height_mm = 80 }\n`;
/** A layer of one friction. */
const PLATE = `version = 1

[[layer]]
kind = "constant"
friction_fraction = 0.9
region = { x_mm = 60, y_mm = 20, width_mm = 40, height_mm = 40 }
`;

test("a press on a number, and a key, say what it is", async () => {
  const page = await openStudio(undefined, { isFirstVisit: true });
  const notice = page.locator("#notice");
  const meanings = {
    "Felt friction": /simulated finger feels/,
    "Above bare glass": /noticeable steps \(Weber steps\).*Weber step is a factor of 1\.11/,
    "Drive voltage": /\(V rms\).*adds friction, and takes none away/,
    Speed: /Speed of the simulated finger/,
  };
  for (const [at, [title, meaning]] of Object.entries(meanings).entries()) {
    const { x, y, width: wide } = await page.locator("#numbers div").nth(at).boundingBox();
    await page.mouse.click(x + wide - 8, y + 30);
    await notice.waitFor();
    assert.match(await notice.innerText(), meaning);
    await page.keyboard.press("Escape");
    await page.getByRole("button", { name: title, exact: true }).press("Enter");
    assert.match(await notice.innerText(), meaning);
    await page.keyboard.press("Escape");
  }
});

test("a press on a verdict says what is felt, and what was unfolded below stays so", async () => {
  const page = await openScene(WHOLE_SCREEN_GRATING);
  for (const panel of ["layers", "report"]) {
    await page.click(`#tab-${panel}`);
    await page.locator(`#panel-${panel} .verdict`).first().click();
    assert.match(await page.innerText("#notice span"), /^felt: .*mN/);
    await page.keyboard.press("Escape");
  }
  await page.click("text=What a board needs for it");
  await writeScene(page, PLATE);
  assert.ok(await page.locator("#felt details").first().evaluate(({ open }) => open));
  const cells = await page.locator("#felt tbody tr").first().locator("td").allInnerTexts();
  assert.equal(cells.length, 4, cells.join(" | "));
  assert.ok(Number(cells[2]) > 1, `${cells[2]} steps at the border of a layer of one friction`);
});

test("where nothing is driven nothing is above bare glass, and half a volt is neither none nor one", async () => {
  const page = await openScene(RIGHT_HALF);
  const said = await page.evaluate(async () => {
    const found = new Set();
    const stop = eachFrame(() => {
      const [, weber, drive] = [...document.querySelectorAll("#numbers dd span")].map(({ textContent }) => textContent);
      if (/\d/.test(weber)) found.add(`${weber} at ${drive}`);
    });
    let last;
    const keep = eachFrame((frame) => (last = frame));
    await slide(10, 50, 40, 60);
    keep();
    // The same slide, of a finger that presses harder for a while.
    const harder = (voltageV) => {
      const all = (value) => new Float32Array(400).fill(value);
      const frame = { ...last, feltN: all(0.28), voltageV: all(voltageV), speedMmPerS: all(60), contact: true };
      studioPage.engine.onFrames({ ...frame, xMm: all(NaN) });
      return document.querySelectorAll("#numbers dd.felt span")[1].textContent;
    };
    stop();
    return { found: [...found], harder: harder(0), driven: Number(harder(60)) };
  });
  const { found, harder, driven } = said;
  assert.ok(found.length > 0 && found.every((each) => /^0\.0 at 0\.\d$/.test(each)), found.join(", "));
  assert.equal(harder, "0.0");
  assert.ok(driven > 0.5, `${driven}`);
  const { volts } = await page.evaluate(async () => {
    const { volts } = await import(await studio.moduleUrl("page/dom.js"));
    return { volts: [0, 0.5, 9.96, 150.4].map(volts) };
  });
  assert.deepEqual(volts, ["0.0", "0.5", "10", "150"]);
});

test("the button of the sound says what it does, stays as long as there is sound, and leaves then", async () => {
  const page = await openStudio(undefined, { isFirstVisit: true });
  const hear = page.locator("#hear");
  await hear.click();
  await hear.locator("text=Turn sound off").waitFor();
  await page.getByRole("button", { name: "Edit", exact: true }).click();
  await page.getByRole("button", { name: "Feel", exact: true }).click();
  assert.ok(await hear.isVisible(), "after Edit");
  await hear.click();
  await hear.waitFor({ state: "hidden" });
});

test("a scene that opens has none of the curves of the one before", async () => {
  const page = await openStudio();
  await wholeStroke(page, 40);
  assert.ok(await page.evaluate(() => studioPage.samples.count > 0));
  await page.evaluate(() => wait(1500));
  await page.click("#open-gallery");
  await page.click('text="Open grating"');
  await page.waitForFunction(() => document.getElementById("scene-name").value === "grating");
  await plays(page);
  const kept = await page.evaluate(() => studioPage.samples.since(0).xMm.filter(Number.isFinite).length);
  assert.equal(kept, 0);
});

test("a slide that leaves the map selects no text, and a selection is read in light and dark", async () => {
  const page = await openStudio();
  const from = await page.locator("#map-picture").boundingBox();
  const to = await page.locator("#editor").boundingBox();
  await page.mouse.move(from.x + 4, from.y + 4);
  await page.mouse.down();
  await page.mouse.move(to.x + 60, to.y + 90, { steps: 5 });
  await page.mouse.up();
  assert.equal(await page.evaluate(() => String(getSelection())), "");
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme });
    await page.click("#editor .cm-content");
    await page.keyboard.press("Control+a");
    await page.locator(".cm-selectionBackground").first().waitFor({ state: "attached" });
    const part = await page.evaluate(() => {
      const canvas = new OffscreenCanvas(1, 1).getContext("2d");
      const light = (colour) => {
        canvas.fillStyle = colour;
        canvas.fillRect(0, 0, 1, 1);
        const [red, green, blue] = [...canvas.getImageData(0, 0, 1, 1).data].map((value) => (value / 255) ** 2.2);
        return 0.2126 * red + 0.7152 * green + 0.0722 * blue + 0.05;
      };
      const [behind, ink] = [".cm-selectionBackground", ".cm-content"].map((each) => getComputedStyle(document.querySelector(each)));
      const [one, other] = [light(behind.backgroundColor), light(ink.color)];
      return Math.max(one, other) / Math.min(one, other);
    });
    assert.ok(part >= 4.5, `${colorScheme}: ${part}`);
  }
});

test("in the gallery pictures have their places at once and open their scenes, names read as words, and Close stays in sight", async () => {
  const page = await openStudio();
  await resize(page, [390, 844]);
  // Nothing is drawn yet.
  const shapes = await page.evaluate(() => {
    document.getElementById("open-gallery").click();
    return [...document.querySelectorAll("#gallery canvas")].map((each) => each.clientWidth / each.clientHeight);
  });
  assert.ok(shapes.length > 5 && shapes.every((ratio) => Math.abs(ratio - 1.5) < 0.02), `${shapes}`);
  await page.locator("#gallery button", { hasText: "Open velvet" }).waitFor();
  assert.deepEqual((await page.locator("#gallery h3").allTextContents()).filter((name) => name.includes("_")), []);
  await page.evaluate(() => document.getElementById("gallery").scrollTo(0, 10_000));
  const box = await page.locator("#gallery .head button").boundingBox();
  assert.ok(box.y >= 0 && box.y + box.height <= 844, JSON.stringify(box));
  await page.locator("#gallery article", { hasText: "Open velvet" }).locator("canvas").click();
  await page.waitForFunction(() => document.getElementById("scene-name").value === "velvet");
});

test("names of layers are whole in the table, and the state beside a name, with the text open", async () => {
  const page = await openStudio();
  await resize(page, [1366, 657]);
  await writeScene(page, WHOLE_SCREEN_GRATING.replace('kind = "grating"', 'name = "stripes"\nkind = "grating"'));
  await page.click("#tab-report");
  const lines = await page.evaluate(() =>
    [...document.querySelectorAll("#felt tbody th, #felt .verdict, #felt .number")]
      .filter((each) => each.checkVisibility())
      .map((each) => {
        const range = document.createRange();
        range.selectNodeContents(each);
        return [each.textContent, new Set([...range.getClientRects()].map(({ top }) => Math.round(top))).size];
      }),
  );
  assert.ok(lines.length >= 3 && lines.every(([, count]) => count === 1), JSON.stringify(lines));
  await page.evaluate((text) => (studioPage.editor.text = text), KEYS.replace("bitmap", "bitmop"));
  await page.locator("#problems li.error").waitFor();
  const check = await page.evaluate(() => {
    const found = document.getElementById("check");
    return [found.scrollHeight <= found.clientHeight + 1, found.scrollWidth <= found.clientWidth + 1, found.textContent];
  });
  assert.deepEqual(check.slice(0, 2), [true, true], check[2]);
});

test("a voltage that the board does not let through is a warning at its line, counted while the text is closed", async () => {
  const text = WHOLE_SCREEN_GRATING.replace("version = 1\n", "version = 1\n[drive]\nvoltage_max_v_rms = 1000\n");
  const page = await openScene(text);
  const warning = page.locator("#problems li.warning");
  await warning.waitFor();
  assert.match(await warning.innerText(), /^line 3\s*`voltage_max_v_rms = 1000` exceeds what the board allows/);
  assert.match(await warning.innerText(), /211\.0 V rms .* limit of 220 V peak and a crest factor of 1\.043/);
  await page.click("#toggle-drawer");
  const count = page.locator("#mistakes");
  assert.deepEqual([await count.innerText(), await count.getAttribute("aria-label")], ["1", "1 warning"]);
  await writeScene(page, WHOLE_SCREEN_GRATING);
  assert.ok(await count.isHidden());
});

test("a computer that is too slow for real time says so while a finger slides, and no longer than it is", async () => {
  const page = await openScene(RIGHT_HALF);
  const said = await page.evaluate(async () => {
    const pace = document.getElementById("pace");
    const told = () => (pace.hidden ? "" : pace.textContent);
    const found = [];
    // Late by less than the simulator catches up with, by more, and by nothing.
    for (const ms of [40, 112, 0]) {
      beLate(ms);
      await slide(10, 50, 40, ms > 0 ? 40 : 8);
      found.push(told());
    }
    lift(50, 40);
    return found;
  });
  assert.match(said[1], /^This computer plays at 0\.1 of real time: /);
  assert.deepEqual([said[0], said[2]], ["", ""]);
});
