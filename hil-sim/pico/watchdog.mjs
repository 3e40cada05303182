// The watchdog: its clock, and what it does when it fires.
//
// In rp2040js it counts microseconds, whatever its clock is. Here it counts the reference clock, divided as it is told;
// a crystal that stops stops it, unless it counts the ring oscillator.

/** Addresses of peripherals, as rp2040js keys them. */
const WATCHDOG = 0x40058;
const PSM = 0x40010;
/** Offset of the watchdog's TICK, its field CYCLES, and counts in a tick (erratum RP2040-E1). */
const TICK = 0x2c;
const TICK_CYCLES = 0x1ff;
const COUNTS_PER_TICK = 2;
/** CLK_REF_CTRL.SRC: the source of the reference clock is the ring oscillator. */
const REFERENCE_SOURCE = 0x3;
const RING_OSCILLATOR = 0;

/**
 * @param {any} rp2040 @param {{ scratch?: Uint32Array, reason: number }} remains what the last start has left of it
 * @param {{ isCrystalStopped(): boolean, reset(): void, fail(what: string): void }} board
 */
export function patchWatchdog(rp2040, { scratch, reason }, board) {
  const watchdog = rp2040.peripherals[WATCHDOG];
  watchdog.scratchData.set(scratch ?? []);
  watchdog.reason = reason;
  const write = watchdog.writeUint32.bind(watchdog);
  watchdog.writeUint32 = (offset, value) => {
    write(offset, value);
    if (offset === TICK) {
      // rp2040js has ticks of 1 us, whatever clock and divider are.
      watchdog.timer.frequency = (COUNTS_PER_TICK * rp2040.clocks.refFreq) / (value & TICK_CYCLES || 1);
    }
  };
  watchdog.onWatchdogTrigger = () => {
    // rp2040js would trigger again at the same instant for ever.
    watchdog.alarm.enable = false;
    if (board.isCrystalStopped() && (rp2040.clocks.refCtrl & REFERENCE_SOURCE) !== RING_OSCILLATOR) {
      return;
    }
    if (rp2040.peripherals[PSM].wdsel === 0) {
      board.fail("the watchdog has fired, and PSM.WDSEL says that it resets nothing");
    }
    board.reset();
  };
}
