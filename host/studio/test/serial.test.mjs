// A board outside of the page: a native `frixel sim` behind a `navigator.serial` made of byte streams.

import assert from "node:assert/strict";
import path from "node:path";
import { after, test } from "node:test";
import { addSerialPort, cleanUp, openEngine, rowsOf, startStudio, startVirtualBoard } from "./harness.mjs";

/** Host timeout of the bundled scenes, s. */
const HOST_TIMEOUT_S = 0.25;

after(cleanUp);

async function playOnVirtualBoard(scene) {
  const board = await startVirtualBoard();
  const opened = await openEngine();
  await addSerialPort(opened.page, board.terminal);
  await opened.page.evaluate(async (name) => {
    await tested.connectSerial(await navigator.serial.requestPort());
    await tested.play(await sceneFiles(name), name, {});
  }, scene);
  return { ...opened, board };
}

/** Waits until the board has noticed the silence of its host, in its own time. */
async function silenceOf(board) {
  const isSilent = () => rowsOf(path.join(board.out, "events.csv")).some((row) => row.event === "host-silent");
  for (let tries = 0; tries < 200 && !isSilent(); tries += 1) await new Promise((resolve) => setTimeout(resolve, 50));
}

test("a scene is played, changed and stopped on a board at a serial port", async () => {
  const { page, board, errors, close } = await playOnVirtualBoard("keyboard.toml");
  await page.waitForFunction(() => felt.filter((frame) => !frame.simulated).length > 30, null, { timeout: 40_000 });
  const seen = await page.evaluate(() => ({ frame: felt.at(-1), states: states.map((state) => state.state), link: states.at(-1) }));
  assert.equal(seen.frame.simulated, false);
  assert.ok(seen.states.includes("active"), seen.states.join());
  assert.equal(seen.link.link, "serial");
  assert.equal(seen.link.needsArm, false, "a simulated board needs no press");
  const refused = await page.evaluate(() => tested.control('layer "nothing" off').catch((error) => error.message));
  assert.match(refused, /the scene has no layer "nothing"/);
  const mistake = await page.evaluate(() =>
    tested.play({ "a.toml": "version = 2\n[[layer]]\nkind = \"gratin\"\n" }, "a.toml", {}).catch((error) => error.problems),
  );
  assert.equal(mistake[0].line, 3);
  const state = await page.evaluate(() => states.at(-1).state);
  assert.equal(state, "active", "the scene before plays on");
  await page.evaluate(() => tested.simulate());
  await board.stop();
  assert.deepEqual(errors, []);
  const events = rowsOf(path.join(board.out, "events.csv")).map((row) => row.event);
  assert.deepEqual(events, ["armed", "active", "armed", "disarmed"], "leaving stops and disarms");
  const rows = rowsOf(path.join(board.out, "felt.csv"));
  assert.ok(rows.some((row) => Number(row.voltage_v_rms) > 1));
  await close();
});

test("a killed worker: the board is at zero within its host timeout", async () => {
  const { page, board, close } = await playOnVirtualBoard("constant.toml");
  await page.waitForFunction(() => felt.some((frame) => frame.voltageV.some((voltage) => voltage > 1)), null, { timeout: 40_000 });
  await page.evaluate(() => workersOfPage.host.forEach((worker) => worker.terminate()));
  await silenceOf(board);
  await board.stop();
  const events = rowsOf(path.join(board.out, "events.csv"));
  const silent = events.find((row) => row.event === "host-silent");
  assert.ok(silent, JSON.stringify(events));
  const silence_s = Number(silent.t_s) - Number(silent.last_frame_t_s);
  assert.ok(silence_s <= HOST_TIMEOUT_S + 1e-3, `${silence_s} s`);
  const driven = rowsOf(path.join(board.out, "felt.csv")).filter((row) => Math.abs(Number(row.voltage_v_rms)) > 1);
  const last = Number(driven.at(-1).t_s);
  assert.ok(last <= Number(silent.t_s) + 1e-3, `driven at ${last} s, silent at ${silent.t_s} s`);
  await close();
});

test("the page of `frixel studio` plays, and reaches a board through the bridge", async () => {
  const board = await startVirtualBoard();
  const { page, errors, close } = await openEngine(await startStudio(board.terminal));
  await page.waitForFunction(() => document.documentElement.dataset.state === "active", null, { timeout: 10_000 });
  await page.evaluate(async (name) => {
    const { bridgeUrl } = await import(await studio.moduleUrl("engine/lines.js"));
    await tested.connectSocket(bridgeUrl());
    await tested.play(await sceneFiles(name), name, {});
  }, "constant.toml");
  await page.waitForFunction(() => felt.some((frame) => !frame.simulated), null, { timeout: 40_000 });
  await page.waitForFunction(() => states.at(-1).state === "active", null, { timeout: 10_000 });
  assert.equal(await page.evaluate(() => states.at(-1).link), "socket");
  assert.deepEqual(errors, []);
  await close();
  await silenceOf(board);
  await board.stop();
  const events = rowsOf(path.join(board.out, "events.csv")).map((row) => row.event);
  assert.deepEqual(events.slice(0, 2), ["armed", "active"]);
  assert.equal(events.at(-1), "host-silent", "a page that is closed leaves the board to its host timeout");
});
