// The page for people who use it in other ways: by keys alone, with forced colours, with less motion, by a screen reader.

import assert from "node:assert/strict";
import fs from "node:fs";
import { createRequire } from "node:module";
import { test } from "node:test";
import { WHOLE_SCREEN_GRATING, openStudio, plays, resize } from "./page.mjs";

/** The page's policy takes no script of others: this one comes from the debugger. */
const AXE = fs.readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

/** What axe-core finds wrong, a line each: the rule, and where. */
async function violations(page) {
  const found = await page.evaluate(() => axe.run(document, { resultTypes: ["violations"] }));
  return found.violations.flatMap(({ id, nodes }) => nodes.map(({ target, failureSummary }) =>
    `${id}: ${target.join(" ")}: ${failureSummary.split("\n").slice(1).join(" ").trim()}`));
}

/** States of the page that are looked at, and what leads there. */
const STATES = {
  "first visit": () => {},
  "text and tools": (page) => page.click("#toggle-drawer"),
  sound: (page) => page.click("#tab-sound"),
  compare: (page) => page.click("#tab-compare"),
  pictures: (page) => page.click("#tab-pictures"),
  "what is felt": (page) => page.click("#tab-report"),
  "a live layer": async (page) => {
    await page.click("#tab-layers");
    await page.click("text=Make live");
    await page.locator("#panel-layers input[type=range]").waitFor();
  },
  "a mistake": async (page) => {
    await page.evaluate((text) => (studioPage.editor.text = text), WHOLE_SCREEN_GRATING.replace("grating", "gratin"));
    await page.locator("#problems li.error").waitFor();
  },
  options: (page) => page.click("#options summary"),
  board: (page) => page.click("#open-board"),
  about: async (page) => {
    await page.keyboard.press("Escape");
    await page.click("#open-about");
    await page.locator("#about p.soft").waitFor();
  },
  open: async (page) => {
    await page.keyboard.press("Escape");
    await page.click("#open-files");
    await page.locator("#open h3").first().waitFor();
  },
};

for (const colorScheme of ["light", "dark"]) {
  test(`axe-core finds nothing wrong, ${colorScheme}`, async () => {
    const page = await openStudio(undefined, { isFirstVisit: true });
    await page.emulateMedia({ colorScheme, reducedMotion: "reduce" });
    await page.evaluate(AXE);
    const found = [];
    for (const [name, lead] of Object.entries(STATES)) {
      await lead(page);
      found.push(...(await violations(page)).map((each) => `${name}: ${each}`));
    }
    await page.keyboard.press("Escape");
    await resize(page, [390, 844]);
    await page.click("#toggle-menu");
    found.push(...(await violations(page)).map((each) => `the menu of a phone: ${each}`));
    assert.deepEqual(found, []);
  });
}

