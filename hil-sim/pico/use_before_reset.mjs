// A start that leaves some of the chip running, such as a debugger's, finds peripherals as the last one has left them.
// In this rig each is new, so one that the firmware does not reset itself is an error.

const RESETS = 0x4000c;
/** Peripherals that a start must reset before it uses them, and their bits in RESETS.RESET. */
const MUST_BE_RESET = [
  { at: 0x40034, bit: 22, name: "UART 0" },
  { at: 0x40044, bit: 3, name: "I2C 0" },
  { at: 0x4004c, bit: 0, name: "the ADC" },
  { at: 0x40050, bit: 14, name: "the PWM" },
  { at: 0x50200, bit: 10, name: "PIO 0" },
  { at: 0x50300, bit: 11, name: "PIO 1" },
];

/** Calls `fail` when a peripheral is written before it was reset. @param {any} rp2040 @param {(what: string) => void} fail */
export function watchUseBeforeReset({ peripherals }, fail) {
  let wasReset = 0;
  const watch = (at, hear) => {
    const write = peripherals[at].writeUint32.bind(peripherals[at]);
    peripherals[at].writeUint32 = (offset, value) => {
      hear(offset, value);
      write(offset, value);
    };
  };
  watch(RESETS, (offset, value) => {
    wasReset |= offset === 0 ? value : 0;
  });
  for (const { at, bit, name } of MUST_BE_RESET) {
    watch(at, () => {
      if ((wasReset & (1 << bit)) === 0) {
        fail(`${name} is used before it was reset`);
      }
    });
  }
}
