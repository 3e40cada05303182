// The numbers that people want: friction in mN and in Weber steps, volts, speed.
// @ts-check

import { byId, volts } from "./dom.js";
import { notify } from "./notices.js";

/** @import { Frame } from "../engine/types" */
/** @import { perception } from "./toml_text.js" */
/** @typedef {{ friction?: number, weber?: number, voltage?: number, speed?: number }} Shown */

/** Numbers are means over this many samples, so that they can be read. */
const SAMPLES = 40;
/** Speeds at which friction is shown and hidden, mm/s. They are apart, so that the numbers do not flicker. */
const SLIDES_ABOVE = 5;
const STANDS_BELOW = 2;
/** What stands in place of the friction of a finger that does not slide: sliding friction is not defined there. */
const SLIDE_TO_FEEL = "slide to feel";

export class Numbers {
  /** @type {Record<string, number>} */
  #means = {};
  #isSliding = false;
  #weberStepsPerE = NaN;
  /** Below this voltage, V rms, the drive adds nothing: what is felt beside bare glass is the finger's own noise. */
  #offBelowVRms = NaN;

  /** A press on the name of a number says what it means, as the title of both does. */
  constructor() {
    for (const button of byId("numbers").querySelectorAll("button"))
      button.onclick = () => {
        const meaning = button.closest("div")?.title;
        notify(`${button.textContent}: ${meaning}`, undefined, { isGood: true, beside: button });
      };
  }

  /**
   * The engine is there, and says what a noticeable step is.
   * @param {ReturnType<typeof perception>} perception
   */
  know({ weberStepsPerE, weberStep, offBelowVRms }) {
    this.#weberStepsPerE = weberStepsPerE;
    this.#offBelowVRms = offBelowVRms;
    const row = byId("number-weber").closest("div");
    if (row) row.title += ` ${weberStep}`;
  }

  /**
   * @param {Frame} frame
   * @param {number} naturalN
   */
  feel({ feltN, voltageV, speedMmPerS, contact }, naturalN) {
    /** @type {Shown} */
    const values = { voltage: this.#mean("voltage", voltageV), speed: this.#mean("speed", speedMmPerS) };
    this.#followSlide(values.speed);
    if (this.#isSliding) {
      const felt = this.#mean("felt", feltN);
      if (felt !== undefined)
        Object.assign(values, { friction: felt * 1000, weber: this.#weberSteps(felt, naturalN, values.voltage) });
    }
    this.#show(contact ? values : { voltage: 0 });
    if (contact) return;
    this.#means = {};
    this.#isSliding = false;
  }

  /**
   * Weber steps above bare glass.
   * @param {number} feltN
   * @param {number} naturalN
   * @param {number} [voltageVRms]
   */
  #weberSteps(feltN, naturalN, voltageVRms = Infinity) {
    return voltageVRms < this.#offBelowVRms ? 0 : Math.log(feltN / naturalN) * this.#weberStepsPerE;
  }

  /**
   * A finger that has come to a standstill is felt anew at its next slide: the friction before is of another slide.
   * @param {number | undefined} speedMmPerS
   */
  #followSlide(speedMmPerS) {
    if (speedMmPerS === undefined) return;
    if (speedMmPerS > SLIDES_ABOVE) this.#isSliding = true;
    if (!(speedMmPerS < STANDS_BELOW)) return;
    this.#isSliding = false;
    delete this.#means.felt;
  }

  /**
   * @param {string} name
   * @param {Float32Array} values
   * @returns {number | undefined}
   */
  #mean(name, values) {
    for (const value of values) {
      if (!Number.isFinite(value)) continue;
      const before = this.#means[name] ?? value;
      this.#means[name] = before + (value - before) / SAMPLES;
    }
    return this.#means[name];
  }

  /** @param {Shown} numbers */
  #show({ friction, weber, voltage, speed }) {
    const isStill = speed !== undefined && friction === undefined;
    this.#write("friction", friction, 0, isStill);
    this.#write("weber", weber, 1, isStill);
    this.#write("voltage", voltage, volts);
    this.#write("speed", speed, 0);
  }

  /**
   * Writes a number, or what to do to get one.
   * @param {string} name
   * @param {number | undefined} number
   * @param {number | ((number: number) => string)} digits How many digits, or what writes it.
   */
  #write(name, number, digits, isStill = false) {
    const value = byId(`number-${name}`);
    // Where nothing is added, noise takes what is felt below bare glass: never below zero.
    const write = typeof digits === "number" ? (/** @type {number} */ value) => value.toFixed(digits) : digits;
    const text = number !== undefined && Number.isFinite(number) ? write(Math.max(0, number)) : "–";
    const shown = isStill ? SLIDE_TO_FEEL : text;
    // What has not changed is not drawn again.
    if (value.textContent === shown) return;
    value.textContent = shown;
    value.parentElement?.classList.toggle("words", isStill);
    value.parentElement?.querySelector("small")?.toggleAttribute("hidden", isStill);
  }
}
