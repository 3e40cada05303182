// A board with an electrode: what it takes to arm it, and what disarms it.

import assert from "node:assert/strict";
import { before, test } from "node:test";
import { deflateRawSync } from "node:zlib";
import {
  addSerialPort, boardTime, CONSTANT, forAllTests, openPage, setVisibility, slowHost, startRealBoard, stateOf,
} from "./harness.mjs";

const FOUR_LAYERS = CONSTANT + '[[layer]]\nkind = "constant"\nabove = "natural"\nfriction_n = 0.01\n'.repeat(3);
const NO_DRIVE = CONSTANT.replace("0.11", "0.0");
const MISTAKEN = CONSTANT.replace('"constant"', '"constan"');

/** Resolves once Arm can be pressed: the gallery may be drawing its maps, and each check waits for one. */
async function armable(page) {
  const said = async () => (await page.locator("#board, #notice, #check").allTextContents()).join("; ");
  const arm = page.locator("#arm:not([hidden]):enabled");
  await arm.waitFor({ timeout: 40_000 }).catch(async () => assert.fail(`nothing can be armed: ${await said()}`));
}
const checkSays = (page, words) =>
  page.waitForFunction((words) => document.getElementById("check").textContent === words, words);
const linkTo = (text) => deflateRawSync(JSON.stringify({ name: "foreign", text, files: {} })).toString("base64url");
const openLink = (page, text) => page.evaluate((hash) => (location.hash = hash), `scene=${linkTo(text)}`);

/** The page with a board that is connected and has this scene, as a person does it. Before, the page runs `prepare`. */
async function connected(prepare = () => {}) {
  const board = await startRealBoard();
  const page = await openPage(undefined, { init: slowHost });
  await page.waitForFunction(() => globalThis.studioPage);
  await checkSays(page, "plays");
  await page.evaluate(prepare);
  await addSerialPort(page, board.terminal);
  await write(page, CONSTANT);
  await checkSays(page, "plays");
  await page.click("#open-board");
  await page.click("text=Board on a USB port");
  await armable(page);
  return { page, board };
}

/** Writes this text in place of the scene's, as a person types it. */
function write(page, text) {
  return page.evaluate((text) => (studioPage.editor.text = text), text);
}

/** One page with one board for all tests: each of them begins by arming it, and leaves it disarmed. */
let page, board;
before(async () => {
  ({ page, board } = await forAllTests(connected));
});

/** The board has the scene and can be armed; returns how many events there were until then. */
async function ready() {
  await write(page, CONSTANT);
  await armable(page);
  return board.events.length;
}

async function pressArm() {
  await ready();
  await page.click("#arm");
  await board.until("armed", stateOf.active);
  await board.until("driving", stateOf.driving);
}

/** Nothing can be armed, neither by the button nor by a press that comes too early for it. */
async function assertNotArmable(from) {
  assert.ok(!(await page.locator("#arm:not([hidden]):enabled").count()), "Arm can be pressed");
  const refused = await page.evaluate(() => studioPage.engine.arm().catch((error) => error.message));
  assert.match(refused, /no scene is on the board/);
  await assertStaysDisarmed(from);
}

async function assertStaysDisarmed(from) {
  await boardTime(300);
  const found = board.events.slice(from);
  assert.ok(found.every((event) => stateOf.disarmed(event.board)), JSON.stringify(found));
}

