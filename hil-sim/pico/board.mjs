// One board from a start to the next: the emulated chip with what the rig adds to it.
//
// In rp2040js exceptions cost no cycles, bus errors are logged, the watchdog triggers for ever, `reset()` erases flash
// and keeps the PIO, and CHIP_RESET reads as ones. Here exceptions take 15 and 13 cycles, a bus error is a hard fault,
// and a reset is a new chip, with flash, RAM, scratch registers and reasons as the cause leaves them.

import { RP2040 } from "rp2040js";

import { CallWatch } from "./call_watch.mjs";
import { ENDLESS_LOOP_AT, FLASH_LEN, Flash } from "./flash.mjs";
import { I2cBus } from "./i2c.mjs";
import { Pins } from "./pins.mjs";
import { PioStepper } from "./pio.mjs";
import { CAUSE, ENDED, EVENT } from "./protocol.mjs";
import { UartLine } from "./uart.mjs";
import { watchUseBeforeReset } from "./use_before_reset.mjs";
import { patchWatchdog } from "./watchdog.mjs";

/** Cycles of the entry into an exception, and of the return (Cortex-M0+ technical reference manual, 3.6.1), which
 *  rp2040js does not count. */
const EXCEPTION_ENTRY_CYCLES = 15;
const EXCEPTION_RETURN_CYCLES = 13;
const NMI = 2;
const HARD_FAULT = 3;
/** Addresses of peripherals, as rp2040js keys them. */
const WATCHDOG = 0x40058;
const CHIP_RESET = 0x40064;
const SSI = 0x18000;
/** Offset of SSIENR, and of CHIP_RESET. */
const SSIENR = 0x08;
const CHIP_RESET_AT = 0x08;
const AIRCR = 0xd0c;
const SYSRESETREQ = 1 << 2;
/** CHIP_RESET: what was the last reset of the whole chip. */
const HAD_POR = 1 << 8;
const HAD_RUN = 1 << 16;

/** What remains over a reset. @typedef {{ flash: Uint8Array, sram?: Uint8Array, scratch?: Uint32Array, reason: number,
 *  chipReset: number }} Remains */

export class Board {
  #rp2040 = new RP2040();
  #core = this.#rp2040.core;
  #clock = this.#rp2040.clock;
  #pio;
  #flash;
  #pins;
  #i2c;
  #uart;
  /** The calls that someone looks at. @type {CallWatch | undefined} */
  #calls;
  #chipReset;
  #isHung = false;
  #isCrystalStopped = false;
  #hasFrame = false;
  #asksFrame = false;
  /** The run ends after this instruction. */
  #hasStopped = false;
  #begin = 0;
  /** Why the board ends; `undefined` while it runs. @type {number | undefined} */
  #endsWith;
  #failure = "";
  /** Events of the current run: kind, ns since its beginning, two values. @type {number[]} */
  events = [];
  instructions = 0;

  /**
   * @param {import("./loader.mjs").Image} image @param {Remains} remains @param {number} cause
   * @param {number} elapsed ns from the beginning of the run to this start
   */
  constructor(image, remains, cause, elapsed = 0) {
    const rp2040 = this.#rp2040;
    rp2040.logger = this.#logger();
    rp2040.flash.set(remains.flash.subarray(0, FLASH_LEN));
    if (remains.sram) {
      rp2040.sram.set(remains.sram);
    }
    this.#chipReset = remains.chipReset;
    this.#patchCore();
    this.#patchResets(remains);
    this.#pio = new PioStepper(rp2040);
    this.#flash = new Flash(rp2040, this);
    this.#pins = new Pins(rp2040, this);
    this.#i2c = new I2cBus(rp2040, this);
    this.#uart = new UartLine(rp2040);
    watchUseBeforeReset(rp2040, (what) => this.fail(what));
    rp2040.onBreak = (number) => {
      if (!this.#flash.isCalled(number)) {
        this.#core.PC -= this.#core.breakRewind;
        this.#hardFault();
      }
    };
    // The clock of this board is 0 now, whenever in the run it starts.
    this.events.push(EVENT.START, elapsed, cause, 0);
    this.#core.VTOR = image.vectors;
    this.#core.reset();
  }

