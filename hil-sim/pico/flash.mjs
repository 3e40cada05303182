// The flash chip of a Pico, and the functions of the boot ROM that connect it.
//
// rp2040js has no boot ROM, and a store to flash writes there. Here a store is an error, the ROM has its table of
// functions (RP2040 datasheet, 2.8.3), and nothing in flash can be read while it is not mapped.

export const FLASH_LEN = 2 * 1024 * 1024;
const FLASH_START = 0x1000_0000;
const FLASH_END = 0x1400_0000;

/** Code of a ROM function or table: two letters. @param {string} letters */
const code = (letters) => letters.charCodeAt(0) | (letters.charCodeAt(1) << 8);
/** The ROM's functions that an image calls; each is one breakpoint instruction, whose number is its place here. */
const FUNCTIONS = ["IF", "EX", "FC", "CX"];
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

export class Flash {
  #rp2040;
  #board;
  /** Flash can be read by addresses; `false` from `flash_exit_xip` on. */
  #isMapped = true;

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

  /** A breakpoint instruction. Returns whether it was one of the ROM's functions. @param {number} number */
  isCalled(number) {
    const { core } = this.#rp2040;
    if (core.PC - core.breakRewind !== FUNCTIONS_AT + 4 * number || number > LOOK_UP) {
      return false;
    }
    const [r0, r1] = core.registers;
    if (number === LOOK_UP) {
      this.#return(this.#lookUp(r0, r1));
      return true;
    }
    if (FUNCTIONS[number] === "EX" || FUNCTIONS[number] === "CX") {
      this.#map(FUNCTIONS[number] === "CX");
    }
    this.#return();
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

  #return(value) {
    const { core } = this.#rp2040;
    if (value !== undefined) {
      core.registers[0] = value;
    }
    core.PC = core.LR & ~1;
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
    if (!this.#isMapped) {
      this.#map(true);
    }
  }
}
