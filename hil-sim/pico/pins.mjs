// The wires of the carrier board (hardware/carrier.toml): the DAC's bus, the amplifier's lines, switch, monitor and
// light.
//
// A pin that the chip does not drive has the level that the carrier's resistor gives it. What happens on the wires
// becomes events with the time at which it happened; the chips themselves are simulated in `frixel-hil-sim`.
//
// In rp2040js pads come up without input enable, a driven pin does not read back, and an ADC that converts all the time
// gives a result up to 2 us old. Here pads are as after a reset, driven levels are inputs, too, and the ADC gives the
// voltage of the tick in which it is read.

import { EVENT } from "./protocol.mjs";

/** GPIO numbers. */
export const GPIO = {
  SYNC: 2,
  SCLK: 3,
  SDI: 4,
  SDO: 5,
  ENABLE: 6,
  CLEAR: 7,
  READY: 10,
  ARM: 14,
  SDA: 16,
  SCL: 17,
  FRAME_READY: 18,
  LED: 25,
};

/** Wires that are pulled up while nothing drives them; the others are pulled down. */
const PULLED_UP = new Set([GPIO.SYNC, GPIO.SCL]);
/** Wires whose edges are events of their own. */
const WATCHED = new Map([
  [GPIO.ENABLE, EVENT.ENABLE],
  [GPIO.CLEAR, EVENT.CLEAR],
  [GPIO.LED, EVENT.LED],
  [GPIO.SCL, EVENT.SCL],
]);
/** ADC channel of the amplifier's monitor, GP26, and the offset of the ADC's register RESULT. */
const MONITOR_CHANNEL = 0;
const ADC_RESULT = 0x04;
/** Bits of the ADC's register CS: enabled, and converting one time after the other. */
const ADC_CONVERTS = (1 << 0) | (1 << 3);
/** Pads after a reset (RP2040 datasheet, 2.19.6.3, GPIO0): input enabled, pulled down, 4 mA. rp2040js has no input enable. */
const PAD_AFTER_RESET = 0x56;
/** Function of a pin that belongs to I2C. */
const FUNCTION_I2C = 3;
/** Clocks of a frame of the DAC. */
const FRAME_CLOCKS = 24;

/** What the wiring needs of a board. @typedef {{ wake(): void, record(kind: number, a: number, b?: number): void,
 *  frameEnded(): void, asksFrame(): void, instant: number }} Wired */

export class Pins {
  #rp2040;
  #board;
  /** Levels of the driven wires. @type {Map<number, boolean>} */
  #levels = new Map();
  #clocks = 0;
  #bits = 0;
  #syncFellAt = 0;
  #syncRoseAt = 0;
  /** Bits that the DAC shifts out during the next frame. */
  shiftingOut = 0;

  /** @param {any} rp2040 @param {Wired} board */
  constructor(rp2040, board) {
    this.#rp2040 = rp2040;
    this.#board = board;
    for (const pin of rp2040.gpio) {
      pin.padValue = PAD_AFTER_RESET;
      pin.lastValue = pin.value;
    }
    for (const number of [GPIO.SYNC, GPIO.SCLK, GPIO.SDI, GPIO.ENABLE, GPIO.CLEAR, GPIO.LED, GPIO.SCL]) {
      this.#follow(number);
    }
    const read = rp2040.adc.readUint32.bind(rp2040.adc);
    rp2040.adc.readUint32 = (offset) => {
      if (offset !== ADC_RESULT) {
        return read(offset);
      }
      board.record(EVENT.MONITOR_READ, Math.round(board.instant - this.#syncRoseAt));
      // The world gives a voltage for each tick. A conversion of 2 us that begins before the tick would see that of the
      // tick before, and not the voltage a microsecond ago.
      const converts = (rp2040.adc.cs & ADC_CONVERTS) === ADC_CONVERTS;
      return converts ? rp2040.adc.channelValues[MONITOR_CHANNEL] : read(offset);
    };
  }

  #follow(number) {
    const pin = this.#rp2040.gpio[number];
    const level = () => (pin.outputEnable ? pin.outputValue : PULLED_UP.has(number));
    this.#levels.set(number, level());
    pin.setInputValue(level());
    pin.addListener(() => {
      const after = level();
      if (after === this.#levels.get(number)) {
        return;
      }
      this.#levels.set(number, after);
      // rp2040js does not let a chip read the pins that it drives.
      pin.setInputValue(after);
      this.#board.wake();
      this.#edge(number, after);
    });
  }

  /** @param {number} number */
  level(number) {
    return this.#levels.get(number) ?? false;
  }

  /** Whether I2C 0 has its pins. */
  get hasI2cPins() {
    return [GPIO.SDA, GPIO.SCL].every((number) => this.#rp2040.gpio[number].functionSelect === FUNCTION_I2C);
  }

  /**
   * Sets what the outside drives.
   * @param {{ ready: boolean, arm: boolean, frameReady: boolean, sdaIsHeld: boolean, monitorCode: number }} inputs
   */
  drive({ ready, arm, frameReady, sdaIsHeld, monitorCode }) {
    this.#rp2040.adc.channelValues[MONITOR_CHANNEL] = monitorCode;
    this.#input(GPIO.READY, ready);
    this.#input(GPIO.ARM, arm);
    this.#input(GPIO.FRAME_READY, frameReady);
    this.#input(GPIO.SDA, !sdaIsHeld);
  }

  #input(number, level) {
    const pin = this.#rp2040.gpio[number];
    if (pin.rawInputValue !== level) {
      pin.setInputValue(level);
      this.#board.wake();
    }
  }

  #edge(number, high) {
    const kind = WATCHED.get(number);
    if (kind !== undefined) {
      this.#board.record(kind, Number(high));
      if (number === GPIO.SCL) {
        this.#board.asksFrame();
      }
    } else if (number === GPIO.SYNC) {
      this.#sync(high);
    } else if (number === GPIO.SCLK && !this.level(GPIO.SYNC)) {
      this.#clock(high);
    }
  }

  #sync(high) {
    if (high) {
      this.#syncRoseAt = this.#board.instant;
      this.#board.record(EVENT.FRAME, this.#bits, (this.#clocks << 24) | Math.round(this.#board.instant - this.#syncFellAt));
      this.#input(GPIO.SDO, true);
      this.#board.frameEnded();
      return;
    }
    this.#syncFellAt = this.#board.instant;
    this.#clocks = 0;
    this.#bits = 0;
    this.#shiftOut();
  }

  /** The DAC takes SDI at falling edges of SCLK, and changes SDO at rising ones. */
  #clock(high) {
    if (high) {
      this.#shiftOut();
      return;
    }
    this.#bits = ((this.#bits << 1) | Number(this.level(GPIO.SDI))) >>> 0;
    this.#clocks = Math.min(this.#clocks + 1, 255);
  }

  #shiftOut() {
    const place = FRAME_CLOCKS - 1 - this.#clocks;
    this.#input(GPIO.SDO, place >= 0 && ((this.shiftingOut >>> place) & 1) !== 0);
  }
}
