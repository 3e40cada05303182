// I2C 0, as the controller of a bus with the touch frame, which is simulated in `frixel-hil-sim`.
//
// rp2040js carries a transfer out at once, drives no pins, is idle as soon as it is disabled, and goes on with what is
// written after an abort. Here each byte takes its nine clocks, and the frame, which the run's end asks, answers it. A
// line that others hold low stops the transfer as it does on a bus, and the peripheral stays busy until it is released
// (RP2040 datasheet, 4.3.4, "Tx FIFO management", 4.3.10.3, "Disable DW_apb_i2c").

import { EVENT } from "./protocol.mjs";

/** Offsets of registers. */
const CON = 0x00;
const TAR = 0x04;
const DATA_CMD = 0x10;
const FS_SCL_HCNT = 0x1c;
const FS_SCL_LCNT = 0x20;
const ENABLE = 0x6c;
const ENABLE_STATUS = 0x9c;
const FS_SPKLEN = 0xa0;
/** Registers that take a value only while the peripheral is idle. */
const CONFIGURATION = new Set([CON, TAR, FS_SCL_HCNT, FS_SCL_LCNT, FS_SPKLEN]);
/** Bit of ENABLE and ENABLE_STATUS. */
const IS_ENABLED = 1;
/** Bit of the raw interrupts: the transmit FIFO stays empty until it is cleared. */
const TX_ABRT = 1 << 6;
/** States of rp2040js, which does not export them. */
const IDLE = 0;
const STOPPING = 4;
/** Clocks of a byte with its acknowledgement. */
const BYTE_CLOCKS = 9;
/** Cycles that the peripheral adds to both parts of a clock (RP2040 datasheet, 4.3.14.1). */
const ADDED_CYCLES = 8;

/** What the bus needs of a board. @typedef {{ record(kind: number, a: number, b?: number): void,
 *  fail(what: string): void, asksFrame(): void, hasI2cPins: boolean }} Bus */

export class I2cBus {
  #i2c;
  #board;
  #alarm;
  /** What happens at the end of the step that is under way. @type {(() => void) | undefined} */
  #atEnd;
  /** Goes on with the frame's answer. @type {((answer: number) => void) | undefined} */
  #waiting;
  #lines = { sdaIsHeld: false, sclIsHeld: false };

  /** @param {any} rp2040 @param {Bus} board */
  constructor(rp2040, board) {
    this.#i2c = rp2040.i2c[0];
    this.#board = board;
    this.#alarm = rp2040.clock.createAlarm(() => this.#stepEnds());
    this.#patchSteps(this.#i2c);
    this.#patchRegisters(this.#i2c);
  }

  /** What others hold low. @param {{ sdaIsHeld: boolean, sclIsHeld: boolean }} lines */
  drive(lines) {
    this.#lines = lines;
    if (this.#atEnd && !this.#alarm.scheduled) {
      this.#alarm.schedule(0);
    }
  }

  /** @param {number} value */
  answer(value) {
    const waiting = this.#waiting;
    this.#waiting = undefined;
    waiting?.(value);
  }

  #patchSteps(i2c) {
    i2c.onStart = () => {
      if (!this.#board.hasI2cPins) {
        this.#board.fail("I2C 0 begins a transfer without its pins");
      }
      this.#step(1, () => this.#onceSdaIsFree(() => i2c.completeStart()));
    };
    i2c.onConnect = (address, mode) => {
      this.#send(() => this.#ask(EVENT.I2C_ADDRESS, address, mode, (answer) => i2c.completeConnect(answer !== 0)));
    };
    i2c.onWriteByte = (byte) => {
      this.#send(() => this.#ask(EVENT.I2C_WRITE, byte, 0, (answer) => i2c.completeWrite(answer !== 0)));
    };
    i2c.onReadByte = () => {
      const take = (byte) => i2c.completeRead(this.#lines.sdaIsHeld ? 0 : byte);
      this.#step(BYTE_CLOCKS, () => this.#ask(EVENT.I2C_READ, 0, 0, take));
    };
    i2c.onStop = () => this.#step(1, () => this.#onceSdaIsFree(() => this.#stop()));
  }

  /** Sends a byte. None that the frame knows has no bit that is one, which a held line shows as another's zero. */
  #send(then) {
    this.#step(BYTE_CLOCKS, () => (this.#lines.sdaIsHeld ? this.#i2c.arbitrationLost() : then()));
  }

  #stop() {
    this.#i2c.completeStop();
    if ((this.#i2c.enable & IS_ENABLED) === 0) {
      this.#i2c.rxFIFO.reset();
    }
    this.#board.record(EVENT.I2C_STOP, 0);
    this.#board.asksFrame();
  }

  #ask(kind, a, b, then) {
    this.#board.record(kind, a, b);
    this.#waiting = then;
    this.#board.asksFrame();
  }

  #step(clocks, then) {
    const { sclHighPeriod, sclLowPeriod, spikelen, rp2040 } = this.#i2c;
    const cycles = clocks * (sclHighPeriod + sclLowPeriod + spikelen + ADDED_CYCLES);
    this.#atEnd = then;
    this.#alarm.schedule((cycles * 1e9) / rp2040.clkSys);
  }

  #stepEnds() {
    this.#alarm.scheduled = false;
    if (this.#lines.sclIsHeld) {
      return;
    }
    const atEnd = this.#atEnd;
    this.#atEnd = undefined;
    atEnd?.();
  }

  /** START and STOP need SDA to rise or to be high. */
  #onceSdaIsFree(then) {
    if (this.#lines.sdaIsHeld) {
      this.#atEnd = () => this.#onceSdaIsFree(then);
    } else {
      then();
    }
  }

  #patchRegisters(i2c) {
    const read = i2c.readUint32.bind(i2c);
    const write = i2c.writeUint32.bind(i2c);
    const isEnabled = () => (i2c.enable & IS_ENABLED) !== 0;
    const isIdle = () => i2c.state === IDLE;
    i2c.readUint32 = (offset) => {
      return offset === ENABLE_STATUS ? Number(isEnabled() || !isIdle()) : read(offset);
    };
    i2c.writeUint32 = (offset, value) => {
      const enables = offset === ENABLE && (value & IS_ENABLED) !== 0;
      if ((CONFIGURATION.has(offset) || enables) && (isEnabled() || !isIdle())) {
        this.#board.fail("I2C 0 is configured before it is idle");
      }
      if (offset === DATA_CMD && (!isEnabled() || (i2c.intRaw & TX_ABRT) !== 0)) {
        return;
      }
      write(offset, value);
      if (offset === ENABLE && !enables && !isIdle()) {
        this.#end();
      }
    };
  }

  /** Ends the transfer after the byte that is under way. */
  #end() {
    const i2c = this.#i2c;
    i2c.stop = true;
    if (!i2c.busy) {
      i2c.busy = true;
      i2c.state = STOPPING;
      i2c.onStop();
    }
  }
}
