// The page in a browser: a person's work is not lost, and what is shown agrees with what is felt.

import assert from "node:assert/strict";
import { test } from "node:test";
import { deflateRawSync } from "node:zlib";
import { pageUrl } from "./harness.mjs";
import { WHOLE_SCREEN_GRATING, compareBlind, liveGrating, openScene, openStudio, plays, resize, wholeStroke, writeScene } from "./page.mjs";
import { pageModule } from "./page_module.mjs";

test("a reload brings back the scene, its name and its finger", async () => {
  const page = await openStudio();
  await writeScene(page, WHOLE_SCREEN_GRATING);
  await page.fill("#scene-name", "ridges");
  await page.press("#scene-name", "Enter");
  await resize(page, [390, 844]);
  const options = page.locator("#options summary");
  assert.equal(await options.innerText(), "Options");
  await options.click();
  await page.selectOption("#finger", "dry");
  await page.reload();
  await plays(page);
  await options.filter({ hasText: "Options: dry" }).waitFor();
  assert.equal(await page.evaluate(() => studioPage.editor.text), WHOLE_SCREEN_GRATING);
  assert.equal(await page.inputValue("#scene-name"), "ridges");
  assert.equal(await page.inputValue("#finger"), "dry");
  const broken = WHOLE_SCREEN_GRATING.replace("grating", "gratin");
  await page.evaluate((text) => (studioPage.editor.text = text), broken);
  await page.reload();
  await page.locator("#map-hint", { hasText: "mend the mistake" }).waitFor();
  assert.equal(await page.evaluate(() => studioPage.editor.text), broken);
});

