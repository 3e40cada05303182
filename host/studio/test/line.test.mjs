// The line to a board with an electrode: a stop, the silence of a page, and a lost line, whatever is under way.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  addSerialPort, boardTime, CONSTANT, openOnlyEngine, setVisibility, startRealBoard, stateOf,
} from "./harness.mjs";
import { answeredIn, framesIn, requestIn } from "./wire.mjs";

/** A slow line, bits a second of the board's time: the picture of brick.toml takes seconds. */
const SLOW_BAUD = 921_600;
/** A command without an answer is sent again after this time, ms. */
const REPEAT_MS = 250;

/** An engine with the port of a board. */
async function withPort(board) {
  const page = await openOnlyEngine();
  await addSerialPort(page, board.terminal);
  return page;
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

/**
 * An engine with a board on a slow line that plays; `from` counts the events of the board until then. Once an upload to
 * it is under way, `act` happens: `{ ms, first, sent, arrived, outcome }` are the time that it took, the number of the
 * first piece that was written since, what went over the line, and how the upload ended.
 */
async function duringUpload(act) {
  const board = await startRealBoard({ baud: SLOW_BAUD });
  const page = await withPort(board);
  await drive(page, board);
  const from = board.events.length;
  const found = await page.evaluate(async (act) => {
    const acts = {
      stop: () => tested.stop(),
      hidden: () => setVisibility("hidden"),
      "without frames"() {
        globalThis.requestAnimationFrame = () => {};
      },
    };
    const { sent, arrived } = serialPort;
    const bytes = () => sent.reduce((sum, piece) => sum + piece.length, 0);
    const before = bytes();
    let isOver = false;
    const upload = tested
      .play(await sceneFiles("brick.toml"), "brick.toml", {})
      .catch((error) => error.message)
      .finally(() => (isOver = true));
    while (bytes() < before + 10_000 && !isOver) await new Promise((resolve) => setTimeout(resolve, 5));
    if (isOver) throw new Error(await upload);
    const [begin, first] = [performance.now(), sent.length];
    await acts[act]();
    const ms = performance.now() - begin;
    const outcome = act === "stop" ? await upload : undefined;
    return { ms, first, sent: [...sent], arrived: [...arrived], outcome };
  }, act);
  return { page, board, from, ...found };
}

/** From the first frame on that disarms the board, nothing else is sent until the board has answered it. */
function assertOnlyDisarmed({ ms, first, sent, arrived }) {
  const requests = framesIn(sent).map(({ payload, piece }) => ({ ...requestIn(payload), piece }));
  // Frames that the worker had sent before it took the stop may be written after it was called.
  const disarm = requests.findIndex(({ name, piece }) => piece >= first && name === "disarm");
  assert.ok(disarm >= 0, "the disarm is sent");
  const sequences = requests.filter(({ name }) => name === "disarm").map(({ sequence }) => sequence);
  const answers = framesIn(arrived.map(({ bytes }) => bytes));
  const answer = answers.find(({ payload, piece }) => {
    return arrived[piece].sentBefore > requests[disarm].piece && sequences.includes(answeredIn(payload));
  });
  assert.ok(answer, "the disarm is answered");
  const { sentBefore } = arrived[answer.piece];
  const [before, later] = [requests.slice(disarm), []];
  while (before.length > 0 && before.at(-1).piece >= sentBefore) later.unshift(before.pop());
  const found = `after the stop: ${JSON.stringify({ ms, before, later })}`;
  assert.ok(before.every(({ name }) => name === "disarm"), found);
  assert.ok(before.length <= 1 + Math.floor(ms / REPEAT_MS), found);
  assert.ok(later.every(({ name }) => name === "disarm" || name === "ping"), found);
}

test("a stop does not wait for an upload, and nothing but the disarm is sent", async (context) => {
  const { page, board, from, ...stopped } = await duringUpload("stop");
  assert.match(stopped.outcome, /stopped/);
  assertOnlyDisarmed(stopped);
  await board.assertDisarmed(from, "the stop");
  context.diagnostic(`${stopped.ms.toFixed(0)} ms`);
  const refused = await page.evaluate(() => tested.arm().catch((error) => error.message));
  assert.match(refused, /no scene is on the board/, "the scene before cannot be armed");
});

test("during an upload, a hidden page disarms the board", async () => {
  const { board, from } = await duringUpload("hidden");
  await board.assertDisarmed(from, "hiding");
});

test("during an upload, a page without frames leaves the board to its host timeout", async () => {
  const { page, board } = await duringUpload("without frames");
  const { board: found } = await board.until("disarmed without frames", stateOf.disarmed);
  assert.ok(found.isSilent);
  const sent = () => page.evaluate(() => serialPort.sent.length);
  const before = await sent();
  await boardTime(300);
  assert.equal(await sent(), before, "the host stays silent");
});

test("a port can be connected again after a failed connection and after a lost line", async () => {
  const board = await startRealBoard();
  const page = await withPort(board);
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
  await page.waitForFunction(() => felt.some(({ simulated, voltageV }) => !simulated && voltageV.some((volts) => volts > 1)));
  await page.evaluate(() => serialPort.pull());
  await page.waitForFunction(() => states.at(-1).link === "none");
  assert.match(await page.evaluate(() => states.at(-1).fault), /^the port vanished \(the other end closed it\)/);
  assert.match(await page.evaluate(() => tested.control('layer 1 off').catch((error) => error.message)), /no board/);
  await page.evaluate(() => tested.stop());
  await board.until("disarmed", stateOf.disarmed);

  assert.equal(await connect(), undefined, "connected again");
  await play();
  await page.evaluate(() => tested.arm());
  await board.until("armed", stateOf.active);
  const from = board.events.length;
  assert.equal(await connect(), undefined);
  await board.assertDisarmed(from, "connecting again");
  await page.evaluate(() => tested.simulate());
  assert.ok(!(await isOpen()));
});
