// The panel at the layer that is selected on the map: its place and its numbers as fields and sliders.
// @ts-check

import { element } from "./dom.js";
import { clamp } from "./place.js";
import { numberText } from "./toml_text.js";

/** @import { EditedLayer } from "./edited_layers.js" */
/** @import { LayerNumber, Most } from "./layer_numbers.js" */
/** @import { Side } from "./place.js" */

/** @type {[Side, string][]} */
const SIDES = [["x", "left"], ["y", "top"], ["width", "width"], ["height", "height"]];
/** Least height of the panel, CSS pixels. */
const LEAST_PX = 220;
/** Places that a slider has at least. */
const POSITIONS = 100;

export class LayerPanel {
  element = element("div", { className: "layer-panel", role: "group", hidden: true });
  #note = element("p", { className: "fine", role: "status" });
  /** The fields, by name, for the layer that they were made for. */
  #fields = /** @type {Map<string, HTMLInputElement[]>} */ (new Map());
  #madeFor = "";
  /** What the text has, by field, as it was shown last. */
  #shown = /** @type {Map<string, string>} */ (new Map());
  /**
   * A number of the layer is being changed: `onNumber(number, value)`, until `onEnd()`.
   * @type {(number: LayerNumber, value: number) => void}
   */
  onNumber = () => {};
  /**
   * Likewise a side of its box.
   * @type {(side: Side, mm: number) => void}
   */
  onSide = () => {};
  onEnd = () => {};
  onText = () => {};
  onDelete = () => {};
  onClose = () => {};

  constructor() {
    // A key that is held is let go elsewhere, where no keyup is heard.
    this.element.addEventListener("focusout", () => this.onEnd());
  }

  /**
   * Says a sentence at the layer.
   * @param {string} sentence
   */
  set note(sentence) {
    this.#note.textContent = sentence;
  }

  focus() {
    this.element.querySelector("input")?.focus();
  }

  /**
   * @param {EditedLayer} edited
   * @param {LayerNumber[]} numbers
   * @param {Most} reach That the ends of the sliders are for.
   * @param {boolean} isNew Whether another layer was selected before.
   */
  show(edited, numbers, { naturalN, reachN }, isNew) {
    const { layer, place, at } = edited;
    const fields = numbers.map(({ field }) => field);
    const madeFor = JSON.stringify([edited.key, layer.name, layer.kind, fields, naturalN, reachN]);
    if (isNew) this.note = at === undefined ? place.whyNotMoved : "";
    if (madeFor !== this.#madeFor) this.#make(edited, numbers);
    this.#madeFor = madeFor;
    for (const [side] of SIDES) {
      // A layer of the whole screen is not moved, but gets a region from either side.
      const isMoved = (side === "x" || side === "y") && !place.isWholeScreen;
      const why = isMoved ? place.whyNotMoved : place.whyNotResized;
      const isKept = side === "height" && place.keepsRatio;
      this.#update(side, numberText(place.box[side], 2), why !== "" || isKept, why);
    }
    for (const number of numbers) this.#update(number.field, numberText(number.value, number.decimals), false, "");
    this.element.hidden = false;
  }

  hide() {
    this.element.hidden = true;
    this.#madeFor = "";
  }

  /**
   * @param {string} name
   * @param {string} text
   * @param {boolean} isDisabled
   * @param {string} why
   */
  #update(name, text, isDisabled, why) {
    this.#shown.set(name, text);
    for (const input of this.#fields.get(name) ?? []) {
      if (input !== document.activeElement || Number(input.value) !== Number(text)) input.value = text;
      input.disabled = isDisabled;
      input.title = why;
    }
  }

