// The words between this process and `frixel-hil-sim` (src/emulated/pico/protocol.rs): little-endian, 32 bits each, in
// messages that begin with the number of words that follow.

/** First word of a request. */
export const REQUEST = {
  /** Run for a time, with these inputs: ns, max instructions, inputs, monitor code, DAC's output bits, bytes... */
  RUN: 1,
  /** Cut the power and switch it on again: seed of what RAM holds then. */
  POWER_CYCLE: 2,
  /** Pull the RUN pin low and let it go: RAM stays. */
  RUN_PIN: 3,
  /** Stop the core for ever: its clock goes on, as in a loop without interrupts. */
  HANG: 4,
  /** Let the main loop hang, and interrupts go on. */
  HANG_MAIN_LOOP: 5,
  /** Jump to an address. */
  JUMP: 6,
  /** The address of a function: bytes of its name. */
  ADDRESS_OF: 8,
  /** Stop the crystal for ever: core and state machines stand still, pins stay as they are. */
  STOP_CRYSTAL: 9,
  /** Stop the state machines of a PIO for ever: its number. */
  STOP_PIO: 10,
  /** Write the flash, as another image has before: offset, and bytes. */
  WRITE_FLASH: 11,
  /** Note the calls of a function from now on: its address, and how many words to read of what its first argument points
   *  at. */
  WATCH: 12,
  /** The calls since the last time, in their order: of each the number of its function, counted from 0 in the order of
   *  `WATCH`, and the words. */
  TAKE_CALLS: 13,
  /** The touch frame's answer to the last event of a run that ended with `FRAME_ASKED`: 0 or 1, whether it
   *  acknowledges, or the byte that it sends. */
  ANSWER_I2C: 14,
};

/** Bits of the inputs: levels, and I2C lines that others hold low. */
export const INPUT = { READY: 1, ARM: 2, FRAME_READY: 4, SDA_HELD: 8, SCL_HELD: 16 };

/** Why a run ended: first word of its answer. */
export const ENDED = {
  /** The time has passed. */
  TIME: 0,
  /** SYNC rose. */
  FRAME: 1,
  /** So many instructions were carried out. */
  INSTRUCTIONS: 2,
  /** The board has reset itself. */
  RESET: 3,
  /** The touch frame is asked for an answer, or hears that a transfer or a clock has ended. */
  FRAME_ASKED: 4,
};

/** Kinds of events; each has the time since the beginning of the run in ns, and two values. */
export const EVENT = {
  /** SYNC rose: the last 32 bits of the frame; number of clocks (upper 8 bits) and for how many ns SYNC was low. */
  FRAME: 1,
  /** The amplifier's enable: level. */
  ENABLE: 2,
  /** The DAC's CLEAR: level. */
  CLEAR: 3,
  /** The light: level. */
  LED: 4,
  /** The board starts: cause. */
  START: 5,
  /** The firmware reads the amplifier's monitor: ns since SYNC rose last. */
  MONITOR_READ: 7,
  /** A transfer on I2C begins, and waits for an acknowledgement: address; 1 if it reads. */
  I2C_ADDRESS: 8,
  /** A byte on I2C waits for an acknowledgement: the byte. */
  I2C_WRITE: 9,
  /** The controller reads a byte on I2C. */
  I2C_READ: 10,
  /** A transfer on I2C ends. */
  I2C_STOP: 11,
  /** The firmware itself sets SCL: level. */
  SCL: 12,
};

/** Why a board starts. */
export const CAUSE = { POWER: 1, RUN_PIN: 2, WATCHDOG: 3, SOFTWARE: 4 };

/** Bits a second on the line between host and board. */
export const BAUD = 2_000_000;
