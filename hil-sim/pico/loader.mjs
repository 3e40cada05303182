// Reads an ELF image (32 bits, little-endian): what lies in flash, and the addresses of its functions.

const FLASH_START = 0x1000_0000;
const PT_LOAD = 1;
const SHT_SYMTAB = 2;
/** Bytes of the second-stage boot loader in front of the vector table. */
const BOOT2_LEN = 0x100;

/** @typedef {{ address: number, bytes: Uint8Array }} Segment */

export class Image {
  /** Address of the vector table, where the boot loader jumps to. */
  vectors = FLASH_START + BOOT2_LEN;
  /** @type {Segment[]} What lies in flash. */
  segments = [];
  /** @type {Map<string, number>} */
  #symbols = new Map();

  /** @param {Uint8Array} bytes */
  constructor(bytes) {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    if (view.getUint32(0) !== 0x7f45_4c46 || view.getUint8(4) !== 1) {
      throw new Error("the image is no ELF file of 32 bits");
    }
    const word = (offset) => view.getUint32(offset, true);
    const half = (offset) => view.getUint16(offset, true);
    const [programs, programLen, programCount] = [word(0x1c), half(0x2a), half(0x2c)];
    for (let header = programs; header < programs + programLen * programCount; header += programLen) {
      const [offset, address, len] = [word(header + 4), word(header + 12), word(header + 16)];
      if (word(header) === PT_LOAD && len > 0) {
        this.segments.push({ address, bytes: bytes.subarray(offset, offset + len) });
      }
    }
    if (!this.segments.some(({ address }) => address === FLASH_START)) {
      throw new Error(`the image has nothing at 0x${FLASH_START.toString(16)}, where the boot loader belongs`);
    }
    this.#readSymbols(bytes, word, half);
  }

  #readSymbols(bytes, word, half) {
    const [sections, sectionLen, sectionCount] = [word(0x20), half(0x2e), half(0x30)];
    const section = (index) => sections + index * sectionLen;
    for (let index = 0; index < sectionCount; index += 1) {
      const header = section(index);
      if (word(header + 4) !== SHT_SYMTAB) {
        continue;
      }
      const names = word(section(word(header + 24)) + 16);
      const [offset, len] = [word(header + 16), word(header + 20)];
      for (let symbol = offset; symbol < offset + len; symbol += 16) {
        const begin = names + word(symbol);
        const name = Buffer.from(bytes.subarray(begin, bytes.indexOf(0, begin))).toString("latin1");
        this.#symbols.set(name, word(symbol + 4));
      }
    }
  }

  /** The address of the first symbol that contains a text; `undefined` if there is none. @param {string} text */
  addressOf(text) {
    for (const [name, address] of this.#symbols) {
      if (name.includes(text)) {
        return address & ~1;
      }
    }
    return undefined;
  }

  /** Copies the image into flash. @param {Uint8Array} flash */
  loadInto(flash) {
    for (const { address, bytes } of this.segments) {
      const offset = address - FLASH_START;
      if (offset < 0 || offset + bytes.length > flash.length) {
        throw new Error(`the image has bytes at 0x${address.toString(16)}, outside of flash`);
      }
      flash.set(bytes, offset);
    }
  }
}
