// Notes calls of functions of the image, as a debugger's breakpoints that never stop would: the firmware does not know.

/** Register of a method's first argument behind `self` (Procedure Call Standard for the Arm Architecture, 6.1.1). */
const ARGUMENT = 1;

export class CallWatch {
  #rp2040;
  /** Number of the function, and words to read of what that argument points at, by its address.
   *  @type {Map<number, { number: number, wordCount: number }>} */
  #watched = new Map();
  /** @type {number[]} */
  #calls = [];

  /** @param {any} rp2040 */
  constructor(rp2040) {
    this.#rp2040 = rp2040;
  }

  /** @param {number} address @param {number} wordCount */
  watch(address, wordCount) {
    this.#watched.set(address, { number: this.#watched.size, wordCount });
  }

  /** The core is about to carry out the instruction at an address. @param {number} address */
  before(address) {
    const watched = this.#watched.get(address);
    if (watched === undefined) {
      return;
    }
    this.#calls.push(watched.number);
    const pointer = this.#rp2040.core.registers[ARGUMENT];
    for (let index = 0; index < watched.wordCount; index += 1) {
      this.#calls.push(this.#rp2040.readUint32(pointer + 4 * index) >>> 0);
    }
  }

  /** The calls since the last time. */
  take() {
    return this.#calls.splice(0);
  }
}
