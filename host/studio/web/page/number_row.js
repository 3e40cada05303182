// A number of a layer as a slider and a field, and a word of it as a list.
// @ts-check

import { element } from "./dom.js";
import { clamp } from "./place.js";
import { numberText } from "./toml_text.js";

/** @import { LayerChoice, LayerNumber } from "./layer_numbers.js" */

/** Places that a slider has at least. */
const POSITIONS = 100;
/** An end that is a multiple of the last decimal is met in spite of its rounding. */
const CLOSE = 1e-9;

export class NumberRow {
  #number;
  /** The slider is being dragged. */
  #isDragged = false;
  #slider;
  #input;
  /** @type {HTMLElement} */
  element;
  /** It is being changed: `onValue(value)`, until `onEnd()`. */
  onValue = (/** @type {number | string} */ _value) => {};
  onEnd = () => {};

  /**
   * @param {LayerNumber} number
   * @param {string} layer
   */
  constructor(number, layer) {
    const { label, unit, min, max, step, words } = number;
    this.#number = number;
    this.#slider = element("input", { type: "range", step: "any" });
    this.#input = element("input", { type: "number", min, max, step });
    this.nameLayer(layer);
    this.#showEnds();
    const said = element("span", {}, label, element("small", {}, words));
    const behind = element("span", {}, unit);
    this.element = element("div", { className: "layer-number", title: words }, said, this.#slider, this.#input, behind);
    this.#listen();
  }

  /** @param {string} layer */
  nameLayer(layer) {
    const { label, unit } = this.#number;
    const named = unit ? `${label} of ${layer}, ${unit}` : `${label} of ${layer}`;
    this.#slider.setAttribute("aria-label", named);
    this.#input.setAttribute("aria-label", `${named}, as a number`);
  }

  #listen() {
    const [slider, input] = [this.#slider, this.#input];
    slider.oninput = () => {
      this.#isDragged = true;
      this.#change(slider.valueAsNumber, this.#places);
    };
    // An arrow key moves a slider without steps by next to nothing.
    slider.onkeydown = (event) => {
      const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
      if (by === undefined) return;
      event.preventDefault();
      this.#change(slider.valueAsNumber + by * this.#number.step, this.#number.decimals);
    };
    slider.onkeyup = () => this.onEnd();
    slider.onchange = () => {
      this.#isDragged = false;
      this.onEnd();
    };
    slider.onpointercancel = () => (this.#isDragged = false);
    input.oninput = () => {
      const { min, max } = this.#number;
      if (input.value !== "" && input.valueAsNumber >= min && input.valueAsNumber <= max)
        this.onValue(input.valueAsNumber);
    };
    input.onchange = () => {
      this.onEnd();
      // What no scene may have was not taken.
      input.value = this.#text;
    };
  }

  /** Decimals that a drag gives: as many as the slider has places for. */
  get #places() {
    const { decimals, least, most } = this.#number;
    return Math.min(decimals, Math.max(0, Math.ceil(-Math.log10((most - least) / POSITIONS))));
  }

  /**
   * The slider is at this value: rounded, but not beyond its ends, and at an end as close to it as the text can say.
   * @param {number} value
   * @param {number} places
   */
  #change(value, places) {
    const { least, most } = this.#number;
    const rounded = Number(clamp(value, least, most).toFixed(places));
    // The browser keeps 15 digits of an end.
    const close = CLOSE * (most - least);
    const isAtEnd = value < least + close || value > most - close || rounded < least || rounded > most;
    this.onValue(isAtEnd ? inwards(value, this.#number) : rounded);
  }

  get #text() {
    return numberText(this.#number.value, this.#number.decimals);
  }

  /**
   * Shows what the text has now. While the slider is dragged its ends stay, unless the number lies beyond them.
   * @param {LayerNumber} number
   */
  show({ value, path, least, most }) {
    const before = this.#number;
    this.#number = { ...before, value, path, least, most };
    if (this.#isDragged) {
      this.#number.least = Math.min(before.least, least);
      this.#number.most = Math.max(before.most, most);
    }
    this.#showEnds();
    for (const input of [this.#slider, this.#input])
      if (input !== document.activeElement || Number(input.value) !== Number(this.#text)) input.value = this.#text;
  }

  #showEnds() {
    const { least, most } = this.#number;
    Object.assign(this.#slider, { min: String(least), max: String(most) });
  }
}

export class ChoiceRow {
  #label;
  #select;
  /** @type {HTMLElement} */
  element;
  /** As of a number. */
  onValue = (/** @type {number | string} */ _value) => {};
  onEnd = () => {};

  /**
   * @param {LayerChoice} choice
   * @param {string} layer
   */
  constructor(choice, layer) {
    this.#label = choice.label;
    const options = choice.options.map((word) => element("option", { value: word }, word));
    this.#select = element("select", {}, ...options);
    this.#select.onchange = () => {
      this.onValue(this.#select.value);
      this.onEnd();
    };
    const said = element("span", {}, choice.label, element("small", {}, choice.words));
    this.element = element("div", { className: "layer-choice", title: choice.words }, said, this.#select);
    this.nameLayer(layer);
  }

  /** @param {string} layer */
  nameLayer(layer) {
    this.#select.setAttribute("aria-label", `${this.#label} of ${layer}`);
  }

  /** @param {LayerChoice} choice */
  show({ value }) {
    this.#select.value = value;
  }
}

/**
 * A value near the end of a slider, rounded so that it does not lie beyond.
 * @param {number} value
 * @param {LayerNumber} number
 */
function inwards(value, { least, most, decimals }) {
  const unit = 10 ** decimals;
  const [first, last] = [Math.ceil(least * unit - CLOSE) / unit, Math.floor(most * unit + CLOSE) / unit];
  return clamp(Math.round(value * unit) / unit, first, last);
}
