// UART0, and the line between it and the host.
//
// rp2040js sends a byte at once and never has a full transmit FIFO, asks for an interrupt after each received byte, has
// no receive timeout and no data request for DMA. Here a byte takes ten bits of the line, and the interrupts are those
// of the PL011 (RP2040 datasheet, 4.2): FIFO levels, and a timeout of 32 bits, without which a driver that waits for it
// would hang on a real board only.

import { BAUD } from "./protocol.mjs";

const FIFO_LEN = 32;
const BYTE_NS = (10 * 1e9) / BAUD;
const TIMEOUT_NS = (32 * 1e9) / BAUD;
/** The receiver reads a byte as long as the two ends differ by less, as a fraction of the rate. */
const BAUD_TOLERANCE = 0.03;

/** Offsets of registers. */
const DR = 0x00;
const FR = 0x18;
const IFLS = 0x34;
const RIS = 0x3c;
const MIS = 0x40;
const ICR = 0x44;
const DMACR = 0x48;
/** Bits of the flags. */
const BUSY = 1 << 3;
const RX_EMPTY = 1 << 4;
const TX_FULL = 1 << 5;
const RX_FULL = 1 << 6;
const TX_EMPTY = 1 << 7;
/** Bits of the interrupts. */
const RX = 1 << 4;
const TX = 1 << 5;
const RX_TIMEOUT = 1 << 6;
const OVERRUN = 1 << 10;
/** Bytes in a FIFO at which its interrupt is asked for, by the value of IFLS. */
const LEVELS = [4, 8, 16, 24, 28];
/** IFLS after a reset: both FIFOs half full. */
const IFLS_AFTER_RESET = 0x12;

export class UartLine {
  #uart;
  #clock;
  #levels = IFLS_AFTER_RESET;
  #dmaEnabled = 0;
  /** Bytes on their way from the host. @type {number[]} */
  #fromHost = [];
  /** Bytes that the host has received. @type {number[]} */
  #toHost = [];
  /** Bytes in the transmit FIFO, with the time at which each has left. @type {{ byte: number, leavesAt: number }[]} */
  #sending = [];
  #feeding;
  #timeout;
  #sent;

  /** @param {any} rp2040 */
  constructor(rp2040) {
    const uart = rp2040.uart[0];
    this.#uart = uart;
    this.#clock = rp2040.clock;
    this.#feeding = this.#clock.createAlarm(() => this.#byteArrives());
    this.#timeout = this.#clock.createAlarm(() => this.#raise(RX_TIMEOUT));
    this.#sent = this.#clock.createAlarm(() => this.#byteLeaves());
    this.#patch(uart);
  }

