// The name of the selected layer, as a field in the head of its panel.
// @ts-check

import { NAME_MAX, element } from "./dom.js";

export class LayerName {
  /** The name that the layer has. */
  #name = "";
  element = element("input", { className: "layer-name", type: "text", maxLength: NAME_MAX, title: "Name (F2)" });
  /** The layer is to have this name. @type {(name: string) => void} */
  onName = () => {};
  /** Nothing more is to be written: the keys act on the layer. */
  onLeave = () => {};

  constructor() {
    const { element: field } = this;
    field.onchange = () => this.commit();
    field.onkeydown = (event) => {
      if (event.key === "Escape") field.value = this.#name;
      // Enter makes the change first.
      if (event.key === "Enter") this.commit();
      if (event.key !== "Enter" && event.key !== "Escape") return;
      event.preventDefault();
      event.stopPropagation();
      this.onLeave();
    };
  }

  /** What is typed is the layer's name from now on. */
  commit() {
    const name = this.element.value.trim();
    this.element.value = this.#name;
    if (name !== "" && name !== this.#name) this.onName(name);
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
