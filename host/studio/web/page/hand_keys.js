// The keys of the map while it is edited: all that mouse and touch do.
// @ts-check

import { element } from "./dom.js";

/** @import { Hands } from "./hands.js" */

/** What is read out at each layer. */
const WORDS =
  "Arrow keys move it by 1 mm, with Shift by 0.1 mm. Tab: next layer. Space: its numbers. Enter: its text. " +
  "Delete removes it. Escape deselects it.";
/** @type {Record<string, [number, number]>} */
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const STEP_MM = 1;
const FINE_STEP_MM = 0.1;

export class HandKeys {
  #hands;
  /** How far the arrow keys have moved the layer since they are held. */
  #movedMm = [0, 0];

  /**
   * @param {HTMLElement} surface The element around the layers.
   * @param {Hands} hands
   * @param {HTMLElement[]} parts Where Ctrl+Z undoes.
   */
  constructor(surface, hands, parts) {
    this.#hands = hands;
    surface.append(element("p", { id: "hands-keys", hidden: true }, WORDS));
    surface.addEventListener("keydown", (event) => this.#down(event));
    surface.addEventListener("keyup", ({ key }) => key in ARROWS && this.#hands.end());
    for (const part of parts) part.addEventListener("keydown", (event) => this.#undo(event), { capture: true });
  }

  /** @param {KeyboardEvent} event */
  #down(event) {
    const { key, shiftKey } = event;
    const hands = this.#hands;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (key in ARROWS && hands.selected) this.#move(ARROWS[key], shiftKey ? FINE_STEP_MM : STEP_MM);
    else if (key === "Tab") {
      if (!hands.focusNeighbour(shiftKey ? -1 : 1)) return;
    } else if (key === "Enter") hands.toText();
    else if (key === " ") hands.focusPanel();
    else if (key === "Delete" || key === "Backspace") hands.delete();
    else if (key === "Escape") {
      if (hands.isHeld) hands.cancel();
      else hands.focus(undefined);
    } else return;
    event.preventDefault();
  }

  /**
   * @param {[number, number]} direction
   * @param {number} stepMm
   */
  #move(direction, stepMm) {
    if (!this.#hands.isHolding) this.#movedMm = [0, 0];
    this.#movedMm = this.#movedMm.map((mm, along) => mm + stepMm * direction[along]);
    const [dx, dy] = this.#movedMm;
    this.#hands.move(dx, dy);
  }

  /** @param {KeyboardEvent} event */
  #undo(event) {
    const key = event.key.toLowerCase();
    if (!(event.ctrlKey || event.metaKey) || (key !== "z" && key !== "y")) return;
    event.preventDefault();
    this.#hands.goBack(key === "y" || event.shiftKey ? "redo" : "undo");
  }
}
