// The outlines of the layers on the map, and the handles of the one that is selected.
// @ts-check

import { element, lay } from "./dom.js";
import { clamp } from "./place.js";
import { numberText } from "./toml_text.js";

/** @import { EditedLayer } from "./edited_layers.js" */
/** @import { Box, Place } from "./place.js" */
/** @typedef {"nw" | "n" | "ne" | "e" | "se" | "s" | "sw" | "w"} Handle */

/** @type {Record<Handle, [number, number]>} Of each handle, the part of the box's width and height. */
const HANDLES = {
  nw: [0, 0], n: [0.5, 0], ne: [1, 0], e: [1, 0.5], se: [1, 1], s: [0.5, 1], sw: [0, 1], w: [0, 0.5],
};
/** A shorter side has no handle of its own, and the handles of so small a box stand outside of it, CSS pixels. */
const LONG_SIDE_PX = 80;
const OUTSIDE_PX = 8;
/** The middle of a handle is at least so far from the edges of the screen, so that all of it is seen, CSS pixels. */
const SEEN_PX = 8;

export class LayerBoxes {
  #parent;
  /** Buttons, by the layers' keys. */
  #buttons = /** @type {Map<string, HTMLButtonElement>} */ (new Map());
  #copies = element("div");
  #handles = /** @type {Handle[]} */ (Object.keys(HANDLES)).map((side) => {
    const handle = element("span", { className: "layer-handle", hidden: true });
    handle.dataset.side = side;
    return handle;
  });
  /**
   * A layer has got the focus.
   * @type {(key: string) => void}
   */
  onFocus = () => {};

  /** @param {HTMLElement} parent */
  constructor(parent) {
    this.#parent = parent;
    parent.append(this.#copies, ...this.#handles);
  }

  /** @param {string | undefined} key */
  focus(key) {
    const button = key === undefined ? undefined : this.#buttons.get(key);
    button?.focus({ preventScroll: true });
  }

  /**
   * The key of the next layer, or that before; without a layer, that of the first, or the last.
   * @param {string | undefined} key
   * @param {1 | -1} by
   */
  neighbour(key, by) {
    const keys = [...this.#buttons.keys()];
    if (key === undefined) return keys.at(by > 0 ? 0 : -1);
    return keys[keys.indexOf(key) + by];
  }

  /**
   * @param {EditedLayer[]} layers
   * @param {string | undefined} selected
   * @param {number} scale CSS pixels of a millimetre.
   */
  show(layers, selected, scale) {
    for (const [key, button] of this.#buttons) {
      if (layers.some((each) => each.key === key)) continue;
      this.#buttons.delete(key);
      button.remove();
    }
    /** @type {HTMLElement[]} */
    const copies = [];
    const buttons = layers.map(({ key }) => this.#buttons.get(key) ?? this.#newButton(key));
    this.#buttons = new Map(layers.map(({ key }, at) => [key, buttons[at]]));
    for (const [at, button] of buttons.entries()) {
      // The layers follow each other as in the text. A button that stays where it is keeps the focus.
      if (this.#parent.children[at] !== button) this.#parent.insertBefore(button, this.#parent.children[at]);
      const each = layers[at];
      const { key, place: { box, copies: offsets } } = each;
      const isSelected = key === selected;
      // The layers are one stop of Tab, so that the panel of each comes next.
      button.tabIndex = isSelected || (selected === undefined && at === 0) ? 0 : -1;
      button.classList.toggle("is-selected", isSelected);
      button.setAttribute("aria-current", String(isSelected));
      button.setAttribute("aria-label", labelOf(each));
      place(button, box, scale);
      for (const [dx, dy] of offsets) {
        if (dx === 0 && dy === 0) continue;
        const copy = element("div", { className: isSelected ? "layer-copy is-selected" : "layer-copy" });
        place(copy, { ...box, x: box.x + dx, y: box.y + dy }, scale);
        copies.push(copy);
      }
    }
    this.#copies.replaceChildren(...copies);
    this.#showHandles(layers.find(({ key }) => key === selected)?.place, scale);
  }

  /**
   * @param {Place | undefined} place
   * @param {number} scale
   */
  #showHandles(place, scale) {
    const [width, height] = place ? [place.box.width * scale, place.box.height * scale] : [0, 0];
    const out = Math.min(width, height) < LONG_SIDE_PX ? OUTSIDE_PX : 0;
    for (const handle of this.#handles) {
      const side = /** @type {Handle} */ (handle.dataset.side);
      const [x, y] = HANDLES[side];
      const isCorner = side.length === 2;
      const isLong = (y === 0.5 ? height : width) >= LONG_SIDE_PX;
      handle.hidden = place?.whyNotResized !== "" || (!isCorner && (place.keepsRatio || !isLong));
      if (!place) continue;
      const [left, top] = [place.box.x * scale + x * width, place.box.y * scale + y * height];
      const { clientWidth, clientHeight } = this.#parent;
      handle.style.left = `${clamp(left + (2 * x - 1) * out, SEEN_PX, clientWidth - SEEN_PX)}px`;
      handle.style.top = `${clamp(top + (2 * y - 1) * out, SEEN_PX, clientHeight - SEEN_PX)}px`;
    }
  }

  /**
   * Marks the layer that a press would select.
   * @param {string | undefined} key
   */
  mark(key) {
    for (const [each, button] of this.#buttons) button.classList.toggle("is-hot", each === key);
  }

  /** @param {string} key */
  #newButton(key) {
    const button = element("button", { className: "layer-box", type: "button", "aria-describedby": "hands-keys" });
    button.onfocus = () => this.onFocus(key);
    return button;
  }
}

/**
 * @param {HTMLElement} made
 * @param {Box} box
 * @param {number} scale
 */
function place(made, { x, y, width, height }, scale) {
  lay(made, { left: x * scale, top: y * scale, width: width * scale, height: height * scale });
}

/** @param {EditedLayer} edited */
function labelOf({ layer: { name, kind }, place: { box, copies, isWholeScreen } }) {
  const [x, y, width, height] = [box.x, box.y, box.width, box.height].map((mm) => numberText(mm, 2));
  const where = isWholeScreen ? "the whole screen" : `${width} by ${height} mm at ${x}, ${y}`;
  const what = name === kind ? [name] : [name, kind];
  return [...what, where, ...(copies.length > 1 ? [`${copies.length} copies`] : [])].join(", ");
}
