// Calls are noted in their order, with what the first argument points at.

import assert from "node:assert/strict";
import test from "node:test";

import { CallWatch } from "../call_watch.mjs";

test("calls of watched functions are noted, with the words that their first argument points at", () => {
  const memory = new Map([
    [0x2000_0100, 7],
    [0x2000_0104, 0xffff_ffff],
  ]);
  const registers = new Uint32Array(16);
  registers[1] = 0x2000_0100;
  const calls = new CallWatch({ core: { registers }, readUint32: (address) => memory.get(address) | 0 });
  calls.watch(0x2000_2000, 2);
  calls.watch(0x2000_3000, 0);
  for (const address of [0x2000_3000, 0x2000_1ffe, 0x2000_2000, 0x2000_2002, 0x2000_3000]) {
    calls.before(address);
  }
  assert.deepEqual(calls.take(), [1, 0, 7, 0xffff_ffff, 1]);
  assert.deepEqual(calls.take(), []);
});
