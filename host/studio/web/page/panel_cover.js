// What the panel of layers lies over: the text is never behind it while a person writes there, and what it covers
// takes neither focus nor presses.
// @ts-check

import { byId } from "./dom.js";

export class PanelCover {
  #panel;
  /** The focus has gone to the text and its tools last. */
  #isWriting = false;

  /** @param {HTMLElement} panel */
  constructor(panel) {
    this.#panel = panel;
    const drawer = byId("drawer");
    // What the bar does leaves the text and its mistakes in sight.
    document.addEventListener("focusin", ({ target }) => {
      if (!(target instanceof Element)) return;
      if (drawer.contains(target)) this.#write(true);
      else if (panel.contains(target) || target.closest(".map-card")) this.#write(false);
    });
    // After the button's own listener.
    document.addEventListener("click", ({ target }) => {
      if (target instanceof Element && target.closest("#toggle-drawer")) this.#write(!drawer.hidden);
    });
    const sizes = new ResizeObserver(() => this.update());
    for (const each of [panel, drawer]) sizes.observe(each);
  }

  /** @param {boolean} isWriting */
  #write(isWriting) {
    if (isWriting === this.#isWriting) return;
    this.#isWriting = isWriting;
    this.update();
  }

  /** The panel was placed anew, or its layer is another one. */
  update() {
    const { classList } = this.#panel;
    classList.remove("gives-way");
    const panel = this.#panel.getBoundingClientRect();
    classList.toggle("gives-way", this.#isWriting && overlap(panel, byId("drawer").getBoundingClientRect()));
    const isSeen = this.#panel.checkVisibility({ visibilityProperty: true });
    for (const each of [byId("numbers"), ...(byId("scope").parentElement?.children ?? [])])
      if (each instanceof HTMLElement) each.inert = isSeen && overlap(panel, each.getBoundingClientRect());
  }
}

/**
 * @param {DOMRect} one
 * @param {DOMRect} other
 */
function overlap(one, other) {
  const isBeside = one.left >= other.right || other.left >= one.right;
  const isAboveOrBelow = one.top >= other.bottom || other.top >= one.bottom;
  return !isBeside && !isAboveOrBelow && one.width > 0 && other.width > 0;
}
