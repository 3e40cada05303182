// The name of the selected layer, as a field in the head of its panel.
// @ts-check

import { byId } from "./dom.js";

/** @import { Hands } from "./hands.js" */

export class LayerName {
  /** The name that the layer has. */
  #name = "";
  element = byId("layer-name");
  #hands;

  /** @param {Hands} hands That name the layer. */
  constructor(hands) {
    this.#hands = hands;
    const { element: field } = this;
    field.onchange = () => this.commit();
    field.onkeydown = (event) => {
      if (event.key === "Escape") field.value = this.#name;
      // Enter makes the change first.
      if (event.key === "Enter") this.commit();
      if (event.key !== "Enter" && event.key !== "Escape") return;
      event.preventDefault();
      event.stopPropagation();
      hands.focus(hands.selected?.key);
    };
  }

  /** What is typed is the layer's name from now on. */
  commit() {
    const name = this.element.value.trim();
    this.element.value = this.#name;
    if (name !== "" && name !== this.#name) this.#hands.rename(name);
  }

  /**
   * @param {string} name
   * @param {boolean} isOther Whether another layer was shown before: what is typed is not for this one.
   */
  show(name, isOther) {
    if (isOther || this.element.value === this.#name) this.element.value = name;
    this.#name = name;
    this.element.size = Math.max(4, name.length);
    this.element.setAttribute("aria-label", `Name of ${name}`);
  }

  focus() {
    this.element.focus();
    this.element.select();
  }
}
