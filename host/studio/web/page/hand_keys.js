// The keys of the map while it is edited: all that mouse and touch do.
// @ts-check

import { ARROWS } from "./arrows.js";

/** @import { Hands } from "./hands.js" */

/** Keys that select another layer; with Ctrl, the arrow keys do so, too. @type {Record<string, 1 | -1>} */
const OTHERS = { PageDown: 1, PageUp: -1 };
/** @type {Record<string, 1 | -1>} */
const OTHERS_WITH_CTRL = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 };
const STEP_MM = 1;
const LARGE_STEP_MM = 5;
const FINE_STEP_MM = 0.1;
/** Where keys write, and Ctrl+Z is that of the field. */
const FIELDS = ".cm-editor, textarea, select, input:not([type=range], [type=checkbox])";

export class HandKeys {
  #hands;
  /** How far the arrow keys have moved the layer since they are held. */
  #movedMm = [0, 0];

  /** @param {Hands} hands */
  constructor(hands) {
    this.#hands = hands;
    const { surface } = hands.view;
    surface.addEventListener("keydown", (event) => this.#down(event));
    surface.addEventListener("keyup", ({ key }) => key in ARROWS && !hands.isPressed && hands.grip.end());
    addEventListener("keydown", (event) => this.#shortcut(event), { capture: true });
  }

  /** @param {KeyboardEvent} event */
  #down(event) {
    const { key, shiftKey, altKey } = event;
    const hands = this.#hands;
    const isCommand = event.ctrlKey || event.metaKey;
    // What the pointer holds, it alone moves.
    if (hands.isPressed && (key in ARROWS || key in OTHERS)) {
      event.preventDefault();
      return;
    }
    const other = isCommand ? OTHERS_WITH_CTRL[key] : OTHERS[key];
    if (key === "Enter" && isCommand && !altKey) hands.showText();
    else if (other && !altKey && !shiftKey) hands.focusNeighbour(other);
    else if (isCommand) return;
    else if (key in ARROWS && hands.selected) {
      this.#move(ARROWS[key], altKey ? FINE_STEP_MM : shiftKey ? LARGE_STEP_MM : STEP_MM);
    } else if (altKey) return;
    else if (key === "Enter" || key === " ") hands.view.panel.focus();
    else if (key === "F2") hands.focusName();
    else if (key === "Delete" || key === "Backspace") hands.delete();
    else if (key === "Escape") {
      if (hands.grip.hasChanged) hands.grip.cancel();
      else if (hands.selected) hands.focus(undefined);
      else return;
    } else return;
    event.preventDefault();
  }

  /**
   * @param {[number, number]} direction
   * @param {number} stepMm
   */
  #move(direction, stepMm) {
    if (!this.#hands.grip.isHolding) this.#movedMm = [0, 0];
    this.#movedMm = this.#movedMm.map((mm, along) => mm + stepMm * direction[along]);
    const [dx, dy] = this.#movedMm;
    this.#hands.grip.move(dx, dy);
  }

  /**
   * Keys that act wherever the focus is, but in a field or a dialog.
   * @param {KeyboardEvent} event
   */
  #shortcut(event) {
    const { target, ctrlKey, metaKey, altKey, shiftKey, repeat } = event;
    if (!(ctrlKey || metaKey) || altKey || !(target instanceof Element)) return;
    // The fields of the panel write into the text of the scene at once.
    const isOfScene = this.#hands.view.panel.element.contains(target) && !target.matches(".layer-name");
    if (document.querySelector("dialog[open]") || (!isOfScene && target.closest(FIELDS))) return;
    const key = event.key.toLowerCase();
    if (key === "z" || key === "y") this.#hands.undoOrRedo(key === "y" || shiftKey ? "redo" : "undo");
    else if (key === "d" && !shiftKey && this.#hands.selected) {
      // A key that is held makes one copy.
      if (!repeat) this.#hands.duplicate();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
