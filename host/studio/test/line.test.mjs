// The line to a board with an electrode: a stop, the silence of a page, and a lost line, whatever is under way.

import assert from "node:assert/strict";
import { after, test } from "node:test";
import {
  addSerialPort, cleanUp, CONSTANT, openEngine, setVisibility, startRealBoard, startStudio, stateOf,
} from "./harness.mjs";

/** The default host timeout, within which a stop acts on a slow line, too, ms. */
const HOST_TIMEOUT_MS = 250;
/** The board hears and reports in steps of a few ms, on a machine that the tests share, ms. */
const SHARED_MS = 100;
/** A slow line, bits a second: the picture of brick.toml takes seconds. */
const SLOW_BAUD = 230_400;
/** A command without an answer is sent again after this time, ms. */
const REPEAT_MS = 250;
/** A frame of a command is no longer than this, bytes. */
const COMMAND_MAX = 32;

after(cleanUp);

/** An engine. That of the page itself ends, so that the machine has time for this one. */
async function openOnlyEngine(url) {
  const opened = await openEngine(url);
  await opened.page.waitForFunction(() => globalThis.studioPage);
  await opened.page.evaluate(() => studioPage.engine.close());
  return opened;
}

/** An engine with the port of a board. */
async function withPort(board) {
  const opened = await openOnlyEngine();
  await addSerialPort(opened.page, board.terminal);
  return opened;
}

/** Connects, plays and arms, and waits until the board drives. */
async function drive(page, board) {
  await page.evaluate(async (text) => {
    await tested.connectSerial(serialPort);
    await tested.play({ "a.toml": text }, "a.toml", {});
    await tested.arm();
  }, CONSTANT);
  await board.until("driving", stateOf.driving);
}

/** An engine with a board on a slow line that plays, and an upload to it that is under way. */
async function uploading() {
  const board = await startRealBoard({ baud: SLOW_BAUD });
  const opened = await withPort(board);
  await drive(opened.page, board);
  await opened.page.evaluate(async () => {
    const bytes = () => serialPort.sent.reduce((sum, { length }) => sum + length, 0);
    const before = bytes();
    let isOver = false;
    globalThis.upload = tested
      .play(await sceneFiles("brick.toml"), "brick.toml", {})
      .catch((error) => error.message)
      .finally(() => (isOver = true));
    while (bytes() < before + 10_000 && !isOver) await new Promise((resolve) => setTimeout(resolve, 5));
    if (isOver) throw new Error(await upload);
  });
  return { ...opened, board };
}

test("a stop does not wait for an upload, and nothing but the disarm is sent", async () => {
  const { page, board, close } = await uploading();
  const from = board.events.length;
  const { sent, ms, outcome } = await page.evaluate(async () => {
    const begin = performance.now();
    await tested.stop();
    const ms = performance.now() - begin;
    const sent = serialPort.sent.filter((write) => write.ms >= begin && write.ms <= begin + ms);
    return { sent, ms, outcome: await upload };
  });
  assert.match(outcome, /stopped/);
  assert.ok(ms <= HOST_TIMEOUT_MS + SHARED_MS, `${ms} ms`);
  // Once the board has answered, the host pings again.
  const frames = 2 + Math.floor(ms / REPEAT_MS);
  const isCommand = ({ length }) => length <= COMMAND_MAX;
  assert.ok(sent.length <= frames && sent.every(isCommand), `after the stop: ${JSON.stringify(sent)}`);
  await board.assertDisarmed(from, "the stop");
  const refused = await page.evaluate(() => tested.arm().catch((error) => error.message));
  assert.match(refused, /no scene is on the board/, "the scene before cannot be armed");
  await close();
});

test("during an upload, a hidden page disarms the board, and one without frames leaves it to its timeout", async () => {
  for (const [silence, expected] of [
    ["hidden", false],
    ["without frames", true],
  ]) {
    const { page, board, close } = await uploading();
    if (silence === "hidden") await setVisibility(page, "hidden");
    else await page.evaluate(() => void (globalThis.requestAnimationFrame = () => {}));
    const { board: found } = await board.until(`disarmed when ${silence}`, stateOf.disarmed);
    assert.equal(found.isSilent, expected, silence);
    await close();
  }
});

test("a stop during the compilation of a scene disarms the board", async () => {
  const board = await startRealBoard();
  const { page, close } = await withPort(board);
  await drive(page, board);
  const outcome = await page.evaluate(async () => {
    const playing = tested.play(await sceneFiles("brick.toml"), "brick.toml", {}).catch((error) => error.message);
    await tested.stop();
    return playing;
  });
  assert.match(outcome, /stopped/);
  await board.until("disarmed", stateOf.disarmed);
  await close();
});

test("a port can be connected again after a failed connection and after a lost line", async () => {
  const board = await startRealBoard();
  const { page, errors, close } = await withPort(board);
  const connect = () => page.evaluate(() => tested.connectSerial(serialPort).catch((error) => error.message));
  const play = () => page.evaluate((text) => tested.play({ "a.toml": text }, "a.toml", {}), CONSTANT);
  const isOpen = () => page.evaluate(() => serialPort.readable !== null);
  board.hang(true);
  assert.match(await connect(), /no frixel board answered/);
  assert.ok(!(await isOpen()), "the port is closed");
  assert.match(await connect(), /no frixel board answered/, "and can be opened again");
  board.hang(false);
  assert.equal(await connect(), undefined);
  await play();
  await page.evaluate(() => tested.arm());
  await board.until("driving", stateOf.driving);
  await page.evaluate(() => serialPort.pull());
  await page.waitForFunction(() => states.at(-1).link === "none");
  assert.match(await page.evaluate(() => states.at(-1).fault), /vanished|closed/);
  assert.match(await page.evaluate(() => tested.control('layer 1 off').catch((error) => error.message)), /no board/);
  await page.evaluate(() => tested.stop());
  await board.until("disarmed", stateOf.disarmed);

  assert.equal(await connect(), undefined, "connected again");
  await play();
  await page.evaluate(() => tested.arm());
  await board.until("armed", stateOf.active);
  assert.equal(await connect(), undefined, "connecting again disarms");
  await board.until("disarmed", stateOf.disarmed);
  await page.evaluate(() => tested.simulate());
  assert.ok(!(await isOpen()));
  assert.deepEqual(errors, []);
  await close();
});

test("the bridge can be connected again after a failed connection and after a board that fell silent", async () => {
  const board = await startRealBoard();
  const { page, close } = await openOnlyEngine(await startStudio(board.terminal));
  const connect = () =>
    page.evaluate(async () => {
      const { bridgeUrl } = await import(await studio.moduleUrl("engine/lines.js"));
      return tested.connectSocket(bridgeUrl()).catch((error) => error.message);
    });
  board.hang(true);
  assert.match(await connect(), /no frixel board answered/);
  board.hang(false);
  assert.equal(await connect(), undefined);
  await page.evaluate(async (text) => {
    await tested.play({ "a.toml": text }, "a.toml", {});
    await tested.arm();
  }, CONSTANT);
  await board.until("driving", stateOf.driving);
  board.hang(true);
  await page.waitForFunction(() => states.at(-1).link === "none");
  assert.match(await page.evaluate(() => states.at(-1).fault), /not answered/);
  board.hang(false);
  await board.until("disarmed", stateOf.disarmed);
  assert.equal(await connect(), undefined, "connected again");
  await close();
});
