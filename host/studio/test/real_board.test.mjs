// A board with an electrode: what it takes to arm it, and what disarms it.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { deflateRawSync } from "node:zlib";
import { addSerialPort, cleanUp, CONSTANT, openPage, setVisibility, startRealBoard, stateOf } from "./harness.mjs";

const FOUR_LAYERS = CONSTANT + '[[layer]]\nkind = "constant"\nabove = "natural"\nfriction_n = 0.01\n'.repeat(3);
const AUTONOMOUS = CONSTANT.replace("host_timeout_ms = 1000", "autonomous = true");

after(cleanUp);

/** The page with a board that is connected and has this scene, as a person does it. */
async function connected() {
  const board = await startRealBoard();
  const opened = await openPage();
  const { page } = opened;
  await page.waitForFunction(() => globalThis.studioPage && document.getElementById("check").textContent === "plays");
  await addSerialPort(page, board.terminal);
  await page.evaluate((text) => (studioPage.editor.text = text), CONSTANT);
  await page.waitForFunction(() => document.getElementById("check").textContent === "plays");
  await page.click("#open-board");
  await page.click("text=Board on a USB port");
  await page.locator("#arm:not([hidden])").waitFor({ timeout: 40_000 });
  return { ...opened, board };
}

/** One page with one board for all tests: each of them begins by arming it, and leaves it disarmed. */
let page, board, errors, close;
before(async () => {
  ({ page, board, errors, close } = await connected());
});

async function pressArm() {
  const said = async () => (await page.locator("#board, #notice").allTextContents()).join("; ");
  const arm = page.locator("#arm:not([hidden])");
  await arm.click({ timeout: 10_000 }).catch(async () => assert.fail(`no press to arm: ${await said()}`));
  await board.until("armed", stateOf.active);
  await board.until("driving", stateOf.driving);
}

test("a board with an electrode waits for a press, and foreign scenes disarm it", async () => {
  assert.match(await page.textContent("#arm"), /drive NUCLEO-G474RE with an electrode, up to 220 V peak/);
  const canArm = await page.evaluate((text) => {
    studioPage.editor.text = text;
    return !document.getElementById("arm").disabled;
  }, CONSTANT.replace("0.11", "0.1"));
  assert.ok(!canArm, "what is armed is the scene that is shown");
  await new Promise((resolve) => setTimeout(resolve, 500));
  assert.ok(board.events.every((event) => stateOf.disarmed(event.board)), "nothing arms it but the press");

  const link = deflateRawSync(JSON.stringify({ name: "foreign", text: CONSTANT, files: {} })).toString("base64url");
  const foreign = {
    "the stop button": () => page.click("#stop"),
    "a link in the fragment": () => page.evaluate((hash) => (location.hash = hash), `scene=${link}`),
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
  };
  for (const [how, open] of Object.entries(foreign)) {
    await pressArm();
    const from = board.events.length;
    await open();
    await board.assertDisarmed(from, how);
  }
  await page.evaluate((text) => (studioPage.editor.text = text), CONSTANT);
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
  await new Promise((resolve) => setTimeout(resolve, 500));
  const { state, isDriving } = board.events.at(-1).board;
  assert.deepEqual([state, isDriving], ["disarmed", false]);
}

test("a page that hangs leaves the board to its host timeout, and it waits for a press", async () => {
  await pressArm();
  await page.evaluate(() => {
    const begin = performance.now();
    while (performance.now() - begin < 1500);
  });
  await assertSilent();
});

test("a fault is shown, and cleared by a press", async () => {
  await pressArm();
  board.fail();
  await page.waitForFunction(() => /faulted, .*amplifier/.test(document.getElementById("board").textContent));
  assert.equal(await page.textContent("#arm"), "Clear the fault");
  await board.until("faulted", ({ state, isDriving }) => state === "faulted" && !isDriving);
  await page.click("#arm");
  await board.until("cleared", stateOf.disarmed);
  await page.locator("#arm", { hasText: "Arm: drive" }).waitFor();
});

test("a scene for another board and one that plays without its host are refused, and cannot be armed", async () => {
  await board.until("disarmed", stateOf.disarmed);
  const from = board.events.length;
  for (const [text, sentence] of [
    [FOUR_LAYERS, /4 layers, and the board takes 3/],
    [AUTONOMOUS, /plays without its host/],
    [CONSTANT.replace(/friction_(\w+) = .*/, "friction_n = 9"), /does not play this draft/],
  ]) {
    await page.evaluate((text) => (studioPage.editor.text = text), text);
    await page.waitForFunction(
      (source) => new RegExp(source).test(document.querySelector("#notice:not([hidden])")?.textContent),
      sentence.source,
    );
    assert.ok(await page.locator("#arm").isHidden());
    await page.evaluate((text) => (studioPage.editor.text = text), CONSTANT);
    await page.locator("#arm:not([hidden])").waitFor();
  }
  assert.ok(board.events.slice(from).every((event) => stateOf.disarmed(event.board)));
});

test("a page that is closed leaves no board armed", async () => {
  await pressArm();
  assert.deepEqual(errors, []);
  await close();
  await board.until("disarmed", stateOf.disarmed);
});
