// The functions of the boot ROM, and what no image may do with the flash.

import assert from "node:assert/strict";
import test from "node:test";

import { RP2040 } from "rp2040js";

import { Flash } from "../flash.mjs";

const RAM = 0x2000_0000;

/** A chip whose core is at a breakpoint of the ROM. */
function chip() {
  const rp2040 = new RP2040();
  rp2040.logger = { debug() {}, info() {}, warn() {}, error() {} };
  const log = { failures: [] };
  const board = { fail: (what) => log.failures.push(what) };
  const flash = new Flash(rp2040, board);
  const { core } = rp2040;

  /** Calls a function of the ROM. */
  function call(address, ...args) {
    args.forEach((value, index) => {
      core.registers[index] = value;
    });
    core.LR = (RAM + 0x100) | 1;
    core.PC = address & ~1;
    core.breakRewind = 2;
    const number = rp2040.readUint16(core.PC) & 0xff;
    core.PC += 2;
    assert.ok(flash.isCalled(number));
    return core.registers[0];
  }

  const find = (letters) =>
    call(rp2040.readUint16(0x18), rp2040.readUint16(0x14), letters.charCodeAt(0) | (letters.charCodeAt(1) << 8));
  const functions = Object.fromEntries(["IF", "EX", "FC", "CX"].map((letters) => [letters, find(letters)]));
  return { rp2040, log, call, find, functions };
}

test("functions are found by their code, and others are not", () => {
  const { find, functions } = chip();
  assert.equal(new Set(Object.values(functions)).size, 4);
  assert.equal(find("XX"), 0);
});

test("what no chip allows is an error", () => {
  const { rp2040, log, call, functions } = chip();
  rp2040.writeUint32(0x1000_0000, 1);
  assert.match(log.failures.pop(), /a store to flash/);
  call(functions.EX);
  rp2040.readUint32(0x1000_0000);
  assert.match(log.failures.pop(), /while it was not mapped/);
  call(functions.CX);
  rp2040.readUint32(0x1000_0000);
  assert.deepEqual(log.failures, []);
});
