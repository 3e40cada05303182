// The flash chip (Winbond W25Q16JV of a Pico), and the functions of the boot ROM that erase and program it.
//
// rp2040js has no boot ROM, and a store to flash writes there. Here a store is an error, the ROM has its table of
// functions (RP2040 datasheet, 2.8.3), and the chip has the rules of NOR flash: a sector is erased to ones, programming
// makes zeros of ones, and both take time, in which nothing in flash can be read.

import { EVENT } from "./protocol.mjs";

export const FLASH_LEN = 2 * 1024 * 1024;
const FLASH_START = 0x1000_0000;
const FLASH_END = 0x1400_0000;
const SECTOR_LEN = 4096;
const PAGE_LEN = 256;
/** Typical times of the chip (W25Q16JV data sheet, 9.6), in ns. */
const ERASE_NS = 45e6;
const PROGRAM_NS = 0.4e6;

/** Code of a ROM function or table: two letters. @param {string} letters */
const code = (letters) => letters.charCodeAt(0) | (letters.charCodeAt(1) << 8);
/** The ROM's functions that an image calls; each is one breakpoint instruction, whose number is its place here. */
const FUNCTIONS = ["IF", "EX", "RE", "RP", "FC", "CX"];
const LOOK_UP = FUNCTIONS.length;
/** Where they, and their table, lie in the ROM. */
const FUNCTIONS_AT = 0x100;
const TABLE_AT = 0x200;
const DATA_TABLE_AT = 0x300;
const BREAKPOINT = 0xbe00;
/** Address of a branch to itself. */
export const ENDLESS_LOOP_AT = 0x80;
const BRANCH_TO_SELF = 0xe7fe;
/** Version of the ROM, at 0x13: that of the RP2040-B2. */
const ROM_VERSION = 3;

/** @typedef {{ address: number, len: number, isErase: boolean, endsAt: number, data: Uint8Array }} Operation */

export class Flash {
  #rp2040;
  #board;
  /** Flash can be read by addresses; `false` from `flash_exit_xip` on. */
  #isMapped = true;
  /** @type {Operation | undefined} */
  #operation;
  /** Operations until the power is cut, and how far the one comes in which it is. */
  #cut = { after: Infinity, fraction: 0 };

  /** @param {any} rp2040 @param {any} board */
  constructor(rp2040, board) {
    this.#rp2040 = rp2040;
    this.#board = board;
    this.#writeRom();
    this.#guardStores();
  }

  #writeRom() {
    const rom = new DataView(this.#rp2040.bootrom.buffer);
    const half = (offset, value) => rom.setUint16(offset, value, true);
    rom.setUint32(0x10, (ROM_VERSION << 24) | (1 << 16) | code("Mu"), true);
    half(ENDLESS_LOOP_AT, BRANCH_TO_SELF);
    half(0x14, TABLE_AT);
    half(0x16, DATA_TABLE_AT);
    half(0x18, (FUNCTIONS_AT + 4 * LOOK_UP) | 1);
    for (let index = 0; index <= LOOK_UP; index += 1) {
      half(FUNCTIONS_AT + 4 * index, BREAKPOINT | index);
    }
    FUNCTIONS.forEach((letters, index) => {
      half(TABLE_AT + 4 * index, code(letters));
      half(TABLE_AT + 4 * index + 2, (FUNCTIONS_AT + 4 * index) | 1);
    });
  }

  #guardStores() {
    const view = new DataView(this.#rp2040.flash.buffer);
    view.setUint32 = (offset) => this.#board.fail(`a store to flash, at offset 0x${offset.toString(16)}`);
    this.#rp2040.flashView = view;
  }

  /** Cuts the power within the operation after so many others, at a fraction of it. */
  cutAfter(operations, fraction) {
    this.#cut = { after: operations, fraction };
  }