test("a board with an electrode waits for a press, and foreign scenes disarm it", async () => {
  assert.ok(await page.isHidden("#first-words"), "no ghost finger slides");
  assert.ok(await page.isDisabled("#open-lag"), "a board has no switch for its prediction");
  assert.match(await page.textContent("#arm"), /drive NUCLEO-G474RE with an electrode, up to 220 V peak/);
  await write(page, NO_DRIVE);
  await armable(page);
  await assertStaysDisarmed(0);
  await page.evaluate(async (text) => {
    const arm = document.getElementById("arm");
    studioPage.editor.text = text;
    while (arm.hidden || arm.disabled) await new Promise((resolve) => setTimeout(resolve, 1));
    arm.click();
  }, CONSTANT);
  await board.until("driving: what is armed is the scene that is shown", stateOf.driving);
  await page.click("#stop");

  const foreign = {
    "the stop button": () => page.click("#stop"),
    "a link in the fragment": () => openLink(page, CONSTANT),
    "a dropped file": () =>
      page.evaluate((text) => {
        const dataTransfer = new DataTransfer();
        dataTransfer.items.add(new File([text], "dropped.toml"));
        dispatchEvent(new DragEvent("drop", { dataTransfer, bubbles: true, cancelable: true }));
      }, CONSTANT),
    async "a scene of the gallery"() {
      await page.click("#open-gallery");
      await page.click("text=Open constant");
    },
    async "a layer of the gallery"() {
      await page.click("#open-gallery");
      const scene = page.locator(".scene", { hasText: "Open constant" });
      await scene.locator("summary").click();
      await scene.locator("text=Take over").first().click();
      await page.click("#gallery >> text=Close");
    },
    async "a layer that the mode Edit adds"() {
      await page.getByRole("button", { name: "Edit", exact: true }).click();
      await page.getByRole("button", { name: "Add stripes", exact: true }).click();
    },
  };
  for (const [how, open] of Object.entries(foreign)) {
    await pressArm();
    const from = board.events.length;
    await open();
    await board.assertDisarmed(from, how);
  }
});

test("a press on Arm while a scene from elsewhere opens arms nothing", async () => {
  const from = await ready();
  await page.click("#open-gallery");
  const button = page.locator("text=Open constant");
  await button.waitFor();
  const refused = await button.evaluate((open) => {
    open.click();
    document.getElementById("arm").click();
    return studioPage.engine.arm().catch((error) => error.message);
  });
  assert.match(refused, /no scene is on the board/);
  await armable(page);
  await assertStaysDisarmed(from);
});

test("a scene that is not on the board leaves no other one to arm", async () => {
  await write(page, CONSTANT);
  await armable(page);
  await write(page, MISTAKEN);
  await checkSays(page, "1 mistake");
  assert.ok(await page.isDisabled("#arm"), "a mistake of one's own");
  const from = await ready();
  await openLink(page, MISTAKEN);
  await checkSays(page, "1 mistake");
  await assertNotArmable(from);
  for (const [text, sentence] of [
    [FOUR_LAYERS, /4 layers, but the board supports 3/],
    [CONSTANT.replace(/friction_(\w+) = .*/, "friction_n = 9"), /does not play this draft/],
  ]) {
    await write(page, text);
    await checkSays(page, "not on the board");
    assert.match(await page.textContent("#notice"), sentence);
    assert.ok(await page.locator("#arm").isHidden());
  }

  await pressArm();
  await write(page, FOUR_LAYERS);
  await checkSays(page, "the board refuses it; the one before plays");
  const stopped = board.events.length;
  await page.click("#stop");
  await board.assertDisarmed(stopped, "the stop button");
  await checkSays(page, "not on the board");
  await assertNotArmable(board.events.length);
});

test("a hidden page disarms the board, which waits for a press when the page is back", async () => {
  await pressArm();
  const from = board.events.length;
  await setVisibility(page, "hidden");
  await board.assertDisarmed(from, "hiding");
  await setVisibility(page, "visible");
  await board.assertDisarmed(from, "coming back");
});

/** The board fell silent: it was disarmed by its own host timeout, and stays so. */
async function assertSilent() {
  await board.until("silent", ({ isSilent }) => isSilent);
  await boardTime(500);
  const { state, isDriving } = board.events.at(-1).board;
  assert.deepEqual([state, isDriving], ["disarmed", false]);
}

test("a page that hangs leaves the board to its host timeout, and it waits for a press", async () => {
  await pressArm();
  await page.evaluate(() => {
    const begin = performance.now();
    while (performance.now() - begin < 7000);
  });
  await assertSilent();
});

test("a fault is shown, and cleared by a press", async () => {
  await pressArm();
  board.fail();
  await page.waitForFunction(() => /faulted, .*amplifier/.test(document.getElementById("board").textContent));
  await board.until("faulted", ({ state, isDriving }) => state === "faulted" && !isDriving);
  await page.click("#clear-fault");
  await board.until("cleared", stateOf.disarmed);
  await armable(page);
});

