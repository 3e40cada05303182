// The switch between the modes Feel and Edit: what a press on the map does.
// @ts-check

import { byId } from "./dom.js";

export class ModeSwitch {
  isEditing = false;
  /** Another mode begins. */
  onChange = () => {};

  constructor() {
    byId("mode-feel").onclick = () => this.set(false);
    byId("mode-edit").onclick = () => this.set(true);
  }

  /** @param {boolean} isEditing */
  set(isEditing) {
    this.isEditing = isEditing;
    byId("mode-feel").setAttribute("aria-pressed", String(!isEditing));
    byId("mode-edit").setAttribute("aria-pressed", String(isEditing));
    byId("map").classList.toggle("editing", isEditing);
    byId("map-finger").inert = isEditing;
    this.onChange();
  }
}
