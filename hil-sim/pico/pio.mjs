// Runs the state machines of both PIO blocks in time with the core.
//
// rp2040js runs them from `setTimeout`, a thousand instructions at a time, without regard to the core's clock, to clock
// dividers and to delays (https://github.com/wokwi/rp2040js/issues/106). Here each machine has the cycle of the core at
// which its next instruction is due. A forced instruction ends a wait, which it does not in rp2040js.

/** Offsets of the registers SM0_INSTR to SM3_INSTR, and the distance between two machines (RP2040 datasheet, 3.7). */
const SM0_INSTR = 0xd8;
const SM_STRIDE = 0x18;
/** Offsets of the first and the last receive FIFO. */
const RXF0 = 0x20;
const RXF3 = 0x2c;

/** Core cycles of one cycle of a machine. */
function divider(machine) {
  return (machine.clockDivInt || 65_536) + machine.clockDivFrac / 256;
}

/** @typedef {{ machine: any, pio: any, isOn: boolean, isStalled: boolean, due: number }} Timed */

export class PioStepper {
  /** @type {Timed[]} */
  #all;
  /** @type {Timed[]} Machines that are enabled. */
  #on = [];
  /** Cycle of the core at which the next instruction of any machine is due. */
  next = Infinity;
  #now = 0;
  /** Cycles of the core by which it is ahead of the machine that is being stepped: an instruction takes several. */
  ahead = 0;
  #hasResumed = false;
  /** Those that are broken. @type {Set<any>} */
  #stopped = new Set();

  /** @param {any} rp2040 */
  constructor(rp2040) {
    this.#all = rp2040.pio.flatMap((pio) =>
      pio.machines.map((machine) => ({ machine, pio, isOn: false, isStalled: false, due: 0 })),
    );
    for (const pio of rp2040.pio) {
      this.#patch(pio);
    }
  }

  #patch(pio) {
    pio.run = () => {};
    for (const machine of pio.machines) {
      // Restarting the divider changes the phase of a machine by less than one of its cycles.
      machine.clkDivRestart = () => {};
    }
    const read = pio.readUint32.bind(pio);
    pio.readUint32 = (offset) => {
      // A machine may have waited for room in its receive FIFO.
      this.#hasResumed ||= offset >= RXF0 && offset <= RXF3;
      return read(offset);
    };
    const write = pio.writeUint32.bind(pio);
    pio.writeUint32 = (offset, value) => {
      const index = (offset - SM0_INSTR) / SM_STRIDE;
      const forced = Number.isInteger(index) ? pio.machines[index] : undefined;
      if (forced) {
        // A forced instruction takes the place of a stalled one, which rp2040js would go on to wait for.
        forced.waiting = false;
      }
      write(offset, value);
      pio.checkChangedPins();
      this.#refresh();
    };
  }

  /** Looks which machines run, after a register was written. */
  #refresh() {
    for (const timed of this.#all) {
      const { machine } = timed;
      if (machine.enabled && !timed.isOn) {
        timed.due = this.#now;
        timed.isStalled = machine.waiting;
      }
      timed.isOn = machine.enabled;
    }
    this.#on = this.#all.filter((timed) => timed.isOn && !this.#stopped.has(timed.pio));
    this.#hasResumed = true;
    this.#plan();
  }

  #plan() {
    let next = Infinity;
    for (const { machine, due } of this.#on) {
      if (!machine.waiting && due < next) {
        next = due;
      }
    }
    this.next = next;
  }

  /** Stops the machines of a PIO for ever, whatever the firmware does. @param {any} pio */
  stop(pio) {
    this.#stopped.add(pio);
    this.#refresh();
  }

  /** Tells that something outside of the machines has changed that one may have waited for. */
  wake() {
    this.#hasResumed = true;
  }

  /** Runs all machines up to a cycle of the core, in the order of time. @param {number} now */
  advance(now) {
    this.#now = now;
    if (now < this.next && !this.#hasResumed) {
      return;
    }
    if (this.#hasResumed) {
      this.#hasResumed = false;
      this.#resume(now);
    }
    for (let timed = this.#first(); timed && timed.due <= now; timed = this.#first()) {
      this.#step(timed, now);
    }
    this.ahead = 0;
    this.#plan();
  }

  /** The machine whose instruction is due first. @returns {Timed | undefined} */
  #first() {
    let first;
    for (const timed of this.#on) {
      if (timed.machine.enabled && !timed.machine.waiting && !(first && first.due <= timed.due)) {
        first = timed;
      }
    }
    return first;
  }

  /** @param {Timed} timed @param {number} now */
  #step(timed, now) {
    const { machine, pio } = timed;
    const before = machine.cycles;
    const at = timed.due;
    this.ahead = now - at;
    machine.step();
    pio.checkChangedPins();
    timed.due += Math.max(1, machine.cycles - before) * divider(machine);
    timed.isStalled = machine.waiting;
    this.#resume(at);
  }

  /** Continues the machines that something has ended the wait of: the stalled instruction ends in the next cycle, and its
   *  delay follows. @param {number} at */
  #resume(at) {
    for (const timed of this.#on) {
      const { machine } = timed;
      if (timed.isStalled && !machine.waiting) {
        timed.due = at + (1 + Math.max(0, machine.waitDelay)) * divider(machine);
        timed.isStalled = false;
      }
    }
  }
}
