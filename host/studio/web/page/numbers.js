// The numbers that people want: friction in mN and in Weber steps, volts, speed.

import { byId, element } from "./dom.js";

/** Smallest change of friction that a finger feels: a factor of 1.11 (Gueorguiev 2017, doi:10.1098/rsif.2017.0641). */
const WEBER_STEP = Math.log(1.11);
/** Numbers are means over this many samples, so that they can be read. */
const SAMPLES = 40;

export class Numbers {
  #fields = {};
  #means = {};

  constructor() {
    const add = (key, title, unit, meaning, kind = "") => {
      const value = element("span");
      this.#fields[key] = value;
      byId("numbers").append(
        element(
          "div",
          { title: meaning },
          element("dt", {}, title),
          element("dd", { className: kind }, value, " ", element("small", {}, unit)),
        ),
      );
    };
    const wanders = "It wanders with the simulated finger's load and noise, also below the map's scale.";
    add("friction", "Felt friction", "mN", `Friction that the simulated finger feels. ${wanders}`, "felt");
    const step = "A Weber step is a factor of 1.11, about the smallest change of friction that a finger feels.";
    add("weber", "Above bare glass", "Weber steps", `${step} ${wanders}`, "felt");
    add("voltage", "Drive", "V rms", "Voltage on the electrode: it adds friction, and takes none away.", "voltage");
    add("speed", "Speed", "mm/s", "Speed of the simulated finger.");
    this.#show({});
  }

  feel({ feltN, voltageV, speedMmPerS, contact }, naturalN) {
    const felt = this.#mean("felt", feltN);
    const values = { voltage: this.#mean("voltage", voltageV), speed: this.#mean("speed", speedMmPerS) };
    if (contact && felt > 0)
      Object.assign(values, { friction: felt * 1000, weber: Math.log(felt / naturalN) / WEBER_STEP });
    this.#show(contact ? values : { voltage: 0 });
    if (!contact) this.#means = {};
  }

  #mean(name, values) {
    for (const value of values) {
      if (!Number.isFinite(value)) continue;
      const before = this.#means[name] ?? value;
      this.#means[name] = before + (value - before) / SAMPLES;
    }
    return this.#means[name];
  }

  #show({ friction, weber, voltage, speed }) {
    const text = (value, digits) =>
      Number.isFinite(value) ? (Math.abs(value) < 0.05 ? 0 : value).toFixed(digits) : "–";
    this.#fields.friction.textContent = text(friction, 0);
    this.#fields.weber.textContent = text(weber, 1);
    this.#fields.voltage.textContent = text(voltage, 0);
    this.#fields.speed.textContent = text(speed, 0);
  }
}
