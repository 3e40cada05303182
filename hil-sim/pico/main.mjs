// The Pico board's image on rp2040js, driven by `frixel-hil-sim` over standard input and output (protocol.mjs).
//
//   node main.mjs IMAGE.elf
//
// Time passes only while a request runs, so nothing here waits for anything but the next request.

import { readFileSync, readSync, writeSync } from "node:fs";

import { Board, factoryNew } from "./board.mjs";
import { Image } from "./loader.mjs";
import { CAUSE, ENDED, INPUT, REQUEST } from "./protocol.mjs";

const STDIN = 0;
const STDOUT = 1;

/** Reads so many bytes; `undefined` at the end of the input. @param {number} count */
function readExactly(count) {
  const bytes = new Uint8Array(count);
  let filled = 0;
  while (filled < count) {
    const read = readSync(STDIN, bytes, filled, count - filled, null);
    if (read === 0) {
      return undefined;
    }
    filled += read;
  }
  return new DataView(bytes.buffer);
}

function readRequest() {
  const len = readExactly(4)?.getUint32(0, true);
  const view = len === undefined ? undefined : readExactly(4 * len);
  return view && Array.from({ length: view.byteLength / 4 }, (_, index) => view.getUint32(4 * index, true));
}

/** @param {number[]} words */
function answer(words) {
  const message = Uint32Array.of(words.length, ...words);
  const bytes = new Uint8Array(message.buffer);
  let written = 0;
  while (written < bytes.length) {
    written += writeSync(STDOUT, bytes, written);
  }
}

/** What RAM holds after the power was off: anything. @param {number} seed */
function scrambler(seed) {
  let state = seed >>> 0 || 1;
  return (/** @type {Uint8Array} */ sram) => {
    for (let index = 0; index < sram.length; index += 1) {
      // xorshift32
      state ^= state << 13;
      state ^= state >>> 17;
      state ^= state << 5;
      sram[index] = state;
    }
  };
}

class Rig {
  #image;
  #board;
  #powerCuts = 0;

  /** @param {Image} image */
  constructor(image) {
    this.#image = image;
    this.#board = new Board(image, factoryNew(image), CAUSE.POWER);
  }

  /** @param {number[]} request */
  serve([kind, ...values]) {
    switch (kind) {
      case REQUEST.RUN:
        return this.#run(values);
      case REQUEST.POWER_CYCLE:
        return this.#start(CAUSE.POWER, values[0]);
      case REQUEST.RUN_PIN:
        return this.#start(CAUSE.RUN_PIN);
      case REQUEST.HANG:
        this.#board.hang();
        return [];
      case REQUEST.HANG_MAIN_LOOP:
        this.#board.hangMainLoop();
        return [];
      case REQUEST.JUMP:
        this.#board.jump(values[0]);
        return [];
      case REQUEST.ADDRESS_OF:
        return [this.#image.addressOf(String.fromCharCode(...values)) ?? 0];
      case REQUEST.STOP_CRYSTAL:
        this.#board.stopCrystal();
        return [];
      case REQUEST.STOP_PIO:
        this.#board.stopPio(values[0]);
        return [];
      case REQUEST.WRITE_FLASH:
        this.#board.writeFlash(values[0], values.slice(1));
        return [];
      case REQUEST.WATCH:
        this.#board.watch(values[0], values[1]);
        return [];
      case REQUEST.TAKE_CALLS:
        return this.#board.takeCalls();
      case REQUEST.ANSWER_I2C:
        this.#board.answerI2c(values[0]);
        return [];
      default:
        throw new Error(`unknown request ${kind}`);
    }
  }

  /** Starts the board anew, `elapsed` ns after the beginning of the run. */
  #start(cause, seed = 0, elapsed = 0) {
    const { events } = this.#board;
    this.#board = new Board(this.#image, this.#board.remains(cause, scrambler(seed)), cause, elapsed);
    this.#board.events.unshift(...events);
    return [];
  }

  #run([nanos, instructionsMax, inputs, monitorCode, shiftingOut, ...bytes]) {
    const board = this.#board;
    const has = (input) => (inputs & input) !== 0;
    board.drive({
      ready: has(INPUT.READY),
      arm: has(INPUT.ARM),
      frameReady: has(INPUT.FRAME_READY),
      sdaIsHeld: has(INPUT.SDA_HELD),
      sclIsHeld: has(INPUT.SCL_HELD),
      monitorCode,
      shiftingOut,
      bytes,
    });
    const begin = board.nanos;
    const instructions = board.instructions;
    const ended = board.run(nanos, instructionsMax || Number.MAX_SAFE_INTEGER);
    const elapsed = Math.round(board.nanos - begin);
    const received = board.takeReceived();
    if (ended === ENDED.RESET && board.cause !== undefined) {
      this.#powerCuts += 1;
      this.#start(board.cause, this.#powerCuts, elapsed);
    }
    const { events } = this.#board;
    this.#board.events = [];
    const carriedOut = board.instructions - instructions;
    return [ended, elapsed, carriedOut, events.length / 4, ...events, ...received];
  }
}

function main() {
  const path = process.argv[2];
  if (path === undefined) {
    throw new Error("usage: node main.mjs IMAGE.elf");
  }
  const rig = new Rig(new Image(readFileSync(path)));
  for (let request = readRequest(); request !== undefined; request = readRequest()) {
    answer(rig.serve(request));
  }
}

try {
  main();
} catch (error) {
  process.stderr.write(`${error instanceof Error ? error.message : error}\n`);
  process.exit(1);
}
