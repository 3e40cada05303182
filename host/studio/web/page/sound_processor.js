// Runs in the audio thread: turns the change of felt friction, at 40 kHz, into sound.
// @ts-check

/** Samples that wait in the ring; two seconds. */
const CAPACITY = 80_000;
/** What is buffered before playing, s of sound: friction comes in steps of 8 ms and more. */
const DELAY_S = 0.06;
/** Loudness: newtons to the range of -1 to 1. */
const GAIN_PER_N = 12;
/** Pitched up by this factor, and the length of the grains for it, s. */
const PITCH = 4;
const GRAIN_S = 0.12;

class FrictionSound extends AudioWorkletProcessor {
  #ring = new Float32Array(CAPACITY);
  #written = 0;
  #read = -1;
  /** Samples of friction for one of sound. */
  #perSample = 1;
  #mode = "headphones";
  #grain = 0;

  constructor() {
    super();
    this.port.onmessage = ({ data }) => {
      if (data.mode) this.#mode = data.mode;
      else this.#take(data);
    };
  }

  /** @param {{ samples: Float32Array, samplesPerS: number }} change */
  #take({ samples, samplesPerS }) {
    this.#perSample = samplesPerS / sampleRate;
    for (const sample of samples) {
      this.#ring[this.#written % CAPACITY] = sample;
      this.#written += 1;
    }
    const delay = DELAY_S * this.#perSample * sampleRate;
    // After a pause, or where the clocks drift apart, play on from the usual delay.
    const ahead = this.#written - this.#read;
    if (this.#read < 0 || ahead > 4 * delay + samples.length) this.#read = Math.max(0, this.#written - delay);
  }

  /** @param {number} place */
  #at(place) {
    const whole = Math.floor(place);
    if (whole < 0 || whole + 1 >= this.#written || this.#written - whole > CAPACITY) return 0;
    const low = this.#ring[whole % CAPACITY];
    return low + (place - whole) * (this.#ring[(whole + 1) % CAPACITY] - low);
  }

  /** Two overlapping grains that are read faster than they were written. */
  #pitched() {
    const length = GRAIN_S * sampleRate * this.#perSample;
    this.#grain = (this.#grain + (PITCH - 1) * this.#perSample) % length;
    const grain = (/** @type {number} */ offset) => {
      const phase = (this.#grain + offset) % length;
      const window = 0.5 - 0.5 * Math.cos((2 * Math.PI * phase) / length);
      return window * this.#at(this.#read - length + phase);
    };
    return grain(0) + grain(length / 2);
  }

  /**
   * @param {Float32Array[][]} _inputs
   * @param {Float32Array[][]} outputs
   */
  process(_inputs, [[output]]) {
    for (let at = 0; at < output.length; at += 1) {
      if (this.#read < 0 || this.#read + this.#perSample >= this.#written - 1) {
        output[at] = 0;
        continue;
      }
      this.#read += this.#perSample;
      const now = this.#mode === "pitched" ? this.#pitched() : this.#at(this.#read);
      const sound = this.#mode === "noise" ? 3 * Math.max(0, now) * (2 * Math.random() - 1) : now;
      output[at] = Math.tanh(GAIN_PER_N * sound);
    }
    return true;
  }
}

registerProcessor("friction-sound", FrictionSound);