test("another scene has a history of its own, and the changed one before can be brought back", async () => {
  const page = await openStudio();
  assert.ok(await page.isDisabled("#undo"), "nothing to undo");
  await writeScene(page, WHOLE_SCREEN_GRATING);
  assert.ok(await page.isEnabled("#undo"));
  await openEmpty(page);
  assert.ok(await page.isDisabled("#undo"), "undo does not lead into the scene before");
  assert.match(await page.evaluate(() => studioPage.editor.text), /^version = 1\n\n# Edit adds layers/);
  // The way back stays while nobody works on the new scene.
  await page.mouse.move(5, 400);
  await page.evaluate(() => wait(120_000));
  assert.match(await page.locator("#notice span").innerText(), /^brick is kept in Open\.$/);
  // Another sentence takes its place only as long as that is shown.
  const replaced = await page.evaluate(async () => {
    const { notify, forgetNotice } = await import(await studio.moduleUrl("page/notices.js"));
    notify("Another sentence.");
    const said = document.getElementById("notice").innerText;
    forgetNotice();
    return said;
  });
  assert.match(replaced, /^Another sentence\./);
  assert.doesNotMatch(replaced, /Back to brick/);
  await page.click("text=Back to brick");
  await page.waitForFunction((text) => studioPage.editor.text === text, WHOLE_SCREEN_GRATING);
  assert.equal(await page.inputValue("#scene-name"), "brick");
  await openEmpty(page);
  await page.locator("#notice >> text=Back to brick").waitFor();
  await writeScene(page, GRATING_OF_3_MM);
  await page.evaluate(() => wait(15_000));
  assert.ok(await page.isVisible("#notice >> text=Back to brick"), "a while");
  await page.evaluate(() => wait(30_000));
  assert.ok(await page.isHidden("#notice"));
});

test("a scene has a name that every file system takes", async () => {
  const { Project } = await pageModule("project.js");
  const project = new Project();
  for (const [typed, name] of [["a:b/c?", "a-b-c-"], ["con", "con-"], ["con.x", "con-.x"], ["cone", "cone"], ["end. .", "end"], ["..", "scene"], ["größe 2", "größe 2"]]) {
    project.name = typed;
    assert.equal(project.name, name);
  }
});

/** Opens an empty scene. */
async function openEmpty(page) {
  await page.click("#new");
  await page.click("#new-scene >> text=Empty scene");
  await page.waitForFunction(() => document.getElementById("scene-name").value === "untitled");
}

/** The names of the recent scenes in Open, as a person sees them. */
async function recent(page) {
  await page.click("#open-files");
  await page.locator("#open h3", { hasText: "Recent scenes" }).waitFor();
  await page.waitForFunction(() => document.querySelector("#open .scenes").textContent !== "");
  const names = await page.locator("#open article h3").allTextContents();
  await page.click("#open >> text=Close");
  return names;
}

/** Opens the recent scene of this name. */
async function reopen(page, name) {
  await page.click("#open-files");
  await page.click(`#open article:has(h3:text-is("${name}")) >> text=Open`);
}

/** A PNG picture of one pixel. */
const PIXEL = Buffer.from(
  "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==", "base64",
);

const GRATING_OF_3_MM = WHOLE_SCREEN_GRATING.replace("wavelength_mm = 2", "wavelength_mm = 3");

test("what was changed is in Open after New, the gallery, a link and a closed tab, one entry for each", async () => {
  const page = await openStudio();
  await writeScene(page, WHOLE_SCREEN_GRATING);
  await page.fill("#scene-name", "mine");
  await page.press("#scene-name", "Enter");
  await writeScene(page, GRATING_OF_3_MM);
  await openEmpty(page);
  assert.deepEqual(await recent(page), ["mine"]);
  await page.click("#open-gallery");
  await page.click("text=Open linen");
  await page.waitForFunction(() => document.getElementById("scene-name").value === "linen");
  assert.deepEqual(await recent(page), ["mine"], "what was only opened is not work");
  const link = `#scene=${deflateRawSync(JSON.stringify({ name: "theirs", text: WHOLE_SCREEN_GRATING })).toString("base64url")}`;
  await page.evaluate((link) => (location.hash = link), link);
  await page.waitForFunction(() => document.getElementById("scene-name").value === "theirs");
  await writeScene(page, GRATING_OF_3_MM);
  const other = await page.context().newPage();
  await page.close();
  await other.goto(pageUrl);
  await other.waitForFunction(() => globalThis.studioPage);
  assert.equal(await other.inputValue("#scene-name"), "theirs", "a new tab goes on with what was changed last");
  assert.deepEqual(await recent(other), ["theirs", "mine"]);
  await reopen(other, "mine");
  await other.waitForFunction((text) => studioPage.editor.text === text, GRATING_OF_3_MM);
  assert.ok(await other.locator("#open").isHidden());
  const picture = () => document.querySelector("#open article img")?.naturalWidth > 0;
  // The dialog shows what is kept when it opens, and the map's picture is kept once the map is drawn.
  await other.waitForFunction(async () => {
    const { Works } = await import(await studio.moduleUrl("page/works.js"));
    return (await new Works().all()).some((work) => work.picture);
  });
  await other.click("#open-files");
  await other.waitForFunction(picture);
  await other.click("#open article:has(h3:text-is('theirs')) >> text=Delete");
  await other.click("#open >> text=Delete for good");
  await other.waitForFunction(() => document.querySelectorAll("#open article").length === 1);
});

test("the map of a scene is not shown when another one was opened meanwhile", async () => {
  const page = await openStudio();
  const wasLate = await page.evaluate(async () => {
    const { engine, map, player } = studioPage;
    /** The map that is ready when another scene is open. */
    let late = null;
    const wasLate = [];
    const { show } = map;
    map.show = (picture, check) => {
      if (late) wasLate.push(picture === late);
      show.call(map, picture, check);
    };
    const drawn = engine.map.bind(engine);
    engine.map = async (...scene) => {
      engine.map = drawn;
      document.getElementById("new").click();
      [...document.querySelectorAll("#new-scene button")].find((each) => each.textContent === "Empty scene").click();
      const picture = await drawn(...scene);
      while (document.getElementById("scene-name").value !== "untitled") await new Promise((resolve) => setTimeout(resolve));
      late = picture;
      return picture;
    };
    player.now(studioPage.editor.text);
    while (wasLate.length === 0) await new Promise((resolve) => setTimeout(resolve));
    return wasLate;
  });
  assert.deepEqual(wasLate, [false], "the first map that is shown after it is the new scene's");
});

test("two tabs never write the same piece of work", async () => {
  const page = await openStudio();
  await writeScene(page, WHOLE_SCREEN_GRATING);
  const other = await page.context().newPage();
  await other.goto(pageUrl);
  await other.waitForFunction(() => globalThis.studioPage && document.getElementById("check").textContent === "plays");
  await reopen(other, "brick");
  await other.waitForFunction((text) => studioPage.editor.text === text, WHOLE_SCREEN_GRATING);
  await other.evaluate((text) => (studioPage.editor.text = text), GRATING_OF_3_MM);
  await other.close({ runBeforeUnload: true });
  await page.reload();
  await page.waitForFunction(() => globalThis.studioPage);
  assert.equal(await page.evaluate(() => studioPage.editor.text), WHOLE_SCREEN_GRATING);
  assert.deepEqual(await recent(page), ["brick", "brick"]);
});

test("a page that closes while a scene is being opened does not lose the one before", async () => {
  const page = await openStudio();
  await writeScene(page, WHOLE_SCREEN_GRATING);
  const close = () => {
    LockManager.prototype.request = () => new Promise(() => {});
    document.getElementById("new").click();
    document.querySelector("#new-scene .head button").click();
    return new Promise((resolve) => {
      const look = () => {
        if (document.getElementById("scene-name").value !== "untitled") return setTimeout(look);
        dispatchEvent(new Event("pagehide"));
        return resolve();
      };
      look();
    });
  };
  await page.evaluate(close);
  assert.deepEqual(await recent(page), ["brick"]);
});

test("a piece of work with more files than a zip may have comes back", async () => {
  const page = await openStudio();
  const picture = (number) => ({ name: `p${number}.png`, mimeType: "image/png", buffer: PIXEL });
  await page.setInputFiles("#files", Array.from({ length: 101 }, (_, number) => picture(number)));
  await page.locator("#notice", { hasText: "p100.png" }).waitFor();
  await page.click("#save");
  await page.locator("#notice", { hasText: /unpacks to 10\d files/ }).waitFor();
  await openEmpty(page);
  await reopen(page, "brick");
  await page.waitForFunction(() => document.getElementById("scene-name").value === "brick");
});

test("a browser that keeps nothing says so at the first change of each scene", async () => {
  const init = () => {
    IDBObjectStore.prototype.put = () => {
      throw new DOMException("full", "QuotaExceededError");
    };
  };
  const page = await openStudio(pageUrl, { init });
  const notice = page.locator("#notice:not([hidden]) span");
  assert.equal(await notice.count(), 0, "nothing is lost yet");
  await writeScene(page, WHOLE_SCREEN_GRATING);
  await notice.filter({ hasText: /does not keep brick: its store is full\. Save it before you close/ }).waitFor();
  await openEmpty(page);
  await writeScene(page, GRATING_OF_3_MM);
  await notice.filter({ hasText: "does not keep untitled" }).waitFor();
});

test("About says what is simulated, the version, and whose work the file carries", async () => {
  const page = await openStudio();
  await page.click("#open-about");
  const about = page.locator("#about");
  await about.getByText("Not simulated: how friction feels").waitFor();
  await about.getByText(/^Version \d+\.\d+\.\d+, commit [0-9a-f]{12}/).waitFor();
  await page.click("#about summary");
  for (const whose of [/CodeMirror|codemirror/, /uplot/, /heapless 0/, /Apache License/])
    await about.locator("pre", { hasText: whose }).waitFor();
});

test("a press on the map ends a replay and is felt", async () => {
  const page = await openStudio();
  await wholeStroke(page, 40);
  await page.click("#scope-options summary");
  await page.selectOption("#slowness", "25");
  await page.check("#loop");
  const pressOnReplay = async () => {
    const { samples } = studioPage;
    const replay = document.getElementById("replay");
    replay.click();
    while (replay.textContent !== "Stop replay") await wait(20);
    await wait(300);
    const beginS = samples.nowS;
    await stroke(20, 60, 20, 80);
    return samples.since(beginS).yMm.filter((mm) => Math.abs(mm - 20) < 2).length;
  };
  const felt = await page.evaluate(pressOnReplay);
  assert.ok(felt > 200, `${felt} samples of the new stroke`);
  await page.locator("text=Replay slowly").waitFor();
});

test("layer and map say that a switch or a gain differs from the scene", async () => {
  const page = await openScene(liveGrating("ridges"));
  const note = page.locator("#map-note");
  assert.ok(await note.isHidden());
  await page.getByLabel("ridges on").uncheck();
  await page.waitForFunction(() => /Now: ridges off/.test(document.getElementById("map-note").textContent));
  assert.match(await page.locator(".live-note").textContent(), /^Off now/);
  await page.getByLabel("ridges on").check();
  const gain = page.getByLabel("gain of ridges, as a number");
  await gain.fill("0.5");
  await page.waitForFunction(() => /ridges × 0.5/.test(document.getElementById("map-note").textContent));
  await gain.fill("2000");
  await gain.press("Enter");
  await page.waitForFunction(() => /it stays 0.5/.test(document.getElementById("notice").textContent));
  assert.equal(await gain.inputValue(), "0.5");
  await writeScene(page, WHOLE_SCREEN_GRATING);
  assert.ok(await note.isHidden(), "the scene plays anew");
});

test("a blind comparison is answered after both were felt, shows no layers, and ends unanswered where it has to", async () => {
  const page = await openStudio();
  const edit = page.getByRole("button", { name: "Edit", exact: true });
  await edit.click();
  await compareBlind(page);
  assert.ok((await page.locator(".hands").isHidden()) && (await edit.isHidden()), "outlines would say which one is felt");
  assert.ok(await page.isDisabled("text=X is better"));
  await page.click("text=Feel Y");
  assert.ok(await page.isEnabled("text=X is better"));
  await page.click("#panel-compare >> text=Turn sound on");
  await page.waitForFunction(() => studioPage.sound.isOn);
  await page.click("#panel-compare >> text=Cancel");
  await page.locator("text=it does not count").waitFor();
  for (const change of [
    () => page.evaluate(() => document.getElementById("prediction").click()),
    async () => {
      await page.locator("#options summary").click();
      await page.selectOption("#finger", "dry");
    },
  ]) {
    await page.click("text=Compare A with the scene now");
    await page.locator("body.blind").waitFor();
    await change();
    await page.locator("text=the comparison is over").waitFor();
    assert.equal(await page.locator("body.blind").count(), 0);
  }
});