  #logger() {
    const unmapped = /invalid memory|undefined address|not implemented yet|not 32 bit aligned/;
    const hear = (_name, message) => {
      if (unmapped.test(message)) {
        this.#hardFault();
      }
    };
    return { debug() {}, info() {}, warn: hear, error: hear };
  }

  /** Enters the hard fault handler before the next instruction, as the bus error that rp2040js only logs does. */
  #hardFault() {
    this.#core.pendingNMI = true;
    this.#core.interruptsUpdated = true;
  }

  #patchCore() {
    const core = this.#core;
    for (const [name, cycles] of [
      ["exceptionEntry", EXCEPTION_ENTRY_CYCLES],
      ["exceptionReturn", EXCEPTION_RETURN_CYCLES],
    ]) {
      const original = core[name].bind(core);
      core[name] = (argument) => {
        // The firmware has no non-maskable interrupt: the exception with its number is a hard fault here.
        original(argument === NMI ? HARD_FAULT : argument);
        core.cycles += cycles;
      };
    }
  }

  /** Resets: by the watchdog, by software, and what a start reads of them. @param {Remains} remains */
  #patchResets(remains) {
    const rp2040 = this.#rp2040;
    patchWatchdog(rp2040, remains, {
      isCrystalStopped: () => this.#isCrystalStopped,
      reset: () => this.#end(CAUSE.WATCHDOG),
      fail: (what) => this.fail(what),
    });
    const vreg = rp2040.peripherals[CHIP_RESET];
    vreg.readUint32 = (offset) => (offset === CHIP_RESET_AT ? this.#chipReset : 0);
    vreg.writeUint32 = () => {};
    const ppb = rp2040.ppb;
    const write = ppb.writeUint32.bind(ppb);
    ppb.writeUint32 = (offset, value) => {
      if (offset === AIRCR && (value & SYSRESETREQ) !== 0) {
        this.#end(CAUSE.SOFTWARE);
      } else {
        write(offset, value);
      }
    };
    const ssi = rp2040.peripherals[SSI];
    const configure = ssi.writeUint32.bind(ssi);
    ssi.writeUint32 = (offset, value) => {
      configure(offset, value);
      if (offset === SSIENR && value !== 0) {
        this.#flash.interfaceEnabled();
      }
    };
  }

  /** The time of the core. */
  get nanos() {
    return this.#clock.nanos;
  }

  /** The time of what happens on the pins now. */
  get instant() {
    return this.nanos - ((this.#pio?.ahead ?? 0) * 1e9) / this.#rp2040.clkSys;
  }

  /** Records an event of this run. */
  record(kind, a, b = 0) {
    this.events.push(kind, Math.max(0, Math.round(this.instant - this.#begin)), a, b);
  }

  /** Something that a machine of PIO may wait for has changed. */
  wake() {
    this.#pio?.wake();
  }

  frameEnded() {
    this.#hasFrame = true;
    this.#hasStopped = true;
  }

  /** The touch frame is to hear what was recorded last. */
  asksFrame() {
    this.#asksFrame = true;
    this.#hasStopped = true;
  }

  /** @param {number} value */
  answerI2c(value) {
    this.#i2c.answer(value);
  }

  get hasI2cPins() {
    return this.#pins.hasI2cPins;
  }

  #end(cause) {
    this.#endsWith ??= cause;
    this.#hasStopped = true;
  }

  /** Ends the process: the firmware has done what no board allows. @param {string} what */
  fail(what) {
    this.#failure ||= `${what} (program counter 0x${this.#core.PC.toString(16)})`;
    this.#hasStopped = true;
  }

  /**
   * Runs for a time, or until a frame of the DAC has ended, the touch frame is asked, the board resets itself, or so many
   * instructions were carried out. @param {number} nanos @param {number} instructionsMax
   */
  run(nanos, instructionsMax) {
    const core = this.#core;
    const clock = this.#clock;
    const pio = this.#pio;
    this.#begin = clock.nanos;
    this.#hasStopped = this.#endsWith !== undefined;
    this.#hasFrame = false;
    this.#asksFrame = false;
    const end = this.#begin + nanos;
    let left = instructionsMax;
    while (clock.nanos < end && left > 0 && !this.#hasStopped) {
      const cycleNanos = 1e9 / this.#rp2040.clkSys;
      const before = core.cycles;
      if (core.waiting || this.#isHung) {
        core.cycles += this.#idleCycles(end, cycleNanos);
      } else {
        this.#calls?.before(core.PC);
        core.executeInstruction();
        left -= 1;
      }
      clock.tick((core.cycles - before) * cycleNanos);
      pio.advance(core.cycles);
    }
    this.instructions += instructionsMax - left;
    if (this.#failure) {
      throw new Error(this.#failure);
    }
    return this.#ended(left);
  }

  #ended(left) {
    if (this.#endsWith !== undefined) {
      return ENDED.RESET;
    }
    if (this.#hasFrame) {
      return ENDED.FRAME;
    }
    if (this.#asksFrame) {
      return ENDED.FRAME_ASKED;
    }
    return left > 0 ? ENDED.TIME : ENDED.INSTRUCTIONS;
  }

  #idleCycles(end, cycleNanos) {
    const alarm = this.#clock.nextAlarm ? this.#clock.nanosToNextAlarm : Infinity;
    const nanos = Math.min(end - this.nanos, alarm);
    return Math.max(1, Math.ceil(Math.min(nanos / cycleNanos, this.#pio.next - this.#core.cycles)));
  }

  /**
   * @param {{ ready: boolean, arm: boolean, frameReady: boolean, sdaIsHeld: boolean, sclIsHeld: boolean,
   *   monitorCode: number, shiftingOut: number, bytes: Iterable<number> }} inputs
   */
  drive(inputs) {
    this.#pins.drive(inputs);
    this.#i2c.drive(inputs);
    this.#pins.shiftingOut = inputs.shiftingOut;
    this.#uart.send(inputs.bytes);
  }

  takeReceived() {
    return this.#uart.takeReceived();
  }

  hang() {
    this.#isHung = true;
  }

  /** Core and state machines, whose clock comes from the crystal, stand still; what the ring oscillator drives goes on. */
  stopCrystal() {
    this.#isHung = true;
    this.#isCrystalStopped = true;
    this.stopPio(0);
    this.stopPio(1);
  }

  /** @param {number} offset @param {number[]} bytes */
  writeFlash(offset, bytes) {
    this.#rp2040.flash.set(bytes, offset);
  }

  /** @param {number} address @param {number} wordCount */
  watch(address, wordCount) {
    this.#calls ??= new CallWatch(this.#rp2040);
    this.#calls.watch(address, wordCount);
  }

  takeCalls() {
    return this.#calls?.take() ?? [];
  }

  /** @param {number} number */
  stopPio(number) {
    this.#pio.stop(this.#rp2040.pio[number]);
  }

  /** The main loop goes into an endless loop once it runs. */
  hangMainLoop() {
    const core = this.#core;
    const execute = core.executeInstruction.bind(core);
    core.executeInstruction = () => {
      if (core.IPSR === 0) {
        core.PC = ENDLESS_LOOP_AT;
        delete core.executeInstruction;
      }
      return execute();
    };
  }

  /** @param {number} address */
  jump(address) {
    this.#core.PC = address;
    this.#core.waiting = false;
  }

  /** What the next start finds. @param {number} cause @param {(sram: Uint8Array) => void} scramble */
  remains(cause, scramble) {
    const watchdog = this.#rp2040.peripherals[WATCHDOG];
    const { flash, sram } = this.#rp2040;
    if (cause === CAUSE.POWER) {
      scramble(sram);
      return { flash, sram, reason: 0, chipReset: HAD_POR };
    }
    if (cause === CAUSE.RUN_PIN) {
      return { flash, sram, reason: 0, chipReset: HAD_RUN };
    }
    const { scratchData: scratch, reason } = watchdog;
    return { flash, sram, scratch, reason, chipReset: this.#chipReset };
  }

  /** Why the board ended: a value of `CAUSE`. */
  get cause() {
    return this.#endsWith;
  }
}

/** What a board finds that was never switched on. @param {import("./loader.mjs").Image} image @returns {Remains} */
export function factoryNew(image) {
  const flash = new Uint8Array(FLASH_LEN).fill(0xff);
  image.loadInto(flash);
  return { flash, reason: 0, chipReset: HAD_POR };
}