  #patch(uart) {
    const read = uart.readUint32.bind(uart);
    const write = uart.writeUint32.bind(uart);
    uart.checkInterrupts = () => {
      uart.rp2040.setInterrupt(uart.irq, (uart.interruptStatus & uart.interruptMask) !== 0);
    };
    uart.readUint32 = (offset) => {
      switch (offset) {
        case DR:
          return this.#read();
        case FR:
          return this.#flags();
        case IFLS:
          return this.#levels;
        case RIS:
          return uart.interruptStatus;
        case MIS:
          return uart.interruptStatus & uart.interruptMask;
        case DMACR:
          return this.#dmaEnabled;
        default:
          return read(offset);
      }
    };
    uart.writeUint32 = (offset, value) => {
      switch (offset) {
        case DR:
          this.#send(value & 0xff);
          break;
        case IFLS:
          this.#levels = value;
          break;
        case ICR:
          uart.interruptStatus &= ~uart.rawWriteValue;
          uart.checkInterrupts();
          break;
        case DMACR:
          this.#dmaEnabled = value;
          this.#request();
          break;
        default:
          write(offset, value);
          this.#request();
      }
    };
  }

  /** Queues bytes that the host sends. @param {Iterable<number>} bytes */
  send(bytes) {
    this.#fromHost.push(...bytes);
    if (!this.#feeding.scheduled && this.#fromHost.length > 0) {
      this.#feeding.schedule(BYTE_NS);
    }
  }

  /** Takes the bytes that the host has received. */
  takeReceived() {
    return this.#toHost.splice(0);
  }

  /** Whether both ends of the line have the same rate. */
  get #isInTime() {
    const rate = this.#uart.baudDivider > 0 ? this.#uart.baudRate : 0;
    return this.#uart.enabled && Math.abs(rate / BAUD - 1) < BAUD_TOLERANCE;
  }

  #byteArrives() {
    this.#feeding.scheduled = false;
    const byte = this.#fromHost.shift();
    const uart = this.#uart;
    if (byte !== undefined && uart.rxEnabled && this.#isInTime) {
      if (uart.rxFIFO.full) {
        this.#raise(OVERRUN);
      } else {
        uart.rxFIFO.push(byte);
        this.#timeout.schedule(TIMEOUT_NS);
        this.#raise(uart.rxFIFO.itemCount >= this.#level(3) ? RX : 0);
      }
    }
    if (this.#fromHost.length > 0) {
      this.#feeding.schedule(BYTE_NS);
    }
  }

  #read() {
    const uart = this.#uart;
    const byte = uart.rxFIFO.pull();
    if (uart.rxFIFO.itemCount < this.#level(3)) {
      uart.interruptStatus &= ~RX;
    }
    if (uart.rxFIFO.empty) {
      uart.interruptStatus &= ~RX_TIMEOUT;
      this.#timeout.cancel();
    }
    this.#request();
    uart.checkInterrupts();
    return byte;
  }

  #send(byte) {
    if (!this.#uart.enabled || !this.#uart.txEnabled || this.#sending.length > FIFO_LEN) {
      return;
    }
    const last = this.#sending.at(-1);
    const begins = last ? last.leavesAt : this.#clock.nanos;
    this.#sending.push({ byte, leavesAt: begins + BYTE_NS });
    if (!this.#sent.scheduled) {
      this.#sent.schedule(BYTE_NS);
    }
    if (this.#inTransmitFifo > this.#level(0)) {
      this.#uart.interruptStatus &= ~TX;
      this.#uart.checkInterrupts();
    }
    this.#request();
  }

  #byteLeaves() {
    this.#sent.scheduled = false;
    const { byte } = this.#sending.shift() ?? { byte: 0 };
    if (this.#isInTime) {
      this.#toHost.push(byte);
    }
    if (this.#sending.length > 0) {
      this.#sent.schedule(BYTE_NS);
    }
    this.#raise(this.#inTransmitFifo <= this.#level(0) ? TX : 0);
  }

  /** Bytes in the transmit FIFO: the first byte under way is in the shift register. */
  get #inTransmitFifo() {
    return Math.max(0, this.#sending.length - 1);
  }

  #flags() {
    const { rxFIFO } = this.#uart;
    const waiting = this.#inTransmitFifo;
    return (
      (rxFIFO.empty ? RX_EMPTY : 0) |
      (rxFIFO.full ? RX_FULL : 0) |
      (waiting >= FIFO_LEN ? TX_FULL : 0) |
      (waiting === 0 ? TX_EMPTY : 0) |
      (this.#sending.length > 0 ? BUSY : 0)
    );
  }

  /** Bytes at which the interrupt of a FIFO is asked for; `shift` is that of its field in IFLS. */
  #level(shift) {
    return LEVELS[(this.#levels >> shift) & 7] ?? FIFO_LEN;
  }

  #raise(interrupts) {
    this.#uart.interruptStatus |= interrupts;
    this.#uart.checkInterrupts();
    this.#request();
  }

  /** Sets the data requests for DMA. */
  #request() {
    const { rp2040, dreq, rxFIFO } = this.#uart;
    const set = (channel, isOn) => (isOn ? rp2040.dma.setDREQ(channel) : rp2040.dma.clearDREQ(channel));
    set(dreq.rx, (this.#dmaEnabled & 1) !== 0 && !rxFIFO.empty);
    set(dreq.tx, (this.#dmaEnabled & 2) !== 0 && this.#inTransmitFifo < FIFO_LEN);
  }
}