  /** A breakpoint instruction. Returns whether it was one of the ROM's functions. @param {number} number */
  isCalled(number) {
    const { core } = this.#rp2040;
    if (core.PC - core.breakRewind !== FUNCTIONS_AT + 4 * number || number > LOOK_UP) {
      return false;
    }
    const [r0, r1, r2] = core.registers;
    if (number === LOOK_UP) {
      this.#return(this.#lookUp(r0, r1));
      return true;
    }
    switch (FUNCTIONS[number]) {
      case "EX":
        this.#map(false);
        this.#return();
        break;
      case "CX":
        this.#map(true);
        this.#return();
        break;
      case "RE":
        this.#operate(() => ({ address: r0, len: r1, isErase: true, data: new Uint8Array(r1).fill(0xff) }));
        break;
      case "RP":
        this.#operate(() => ({ address: r0, len: r2, isErase: false, data: this.#bytes(r1, r2) }));
        break;
      default:
        this.#return();
    }
    return true;
  }

  #lookUp(table, wanted) {
    for (let entry = table; ; entry += 4) {
      const found = this.#rp2040.readUint16(entry);
      if (found === 0 || found === (wanted & 0xffff)) {
        return found === 0 ? 0 : this.#rp2040.readUint16(entry + 2);
      }
    }
  }

  #bytes(address, len) {
    return Uint8Array.from({ length: len }, (_, index) => this.#rp2040.readUint8(address + index));
  }

  #return(value) {
    const { core } = this.#rp2040;
    if (value !== undefined) {
      core.registers[0] = value;
    }
    core.PC = core.LR & ~1;
  }

  /** Begins an operation, or waits for its end: until then the core stays in the ROM, and takes interrupts. */
  #operate(make) {
    const { core } = this.#rp2040;
    if (!this.#operation) {
      this.#begin(make());
    }
    if (this.#board.nanos < this.#operation.endsAt) {
      core.PC -= core.breakRewind;
      return;
    }
    this.#write(this.#operation, this.#operation.len);
    this.#operation = undefined;
    this.#return();
  }

  #begin(operation) {
    const { address, len, isErase } = operation;
    const unit = isErase ? SECTOR_LEN : PAGE_LEN;
    if (this.#isMapped) {
      this.#board.fail("a flash operation before flash_exit_xip");
    }
    if (address % unit !== 0 || len % unit !== 0 || address + len > FLASH_LEN || len === 0) {
      this.#board.fail(`a flash operation of ${len} bytes at 0x${address.toString(16)}, which are no whole units of ${unit}`);
    }
    this.#board.record(EVENT.FLASH, address, isErase ? 0 : len);
    const time = (len / unit) * (isErase ? ERASE_NS : PROGRAM_NS);
    this.#operation = { ...operation, endsAt: this.#board.nanos + time };
    this.#cut.after -= 1;
    if (this.#cut.after < 0) {
      // What is interrupted leaves a part of the bytes as they should be, and one that is half done.
      this.#write(this.#operation, Math.floor(this.#cut.fraction * len));
      this.#board.losePower();
    }
  }

  /** @param {Operation} operation @param {number} len */
  #write({ address, isErase, data }, len) {
    const { flash } = this.#rp2040;
    for (let index = 0; index < len; index += 1) {
      flash[address + index] = isErase ? 0xff : flash[address + index] & data[index];
    }
    if (len < data.length) {
      // Half of the bits have changed.
      flash[address + len] = isErase ? flash[address + len] | 0x55 : flash[address + len] & (data[len] | 0x55);
    }
  }

  /** The second-stage boot loader, or the ROM, has mapped flash again. */
  #map(isMapped) {
    this.#isMapped = isMapped;
    const rp2040 = this.#rp2040;
    if (isMapped) {
      for (const name of ["readUint32", "readUint16", "readUint8"]) {
        delete rp2040[name];
      }
      return;
    }
    for (const name of ["readUint32", "readUint16", "readUint8"]) {
      const read = Object.getPrototypeOf(rp2040)[name];
      rp2040[name] = (address) => {
        if (address >= FLASH_START && address < FLASH_END) {
          this.#board.fail(`flash was read at 0x${(address >>> 0).toString(16)} while it was not mapped`);
        }
        return read.call(rp2040, address);
      };
    }
  }

  /** Tells that the flash interface was configured: the boot loader does it last. */
  interfaceEnabled() {
    if (!this.#isMapped && !this.#operation) {
      this.#map(true);
    }
  }
}