test("with forced colours, bars, states, the focus, curves, the lag and layers on the map are told apart", async () => {
  const page = await openStudio();
  await page.emulateMedia({ forcedColors: "active" });
  // Colours that a script has read are resolved anew.
  await page.reload();
  await plays(page);
  const colours = (selector, property, pseudo) =>
    page.evaluate(
      ([selector, property, pseudo]) =>
        [...document.querySelectorAll(selector)].map((each) => getComputedStyle(each, pseudo)[property]),
      [selector, property, pseudo],
    );
  const areDifferent = (...found) => assert.equal(new Set(found).size, found.length, `${found}`);
  const [bar] = await colours(".step-bar", "backgroundColor");
  areDifferent(bar, (await colours(".step-bar span", "backgroundColor"))[0]);
  const [state] = await colours("#board", "backgroundColor");
  areDifferent(state, ...(await colours("#board", "backgroundColor", "::before")));
  areDifferent(...(await colours("#tab-layers, #tab-sound", "borderBottomColor")));
  assert.notEqual((await colours("#stop", "borderStyle"))[0], "none");
  areDifferent(...(await colours(".u-legend .u-marker", "borderTopColor")).slice(1));
  await page.keyboard.press("Tab");
  assert.notEqual((await colours(":focus", "outlineStyle"))[0], "none");
  await page.click("#open-lag");
  areDifferent(...(await colours(".lag-by", "borderTopColor")));
  areDifferent(...(await colours(".lag-by", "backgroundColor", "::before")));
  await page.evaluate(() => (document.getElementById("first-words").hidden = false));
  assert.match((await colours("#first-words", "backgroundColor"))[0], /^rgb\(/);
  await page.getByRole("button", { name: "Edit", exact: true }).click();
  await page.locator(".layer-box").first().focus();
  assert.deepEqual(await colours(".layer-box.is-selected", "outlineColor"), ["rgb(255, 255, 255)"]);
  assert.match((await colours(".layer-box.is-selected", "boxShadow"))[0], /rgb\(0, 0, 0\)/);
});

test("with less motion nothing moves by itself but what a person does", async () => {
  const page = await openStudio();
  await page.emulateMedia({ reducedMotion: "reduce" });
  const moving = await page.evaluate(async () => {
    document.getElementById("map").dataset.stale = "drawing";
    await new Promise((done) => setTimeout(done, 50));
    const animations = document.getAnimations().map(({ animationName, transitionProperty }) => animationName ?? transitionProperty);
    const isMoving = (each) => /[1-9]/.test(getComputedStyle(each).transitionDuration + getComputedStyle(each).animationDuration);
    return [...animations, ...[...document.querySelectorAll("body *")].filter(isMoving).map(({ id, className }) => id || className)];
  });
  assert.deepEqual(moving, []);
});

/** The element with the focus: its id or name, whether it is in the window, and whether its focus is seen. */
function focused() {
  const { activeElement } = document;
  const { left, top, right, bottom } = activeElement.getBoundingClientRect();
  const style = getComputedStyle(activeElement);
  const around = getComputedStyle(activeElement.closest(".cm-editor") ?? activeElement);
  return {
    name: activeElement.id || activeElement.getAttribute("aria-label") || activeElement.textContent.trim(),
    isInside: left >= -1 && top >= -1 && right <= innerWidth + 1 && bottom <= innerHeight + 1,
    isSeen: style.outlineStyle !== "none" || around.borderTopColor !== "rgba(0, 0, 0, 0)",
  };
}

test("keys alone reach everything, lead out of the text, and play and stop the board", async () => {
  const page = await openStudio();
  const reached = [];
  for (let presses = 0; presses < 80; presses += 1) {
    await page.keyboard.press("Tab");
    const now = await page.evaluate(focused);
    if (now.name === reached[0]?.name) break;
    reached.push(now);
  }
  const names = reached.map(({ name }) => name);
  for (const name of ["open-gallery", "new", "save", "share", "toggle-drawer", "stop", "scene-name", "Options", "map-finger",
    "pause", "Text of the scene", "tab-layers", "open-board"])
    assert.ok(names.includes(name), `${name} is not reached: ${names.join(", ")}`);
  assert.ok(names.indexOf("tab-layers") > names.indexOf("Text of the scene"), "Tab leads out of the text");
  for (const { name, isInside, isSeen } of reached) {
    assert.ok(isSeen, `the focus of ${name} is not seen`);
    if (name !== "Text of the scene") assert.ok(isInside, `${name} is outside of the window`);
  }
  await page.focus("#stop");
  await page.keyboard.press("Space");
  await page.waitForFunction(() => document.documentElement.dataset.state === "disarmed");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.documentElement.dataset.state === "active");
  await page.focus("#tab-layers");
  await page.keyboard.press("ArrowRight");
  assert.ok(await page.locator("#panel-sound").isVisible());
  await page.focus("#toggle-drawer");
  await page.keyboard.press("Enter");
  assert.ok(await page.locator("#drawer").isHidden());
  await page.focus("#map-finger");
  await page.keyboard.down("ArrowRight");
  await page.waitForFunction(() => /^\d+$/.test(document.querySelector("#numbers dd.felt span").textContent));
  await page.keyboard.up("ArrowRight");
});
