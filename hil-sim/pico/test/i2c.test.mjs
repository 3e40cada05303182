// A transfer takes its time, a line that is held stops it, and the peripheral is busy until its end.

import assert from "node:assert/strict";
import test from "node:test";

import { RP2040 } from "rp2040js";

import { I2cBus } from "../i2c.mjs";
import { EVENT } from "../protocol.mjs";

const I2C0 = 0x4004_4000;
const [CON, TAR, DATA_CMD, HCNT, LCNT, RAW, ENABLE, ENABLE_STATUS, SPKLEN] = [
  0x00, 0x04, 0x10, 0x1c, 0x20, 0x34, 0x6c, 0x9c, 0xa0,
];
const [READ, STOP] = [1 << 8, 1 << 9];
const [TX_ABRT, STOP_DET] = [1 << 6, 1 << 9];
const ADDRESS = 0x50;
/** 125 MHz, 125 cycles a clock: 92 + 8 and what is added. */
const CLOCK_NS = 1_000;
const BYTE_NS = 9 * CLOCK_NS;

function chip() {
  const rp2040 = new RP2040();
  rp2040.logger = { debug() {}, info() {}, warn() {}, error() {} };
  const events = [];
  const failures = [];
  const board = {
    record: (kind, a) => events.push([kind, a]),
    fail: (what) => failures.push(what),
    asksFrame() {},
    hasI2cPins: true,
  };
  const bus = new I2cBus(rp2040, board);
  const write = (offset, value) => rp2040.writeUint32(I2C0 + offset, value);
  const read = (offset) => rp2040.readUint32(I2C0 + offset);
  const pass = (ns) => rp2040.clock.tick(ns);
  const free = { sdaIsHeld: false, sclIsHeld: false };
  for (const [offset, value] of [[CON, 0x65], [TAR, ADDRESS], [HCNT, 50], [LCNT, 59], [SPKLEN, 8], [ENABLE, 1]]) {
    write(offset, value);
  }
  return { bus, board, events, failures, write, read, pass, free };
}

test("a byte takes nine clocks, and the frame answers it", () => {
  const { bus, events, read, write, pass } = chip();
  write(DATA_CMD, READ | STOP);
  pass(CLOCK_NS + BYTE_NS - 1);
  assert.deepEqual(events, []);
  pass(1);
  assert.deepEqual(events, [[EVENT.I2C_ADDRESS, ADDRESS]]);
  pass(BYTE_NS);
  assert.equal(events.length, 1, "it waits for the acknowledgement");
  bus.answer(1);
  pass(BYTE_NS);
  bus.answer(0xa5);
  assert.equal(read(RAW) & STOP_DET, 0);
  pass(CLOCK_NS);
  assert.equal(read(RAW) & STOP_DET, STOP_DET);
  assert.equal(read(DATA_CMD) & 0xff, 0xa5);
});

test("what is written after an abort is not sent", () => {
  const { bus, events, read, write, pass } = chip();
  write(DATA_CMD, 1);
  pass(CLOCK_NS + BYTE_NS);
  bus.answer(0);
  write(DATA_CMD, 2 | STOP);
  pass(10 * BYTE_NS);
  assert.equal(read(RAW) & TX_ABRT, TX_ABRT);
  assert.deepEqual(events.map(([kind]) => kind), [EVENT.I2C_ADDRESS, EVENT.I2C_STOP]);
});

test("a clock that is held keeps the peripheral busy", () => {
  const { bus, failures, free, read, write, pass } = chip();
  write(DATA_CMD, READ | STOP);
  bus.drive({ ...free, sclIsHeld: true });
  pass(100 * BYTE_NS);
  write(ENABLE, 0);
  pass(100 * BYTE_NS);
  assert.equal(read(ENABLE_STATUS), 1);
  write(TAR, ADDRESS);
  assert.equal(failures.length, 1);
  bus.drive(free);
  pass(2 * CLOCK_NS);
  assert.equal(read(ENABLE_STATUS), 0);
});

test("a data line that is held loses the address, and lets no transfer end", () => {
  const { bus, events, free, read, write, pass } = chip();
  write(DATA_CMD, READ | STOP);
  pass(CLOCK_NS);
  bus.drive({ ...free, sdaIsHeld: true });
  pass(BYTE_NS);
  assert.equal(read(RAW) & TX_ABRT, TX_ABRT);
  assert.deepEqual(events, []);

  const other = chip();
  other.write(DATA_CMD, READ | STOP);
  other.pass(CLOCK_NS + BYTE_NS);
  other.bus.answer(1);
  other.bus.drive({ ...free, sdaIsHeld: true });
  other.pass(BYTE_NS);
  other.bus.answer(0xff);
  other.pass(100 * BYTE_NS);
  assert.equal(other.read(RAW) & STOP_DET, 0);
  assert.equal(other.read(DATA_CMD) & 0xff, 0);
  other.bus.drive(free);
  other.pass(0);
  assert.equal(other.read(RAW) & STOP_DET, STOP_DET);
});

test("a transfer without pins is an error", () => {
  const { board, failures, write } = chip();
  board.hasI2cPins = false;
  write(DATA_CMD, READ | STOP);
  assert.equal(failures.length, 1);
});
