// Prints the hash of what a finger feels on bundled scenes, as WebAssembly computes it: node run.mjs MODULE.wasm
//
// The module is given no imports. One that needs any, a clock for example, does not start.

import { readFile } from "node:fs/promises";

const { instance } = await WebAssembly.instantiate(await readFile(process.argv[2]), {});
const hash = BigInt.asUintN(64, instance.exports.frixel_scenes_hash());
console.log(hash.toString(16).padStart(16, "0"));
