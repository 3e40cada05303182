// The switch between the modes Feel and Edit: what a press on the map does.
// @ts-check

import { byId, element } from "./dom.js";

export class ModeSwitch {
  #feel = element("button", { type: "button" }, "Feel");
  #edit = element("button", { type: "button", title: "Add, select, move and resize layers on the map" }, "Edit");
  isEditing = false;
  /** Another mode begins. */
  onChange = () => {};

  constructor() {
    const words = "What a press on the map does";
    const group = element("div", { className: "mode", role: "group", "aria-label": words }, this.#feel, this.#edit);
    byId("options").before(group);
    this.#feel.onclick = () => this.set(false);
    this.#edit.onclick = () => this.set(true);
    this.#show();
  }

  /** @param {boolean} isEditing */
  set(isEditing) {
    this.isEditing = isEditing;
    this.#show();
    this.onChange();
  }

  #show() {
    this.#feel.setAttribute("aria-pressed", String(!this.isEditing));
    this.#edit.setAttribute("aria-pressed", String(this.isEditing));
    byId("map").classList.toggle("editing", this.isEditing);
    byId("map-finger").inert = this.isEditing;
  }
}
