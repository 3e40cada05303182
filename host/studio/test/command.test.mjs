// The page beside the command: `frixel sim` behind a `navigator.serial` made of byte streams. Only these tests are told
// where the command is.

import assert from "node:assert/strict";
import path from "node:path";
import { test } from "node:test";
import { addSerialPort, openOnlyEngine, rowsOf, startVirtualBoard, WAIT_MAX_MS } from "./harness.mjs";

/** The longest host timeout: a machine that is held up for less does not disarm the board. */
const HOST_TIMEOUT_MS = 1000;

async function playOnVirtualBoard(scene) {
  const board = await startVirtualBoard();
  const page = await openOnlyEngine();
  await addSerialPort(page, board.terminal);
  await page.evaluate(
    async ([name, hostTimeoutMs]) => {
      await tested.connectSerial(serialPort);
      const files = await sceneFiles(name);
      files[name] += `\n[drive]\nhost_timeout_ms = ${hostTimeoutMs}\n`;
      await tested.play(files, name, {});
      await tested.arm();
    },
    [scene, HOST_TIMEOUT_MS],
  );
  return { page, board };
}

/** What happened on the board, without the time that a busy machine makes it drop. */
const eventsOf = (board) =>
  rowsOf(path.join(board.out, "events.csv")).filter(({ event }) => event !== "time-dropped");
const silencesOf = (board) => eventsOf(board).filter((row) => row.event === "host-silent");

/** Does `silence`, and waits until the board has noticed the silence of its host, in its own time. */
async function silenceAfter(board, silence) {
  const before = silencesOf(board).length;
  await silence();
  const begin = performance.now();
  while (silencesOf(board).length === before) {
    assert.ok(performance.now() < begin + WAIT_MAX_MS, `no silence: ${JSON.stringify(eventsOf(board))}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

test("a scene is played, changed and stopped on a board at a serial port", async () => {
  const { page, board } = await playOnVirtualBoard("keyboard.toml");
  await page.waitForFunction(() => felt.filter((frame) => !frame.simulated).length > 30);
  await page.waitForFunction(() => states.at(-1).state === "active");
  // The simulated finger reaches a key.
  await page.waitForFunction(() => felt.some((frame) => frame.voltageV.some((voltage) => voltage > 1)));
  const seen = await page.evaluate(() => ({ frame: felt.at(-1), link: states.at(-1) }));
  assert.equal(seen.frame.simulated, false);
  assert.equal(seen.link.link, "serial");
  assert.equal(seen.link.needsArm, false, "it is armed");
  const refused = await page.evaluate(() => tested.control('layer "nothing" off').catch((error) => error.message));
  assert.match(refused, /the scene has no layer "nothing"/);
  const mistake = await page.evaluate(
    (text) => tested.play({ "a.toml": text }, "a.toml", {}).catch((error) => error.problems),
    'version = 1\n[[layer]]\nkind = "gratin"\n',
  );
  assert.equal(mistake[0].line, 3);
  // The scene before plays on.
  const frames = await page.evaluate(() => felt.length);
  await page.waitForFunction((frames) => felt.length > frames + 10 && felt.at(-1).state === "active", frames);
  await page.evaluate(() => tested.simulate());
  await board.stop();
  const events = eventsOf(board).map((row) => row.event);
  assert.deepEqual(events, ["armed", "active", "armed", "disarmed"], "leaving stops and disarms");
  const rows = rowsOf(path.join(board.out, "felt.csv"));
  assert.ok(rows.some((row) => Number(row.voltage_v_rms) > 1));
});

test("a killed worker: the board is at zero within its host timeout", async () => {
  const { page, board } = await playOnVirtualBoard("constant.toml");
  await page.waitForFunction(() => felt.some((frame) => frame.voltageV.some((voltage) => voltage > 1)));
  const kill = () => {
    for (const worker of workersOfPage.host) worker.terminate();
  };
  await silenceAfter(board, () => page.evaluate(kill));
  await board.stop();
  const silent = silencesOf(board).at(-1);
  const silence_s = Number(silent.t_s) - Number(silent.last_frame_t_s);
  assert.ok(silence_s <= HOST_TIMEOUT_MS / 1000 + 1e-3, `${silence_s} s`);
  const driven = rowsOf(path.join(board.out, "felt.csv")).filter((row) => Math.abs(Number(row.voltage_v_rms)) > 1);
  const last = Number(driven.at(-1).t_s);
  assert.ok(last <= Number(silent.t_s) + 1e-3, `driven at ${last} s, silent at ${silent.t_s} s`);
});
