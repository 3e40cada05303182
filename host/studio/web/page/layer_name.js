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
    field.onchange = () => {
      const name = field.value.trim();
      field.value = this.#name;
      if (name !== "" && name !== this.#name) this.onName(name);
    };
    field.onkeydown = (event) => {
      if (event.key === "Escape") field.value = this.#name;
      // Enter makes the change first.
      if (event.key === "Enter") field.onchange?.(event);
      if (event.key !== "Enter" && event.key !== "Escape") return;
      event.preventDefault();
      event.stopPropagation();
      this.onLeave();
    };
  }

  /** @param {string} name */
  show(name) {
    this.#name = name;
    Object.assign(this.element, { value: name, size: Math.max(4, name.length) });
    this.element.setAttribute("aria-label", `Name of ${name}`);
  }

  focus() {
    this.element.focus();
    this.element.select();
  }
}