test("while a hand changes a layer nothing can be armed, and the press after it arms what it made", async () => {
  const from = await ready();
  await page.getByRole("button", { name: "Edit", exact: true }).click();
  await page.locator(".layer-box").focus();
  const { x, y, width, height } = await page.locator(".layer-handle[data-side=se]").boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x - 20, y - 20, { steps: 3 });
  // The texts of the hand are checked and drawn, and wait for it.
  await page.waitForFunction(() => document.getElementById("check").textContent === "loading…");
  await assertStaysDisarmed(from);
  assert.equal(await page.locator("#arm:not([hidden]):enabled").count(), 0, "Arm can be pressed");
  await page.mouse.up();
  await page.getByRole("button", { name: "Feel", exact: true }).click();
  await armable(page);
  await assertStaysDisarmed(from);
  assert.match(await page.evaluate(() => studioPage.editor.text), /region = \{ x_mm = 0, y_mm = 0, width_mm = \d/);
  await page.click("#arm");
  await board.until("driving", stateOf.driving);
  await page.click("#stop");
  await board.until("disarmed", stateOf.disarmed);
});

test("a press where Arm has only just appeared arms nothing", async () => {
  await pressArm();
  await page.locator("#arm").waitFor({ state: "hidden" });
  const from = board.events.length;
  const enabledMs = await page.evaluate(async () => {
    const arm = document.getElementById("arm");
    document.getElementById("stop").click();
    while (arm.hidden) await new Promise((resolve) => requestAnimationFrame(resolve));
    const begin = performance.now();
    arm.click();
    while (arm.disabled) await new Promise((resolve) => setTimeout(resolve, 5));
    return performance.now() - begin;
  });
  assert.ok(enabledMs > 700, `Arm can be pressed ${enabledMs} ms after it has appeared`);
  await board.assertDisarmed(from, "the stop");
});

test("a stop during an upload leaves the scene that is shown to be armed, with its layers", async () => {
  await pressArm();
  const brick = await page.evaluate(() => studio.text("scenes/brick.toml"));
  const check = await page.evaluate(async (text) => {
    const { player, editor } = studioPage;
    const show = player.onMap;
    player.onMap = (map, check) => {
      show(map, check);
      globalThis.mapped = check.layers.map(({ name }) => name);
    };
    const bytes = () => serialPort.sent.reduce((sum, { length }) => sum + length, 0);
    const before = bytes();
    editor.text = text;
    while (bytes() < before + 3_000) await new Promise((resolve) => setTimeout(resolve, 1));
    document.getElementById("stop").click();
    return document.getElementById("check").textContent;
  }, brick);
  assert.equal(check, "loading…");
  // By the stop, or already by its host timeout while the scene was compiled.
  await board.until("disarmed", stateOf.disarmed);
  const from = board.events.length;
  await armable(page);
  assert.match(await page.textContent("#panel-layers"), /brick/);
  await page.waitForFunction(() => globalThis.mapped?.includes("brick"), null, { timeout: 40_000 });
  await assertStaysDisarmed(from);
  await page.click("#arm");
  await board.until("armed", stateOf.active);
  const refused = await page.evaluate(() =>
    studioPage.engine.control('layer "brick" off').catch((error) => error.message),
  );
  assert.match(refused, /layer "brick" may be merged/, "what is armed is the scene that is shown");
  const stopped = board.events.length;
  await page.click("#stop");
  await board.assertDisarmed(stopped, "the stop button");
});

test("a page that is closed leaves no board armed", async () => {
  await pressArm();
  await page.context().close();
  await board.until("disarmed", stateOf.disarmed);
});

test("leaving a board disarms it, however late the bytes come that do", async () => {
  const { page, board } = await connected(() => {
    globalThis.portDelayMs = 0;
    const { get, set } = Object.getOwnPropertyDescriptor(MessagePort.prototype, "onmessage");
    Object.defineProperty(MessagePort.prototype, "onmessage", {
      get,
      set(take) {
        set.call(this, (event) => (portDelayMs > 0 ? setTimeout(take, portDelayMs, event) : take(event)));
      },
    });
  });
  await page.click("#arm");
  await board.until("driving", stateOf.driving);
  const from = board.events.length;
  await page.click("#open-board");
  await page.evaluate(() => (globalThis.portDelayMs = 50));
  await page.click("#board-dialog >> text=Simulator");
  await board.assertDisarmed(from, "leaving");
});
