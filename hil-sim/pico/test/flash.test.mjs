// The functions of the boot ROM, and the rules of NOR flash.

import assert from "node:assert/strict";
import test from "node:test";

import { RP2040 } from "rp2040js";

import { Flash } from "../flash.mjs";

const RAM = 0x2000_0000;

/** A chip whose core is at a breakpoint of the ROM. */
function chip() {
  const rp2040 = new RP2040();
  rp2040.logger = { debug() {}, info() {}, warn() {}, error() {} };
  const log = { failures: [], cuts: 0, nanos: 0 };
  const board = {
    get nanos() {
      return log.nanos;
    },
    fail: (what) => log.failures.push(what),
    record() {},
    losePower: () => {
      log.cuts += 1;
    },
  };
  const flash = new Flash(rp2040, board);
  const { core } = rp2040;

  /** Calls a function of the ROM, and lets time pass until it returns. */
  function call(address, ...args) {
    args.forEach((value, index) => {
      core.registers[index] = value;
    });
    core.LR = (RAM + 0x100) | 1;
    core.PC = address & ~1;
    core.breakRewind = 2;
    for (let round = 0; round < 1000 && core.PC !== RAM + 0x100 && log.cuts === 0; round += 1) {
      const number = rp2040.readUint16(core.PC) & 0xff;
      core.PC += 2;
      assert.ok(flash.isCalled(number));
      log.nanos += 1e6;
    }
    return core.registers[0];
  }

  const find = (letters) =>
    call(rp2040.readUint16(0x18), rp2040.readUint16(0x14), letters.charCodeAt(0) | (letters.charCodeAt(1) << 8));
  const functions = Object.fromEntries(["IF", "EX", "RE", "RP", "FC", "CX"].map((letters) => [letters, find(letters)]));
  return { rp2040, flash, log, call, find, functions };
}

test("functions are found by their code, and others are not", () => {
  const { find, functions } = chip();
  assert.equal(new Set(Object.values(functions)).size, 6);
  assert.equal(find("XX"), 0);
});

test("an erasure makes ones, and programming only zeros", () => {
  const { rp2040, log, call, functions } = chip();
  rp2040.flash.fill(0, 0, 8192);
  call(functions.EX);
  call(functions.RE, 4096, 4096, 65_536, 0xd8);
  assert.ok(log.nanos >= 45e6, "an erasure takes time");
  rp2040.sram.fill(0xf0, 0, 256);
  call(functions.RP, 4096, RAM, 256);
  rp2040.sram.fill(0x3c, 0, 256);
  call(functions.RP, 4096, RAM, 256);
  call(functions.CX);
  assert.deepEqual([rp2040.flash[4095], rp2040.flash[4096], rp2040.flash[4351], rp2040.flash[4352]], [0, 0x30, 0x30, 0xff]);
  assert.deepEqual(log.failures, []);
});

test("what no chip allows is an error", () => {
  const { rp2040, log, call, functions } = chip();
  rp2040.writeUint32(0x1000_0000, 1);
  assert.match(log.failures.pop(), /a store to flash/);
  call(functions.RE, 0, 4096, 65_536, 0xd8);
  assert.match(log.failures.pop(), /before flash_exit_xip/);
  call(functions.EX);
  rp2040.readUint32(0x1000_0000);
  assert.match(log.failures.pop(), /while it was not mapped/);
  call(functions.RP, 4096 + 8, RAM, 256);
  assert.match(log.failures.pop(), /no whole units of 256/);
  call(functions.CX);
  rp2040.readUint32(0x1000_0000);
  assert.deepEqual(log.failures, []);
});

test("a power cut leaves a part of an operation", () => {
  const { rp2040, flash, log, call, functions } = chip();
  rp2040.flash.fill(0, 0, 8192);
  flash.cutAfter(0, 0.25);
  call(functions.EX);
  call(functions.RE, 0, 4096, 65_536, 0xd8);
  assert.equal(log.cuts, 1);
  assert.deepEqual([rp2040.flash[1023], rp2040.flash[1024], rp2040.flash[1025]], [0xff, 0x55, 0]);
});
