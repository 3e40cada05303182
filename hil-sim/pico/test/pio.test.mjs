// The stepper runs programs of the PIO in the core's time: frames of the DAC, and a one-shot that is kicked.

import assert from "node:assert/strict";
import test from "node:test";

import { RP2040 } from "rp2040js";

import { GPIO, Pins } from "../pins.mjs";
import { PioStepper } from "../pio.mjs";
import { EVENT } from "../protocol.mjs";

/** Addresses of the PIO blocks, and offsets of their registers. */
const PIO = [0x5020_0000, 0x5030_0000];
const [CTRL, TXF0, INSTR_MEM0] = [0x00, 0x10, 0x48];
const [CLKDIV, EXECCTRL, SHIFTCTRL, INSTR, PINCTRL] = [0xc8, 0xcc, 0xd0, 0xd8, 0xdc];
const FUNCTION_PIO0 = 6;

/** A chip without a program, whose cycles are counted by `run`. */
function chip() {
  const rp2040 = new RP2040();
  rp2040.logger = { debug() {}, info() {}, warn() {}, error() {} };
  const events = [];
  let now = 0;
  const board = {
    get nanos() {
      return now;
    },
    wake: () => stepper?.wake(),
    record: (kind, a, b = 0) => events.push({ at: now, kind, a, b }),
    frameEnded() {},
  };
  const stepper = new PioStepper(rp2040);
  const pins = new Pins(rp2040, board);
  const write = (block, offset, value) => rp2040.writeUint32(PIO[block] + offset, value >>> 0);
  return {
    events,
    pins,
    write,
    load(block, program) {
      for (const [place, word] of program.entries()) {
        write(block, INSTR_MEM0 + 4 * place, word);
      }
    },
    connect: (number, block) => rp2040.writeUint32(0x4001_4004 + 8 * number, FUNCTION_PIO0 + block),
    run(cycles) {
      for (const end = now + cycles; now < end; ) {
        now += 1;
        stepper.advance(now);
      }
    },
  };
}

/** An instruction with side-set of two pins and a delay. */
const sided = (word, side, delay = 0) => word | (((side << 3) | delay) << 8);

test("a frame has 24 bits inside SYNC, and starts when a word comes", () => {
  const { events, pins, write, load, connect, run } = chip();
  // Side-set: SYNC (1) and SCLK (2). Wait for a word; 24 times: a bit with SCLK high, and with SCLK low.
  load(0, [sided(0x80a0, 0b11), sided(0xe037, 0b10), sided(0x6001, 0b10, 1), sided(0x0042, 0b00, 1)]);
  write(0, EXECCTRL, 3 << 12);
  write(0, SHIFTCTRL, 1 << 18);
  write(0, PINCTRL, (3 << 26) | (GPIO.SYNC << 5));
  write(0, INSTR, 0xe087);
  write(0, PINCTRL, (2 << 29) | (1 << 20) | (GPIO.SYNC << 10) | GPIO.SDI);
  for (const number of [GPIO.SYNC, GPIO.SCLK, GPIO.SDI]) {
    connect(number, 0);
  }
  pins.shiftingOut = 0xa5a5a5;
  write(0, CTRL, 1);
  run(100);
  events.length = 0;
  for (const word of [0xabcdef, 0x000001, 0x800000]) {
    const begin = events.length > 0 ? events.at(-1).at : 100;
    write(0, TXF0, word << 8);
    run(1000);
    const frame = events.at(-1);
    assert.equal(frame.kind, EVENT.FRAME);
    assert.equal(frame.a, word);
    assert.equal(frame.b >>> 24, 24, "clocks");
    assert.equal(frame.b & 0xff_ffff, 1 + 24 * 4, "cycles for which SYNC was low");
    assert.ok(frame.at > begin);
  }
  assert.equal(events.length, 3);
});

test("a divider and a delay slow a machine down", () => {
  const { events, write, load, connect, run } = chip();
  // The light blinks: 1 + 9 cycles high, 1 low, of 4 core cycles each.
  load(0, [0xe001 | (9 << 8), 0xe000]);
  write(0, EXECCTRL, 1 << 12);
  write(0, CLKDIV, 4 << 16);
  write(0, PINCTRL, (1 << 26) | (GPIO.LED << 5));
  write(0, INSTR, 0xe081);
  connect(GPIO.LED, 0);
  write(0, CTRL, 1);
  run(4 * 11 * 10);
  // The machine was started between two cycles, so that the first one is shorter.
  const rises = events.filter(({ kind, a }) => kind === EVENT.LED && a === 1).map(({ at }) => at).slice(1);
  assert.ok(rises.length >= 8);
  for (let index = 1; index < rises.length; index += 1) {
    assert.equal(rises[index] - rises[index - 1], 44);
  }
});

test("a one-shot that is kicked stays high, and falls after its time", () => {
  const { events, write, load, connect, run } = chip();
  // set pins 0; pull; mov y, osr; set pins 3; mov x, status; jmp !x 8; jmp y-- 4; jmp 0; pull; jmp 2
  load(1, [0xe000, 0x80a0, 0xa047, 0xe003, 0xa025, 0x0028, 0x0084, 0x0000, 0x80a0, 0x0002]);
  write(1, EXECCTRL, (31 << 12) | 1);
  write(1, PINCTRL, (2 << 26) | (GPIO.ENABLE << 5));
  write(1, INSTR, 0xe083);
  connect(GPIO.ENABLE, 1);
  write(1, CTRL, 1);
  run(50);
  const rounds = 100;
  for (let kick = 0; kick < 5; kick += 1) {
    write(1, TXF0, rounds);
    run(200);
  }
  run(1000);
  const edges = events.filter(({ kind }) => kind === EVENT.ENABLE);
  assert.deepEqual(edges.map(({ a }) => a), [1, 0]);
  const life = edges[1].at - (50 + 4 * 200);
  assert.ok(life >= 3 * rounds && life <= 3 * rounds + 12, `it fell ${life} cycles after the last kick`);
});

test("a forced jump ends a wait", () => {
  const { events, write, load, connect, run } = chip();
  load(0, [0x80a0, 0x0000, 0xe001, 0x0003]);
  write(0, PINCTRL, (1 << 26) | (GPIO.LED << 5));
  write(0, INSTR, 0xe081);
  connect(GPIO.LED, 0);
  write(0, CTRL, 1);
  run(10);
  write(0, INSTR, 0x0002);
  run(10);
  assert.deepEqual(events.filter(({ kind }) => kind === EVENT.LED).map(({ a }) => a), [1]);
});
