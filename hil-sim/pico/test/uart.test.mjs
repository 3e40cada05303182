// Bytes take their time on the line, and interrupts are those of the real UART.

import assert from "node:assert/strict";
import test from "node:test";

import { RP2040 } from "rp2040js";

import { UartLine } from "../uart.mjs";

const UART0 = 0x4003_4000;
const [DR, FR, IBRD, LCR_H, CR, IFLS, IMSC, MIS] = [0x00, 0x18, 0x24, 0x2c, 0x30, 0x34, 0x38, 0x40];
const [RX, RX_TIMEOUT] = [1 << 4, 1 << 6];
const BYTE_NS = 10_000;

/** A chip whose UART runs at 1 Mbaud (125 MHz / 16 / 7.8125). */
function chip(integerDivider = 7) {
  const rp2040 = new RP2040();
  rp2040.logger = { debug() {}, info() {}, warn() {}, error() {} };
  const line = new UartLine(rp2040);
  const write = (offset, value) => rp2040.writeUint32(UART0 + offset, value);
  write(IBRD, integerDivider);
  write(0x28, 52);
  write(LCR_H, 0x70);
  write(IFLS, 0);
  write(IMSC, RX | RX_TIMEOUT);
  write(CR, 0x301);
  return { rp2040, line, write, read: (offset) => rp2040.readUint32(UART0 + offset), pass: (ns) => rp2040.clock.tick(ns) };
}

test("the host's bytes come one after the other", () => {
  const { line, read, pass } = chip();
  line.send([1, 2, 3]);
  pass(BYTE_NS - 1);
  assert.ok(read(FR) & (1 << 4), "the receive FIFO is empty");
  pass(1 + BYTE_NS);
  assert.deepEqual([read(DR), read(DR)], [1, 2]);
  assert.ok(read(FR) & (1 << 4));
  pass(BYTE_NS);
  assert.equal(read(DR), 3);
});

test("the interrupt comes with four bytes, or 32 bits after the last", () => {
  const { line, read, pass } = chip();
  line.send([1, 2, 3, 4]);
  pass(3 * BYTE_NS);
  assert.equal(read(MIS), 0);
  pass(BYTE_NS);
  assert.equal(read(MIS), RX);
  for (let count = 0; count < 4; count += 1) {
    read(DR);
  }
  assert.equal(read(MIS), 0);
  line.send([5]);
  pass(BYTE_NS + 31_000);
  assert.equal(read(MIS), 0);
  pass(1_000);
  assert.equal(read(MIS), RX_TIMEOUT);
  read(DR);
  assert.equal(read(MIS), 0);
});

test("the board's bytes leave one after the other, and the FIFO can be full", () => {
  const { line, write, read, pass } = chip();
  for (let byte = 0; byte < 33; byte += 1) {
    assert.equal(read(FR) & (1 << 5), 0, "the transmit FIFO has room");
    write(DR, byte);
  }
  assert.ok(read(FR) & (1 << 5), "32 bytes wait, and one is being sent");
  pass(2 * BYTE_NS);
  assert.deepEqual(line.takeReceived(), [0, 1]);
  pass(40 * BYTE_NS);
  assert.equal(line.takeReceived().length, 31);
  assert.equal(read(FR) & (1 << 3), 0, "the UART is idle");
});

test("another rate at the board loses every byte", () => {
  const { line, write, read, pass } = chip(9);
  line.send([1]);
  write(DR, 2);
  pass(5 * BYTE_NS);
  assert.ok(read(FR) & (1 << 4));
  assert.deepEqual(line.takeReceived(), []);
});