  /**
   * @param {EditedLayer} edited
   * @param {LayerNumber[]} numbers
   */
  #make({ layer: { name, kind }, at }, numbers) {
    this.#fields.clear();
    this.element.setAttribute("aria-label", `${name}: place and numbers`);
    const text = element("button", { title: "To its text (Enter)", onclick: () => this.onText() }, "Text");
    const gone = element("button", { title: "Take it out (Delete)", onclick: () => this.onDelete() }, "Delete");
    const close = element("button", { "aria-label": "Deselect", onclick: () => this.onClose() }, "✕");
    const title = element("span", {}, element("b", {}, name), name === kind ? "" : ` ${kind}`);
    const head = element("div", { className: "layer-panel-head" }, title);
    this.element.replaceChildren(head, this.#note);
    if (at !== undefined) {
      head.append(text, gone);
      const sides = SIDES.map(([side, label]) => this.#side(side, label, name));
      const rows = numbers.map((number) => this.#row(number, name));
      this.element.append(
        element("div", { className: "layer-sides" }, ...sides),
        element("div", { className: "layer-numbers" }, ...rows),
      );
    }
    head.append(close);
  }

  /**
   * @param {Side} side
   * @param {string} label
   * @param {string} layer
   */
  #side(side, label, layer) {
    const input = element("input", { type: "number", step: 0.5, "aria-label": `${label} of ${layer}, mm` });
    input.oninput = () => {
      if (input.value !== "" && Number.isFinite(input.valueAsNumber)) this.onSide(side, input.valueAsNumber);
    };
    input.onchange = () => this.onEnd();
    this.#fields.set(side, [input]);
    return element("label", {}, label, input);
  }

  /**
   * @param {LayerNumber} number
   * @param {string} layer
   */
  #row(number, layer) {
    const { field, label, unit, min, max, step, least, most, decimals } = number;
    const words = unit ? `${label} of ${layer}, ${unit}` : `${label} of ${layer}`;
    const slider = element("input", { type: "range", min: least, max: most, step: "any", "aria-label": words });
    const input = element("input", { type: "number", min, max, step, "aria-label": `${words}, as a number` });
    const places = Math.min(decimals, Math.max(0, Math.ceil(-Math.log10((most - least) / POSITIONS))));
    slider.oninput = () => this.onNumber(number, Number(slider.valueAsNumber.toFixed(places)));
    // An arrow key moves a slider without steps by next to nothing.
    slider.onkeydown = (event) => {
      const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
      if (by === undefined) return;
      event.preventDefault();
      const value = clamp(Number((slider.valueAsNumber + by * step).toFixed(decimals)), least, most);
      this.onNumber(number, value);
    };
    slider.onkeyup = () => this.onEnd();
    input.oninput = () => {
      if (input.value !== "" && input.valueAsNumber >= min && input.valueAsNumber <= max)
        this.onNumber(number, input.valueAsNumber);
    };
    slider.onchange = () => this.onEnd();
    input.onchange = () => {
      this.onEnd();
      // What no scene may have was not taken.
      input.value = this.#shown.get(field) ?? "";
    };
    this.#fields.set(field, [slider, input]);
    const [before, behind] = [element("span", {}, label), element("span", {}, unit)];
    return element("div", { className: "layer-number" }, before, slider, input, behind);
  }

  /**
   * Puts the panel over what shows what a finger feels: nothing is felt while layers are edited, and neither map nor
   * text is covered. Where all of that is hidden, it lies over what is below the map.
   * @param {DOMRect[]} felt
   * @param {DOMRect} map
   */
  place(felt, map) {
    const seen = felt.filter(({ width }) => width > 0);
    const covered = seen.length > 0 ? seen : [new DOMRect(map.left, map.bottom, map.width, LEAST_PX)];
    const left = Math.min(...covered.map((each) => each.left));
    const top = Math.min(...covered.map((each) => each.top));
    const right = Math.max(...covered.map((each) => each.right));
    const bottom = Math.max(...covered.map((each) => each.bottom));
    Object.assign(this.element.style, {
      left: `${left + scrollX}px`,
      top: `${top + scrollY}px`,
      width: `${right - left}px`,
      maxHeight: `${Math.max(bottom - top, LEAST_PX)}px`,
    });
  }
}
