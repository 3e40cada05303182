// The panel of the mode Edit: place and numbers of the layer that is selected, and layers to add.
// @ts-check

import { byId, element } from "./dom.js";
import { feltLine } from "./felt.js";
import { LayerName } from "./layer_name.js";
import { UNCHECKED } from "./layer_edits.js";
import { ChoiceRow, NumberRow } from "./number_row.js";
import { isSlider } from "./slider_touch.js";
import { additions, numberText } from "./toml_text.js";

/** @import { Layer } from "../engine/types" */
/** @import { EditedLayer } from "./edited_layers.js" */
/** @import { Hands } from "./hands.js" */
/** @import { Most, Tuned } from "./layer_numbers.js" */
/** @import { Place, Side } from "./place.js" */

/** @typedef {{ nameLayer: (layer: string) => void, show: (about: any) => void }} Row Of numbers or of words. */

const SIDE_DECIMALS = 2;
/** Least height of the panel, CSS pixels. */
const LEAST_PX = 220;
/** A scope of this height has room for it, CSS pixels. */
const HIGH_PX = 480;
/** Distance from the edges of what scrolls it, CSS pixels. */
const EDGE_PX = 12;
const HINT =
  "Press a layer to select it, double-click for a larger one here. Drag it to move it, its handles to resize it.";
const EMPTY_HINT = "This scene has no layer yet: add one.";

export class LayerPanel {
  element = byId("layer-panel");
  /** The field of the name. */
  name;
  #note = byId("layer-note");
  /** The fields of the sides of the box. */
  #sides = /** @type {Map<Side, HTMLInputElement>} */ (new Map());
  /** The rows of the numbers, and of the words that are chosen, by field. */
  #rows = /** @type {Map<string, Row>} */ (new Map());
  /** Where the layer is. @type {Place | undefined} */
  #place;
  /** Why a board refuses the scene, or why the scene does not play; empty where it does. */
  refusal = "";
  /** For what the verdict was made. */
  #feltFor = "";
  /** For what the panel was made. */
  #madeFor = "";
  #hands;

  /** @param {Hands} hands That tune, move, double and delete the layer, and add others. */
  constructor(hands) {
    this.#hands = hands;
    this.name = new LayerName(hands);
    this.element.addEventListener("keydown", (event) => this.#key(event));
    // A key that is held when the focus leaves is released elsewhere: no keyup is heard here.
    this.element.addEventListener("focusout", () => hands.grip.end());
    // What was typed before is not taken back with what a finger does now.
    this.element.addEventListener("pointerdown", () => hands.grip.end(), { capture: true });
    // The browser has taken the finger for something else.
    this.element.addEventListener("pointercancel", () => hands.grip.cancel());
    this.element.addEventListener("beforeinput", takeComma);
    /** @type {NodeListOf<HTMLInputElement>} */
    const sides = this.element.querySelectorAll("[data-side]");
    for (const input of sides) this.#addSide(/** @type {Side} */ (input.dataset.side), input);
    byId("deselect").onclick = () => hands.focus(undefined);
    byId("play-once").onclick = () => hands.playOnce();
    byId("duplicate").onclick = () => hands.duplicate();
    byId("layer-text").onclick = () => hands.showText();
    byId("delete-layer").onclick = () => hands.delete();
    const additionButtons = additions().map(({ name, words, isPicture }) => {
      const onclick = () => (isPicture ? hands.onPicture() : hands.add(name));
      const about = { title: words, "aria-label": `Add ${name}`, onclick };
      return element("button", about, isPicture ? `${name}…` : name);
    });
    byId("layer-add").append(...additionButtons);
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    const hands = this.#hands;
    if (event.key === "F2") hands.focusName();
    // A number that is again what it was before is no change to a browser.
    if (event.key === "Enter") hands.grip.end();
    if (event.key !== "Escape") return;
    if (hands.grip.isHolding) {
      event.preventDefault();
      hands.grip.cancel();
      letGo(event.target);
    }
    hands.focus(hands.selected?.key);
  }

  /**
   * Says a sentence at the layer.
   * @param {string} sentence
   */
  set note(sentence) {
    if (this.#note.textContent !== sentence) this.#note.textContent = sentence;
  }

  /**
   * Says what there is to say of a layer before a hand changes it.
   * @param {EditedLayer} [edited]
   */
  sayFirst(edited) {
    this.note = (edited?.at === undefined && edited?.place.whyNotMoved) || this.refusal;
  }

  focus() {
    const first = { none: ".layer-add button", fixed: "#deselect", layer: "[data-side]" };
    /** @type {HTMLElement | null} */
    const found = this.element.querySelector(first[/** @type {keyof typeof first} */ (this.element.dataset.shows)]);
    found?.focus();
  }

  /**
   * @param {EditedLayer} edited
   * @param {Tuned[]} tuned
   * @param {Most} reach That the ends of the sliders are for.
   * @param {boolean} isNew Whether another layer was selected before.
   */
  show(edited, tuned, reach, isNew) {
    const { layer, place, at } = edited;
    this.#place = place;
    // While a layer is selected, its rows stay in their order.
    const fields = tuned.map(({ field }) => field).sort();
    const head = at === undefined ? layer.name : "";
    const madeFor = JSON.stringify([edited.key, head, layer.kind, layer.startsOn, fields, reach.naturalN, reach.reachN]);
    if (isNew) this.sayFirst(edited);
    const isOther = madeFor !== this.#madeFor;
    if (isOther) this.#make(edited, tuned);
    this.#madeFor = madeFor;
    // A name changes in place: the next press, on a slider or a button, is under way.
    this.#nameLayer(layer, isOther);
    for (const [side, input] of this.#sides) {
      // A layer of the whole screen is not moved, but gets a region from either side.
      const isMoved = (side === "x" || side === "y") && !place.isWholeScreen;
      const why = isMoved ? place.whyNotMoved : place.whyNotResized;
      const text = numberText(place.box[side], SIDE_DECIMALS);
      if (input !== document.activeElement || Number(input.value) !== Number(text)) input.value = text;
      input.disabled = why !== "" || (side === "height" && place.keepsRatio);
      input.title = why;
    }
    for (const about of tuned) this.#rows.get(about.field)?.show(about);
    this.#showFelt(layer, reach);
    this.element.hidden = false;
  }

  /**
   * @param {Layer} layer
   * @param {boolean} isOther Whether another layer was shown before.
   */
  #nameLayer({ name, kind }, isOther) {
    this.element.setAttribute("aria-label", `${name}: place and numbers`);
    this.name.show(name, isOther);
    byId("layer-title").textContent = name;
    // Where the name does not say it.
    byId("layer-kind").textContent = name === kind ? "" : kind;
    for (const input of this.#sides.values())
      input.setAttribute("aria-label", `${input.labels?.[0].textContent} of ${name}, mm`);
    for (const row of this.#rows.values()) row.nameLayer(name);
  }

  /**
   * Says whether the layer is felt, as the last check of the scene found.
   * @param {Layer} layer
   * @param {Most} reach
   */
  #showFelt(layer, reach) {
    const { felt, perceived, index } = layer;
    // A person may be about to press what stands there.
    const feltFor = JSON.stringify([index === UNCHECKED, felt, perceived, reach]);
    if (feltFor === this.#feltFor) return;
    this.#feltFor = feltFor;
    const isChecked = index !== UNCHECKED;
    byId("layer-felt").replaceChildren(...(isChecked ? [feltLine(layer, reach)] : []));
    // The sentence begins with the verdict, which the line shows.
    byId("layer-why").textContent = isChecked ? felt.replace(`${perceived?.verdict}: `, "") : "";
  }

  /**
   * Shows what there is to do while no layer is selected.
   * @param {number} count Of the scene's layers.
   * @param {boolean} isNew Whether a layer was selected before.
   */
  showNone(count, isNew) {
    if (isNew) this.sayFirst();
    this.#madeFor = "";
    this.element.dataset.shows = "none";
    this.element.setAttribute("aria-label", "Layers to add");
    byId("layer-hint").textContent = count > 0 ? HINT : EMPTY_HINT;
    this.element.hidden = false;
  }

  hide() {
    this.element.hidden = true;
    this.#madeFor = "";
  }

  /**
   * @param {EditedLayer} edited
   * @param {Tuned[]} tuned
   */
  #make({ layer: { name, startsOn }, at }, tuned) {
    this.#rows.clear();
    byId("layer-numbers").replaceChildren(...tuned.map((about) => this.#row(about, name)));
    byId("play-once").hidden = startsOn;
    this.element.dataset.shows = at === undefined ? "fixed" : "layer";
    this.element.scrollTop = 0;
  }

  /**
   * @param {Side} side
   * @param {HTMLInputElement} input
   */
  #addSide(side, input) {
    const { grip } = this.#hands;
    input.oninput = () => {
      if (input.value !== "" && Number.isFinite(input.valueAsNumber)) grip.setSide(side, input.valueAsNumber);
    };
    input.onchange = () => {
      grip.end();
      // What is no number was not taken.
      if (input.value === "" && this.#place) input.value = numberText(this.#place.box[side], SIDE_DECIMALS);
    };
    this.#sides.set(side, input);
  }

  /**
   * @param {Tuned} about
   * @param {string} layer
   */
  #row(about, layer) {
    const { grip } = this.#hands;
    const { path, decimals } = about;
    const row = "options" in about ? new ChoiceRow(about, layer) : new NumberRow(about, layer);
    row.onValue = (value) => grip.change([{ path, value, decimals }]);
    row.onEnd = () => grip.end();
    this.#rows.set(about.field, row);
    return row.element;
  }

  /**
   * Puts the panel over the scope, or where that is low over the numbers, too: nothing is felt while layers are edited,
   * and neither map nor text is covered. Where all of that is hidden, it lies over what is below the map. It scrolls with
   * them, and is never higher than what scrolls them shows.
   * @param {DOMRect} numbers
   * @param {DOMRect} scope
   * @param {DOMRect} map
   */
  place(numbers, scope, map) {
    const isSeen = scope.width > 0;
    const below = new DOMRect(map.left, map.bottom, map.width, LEAST_PX);
    const first = isSeen ? (scope.height >= HIGH_PX ? scope : numbers) : below;
    const last = isSeen ? scope : below;
    const around = this.element.closest("main");
    if (!around) return;
    const { left, top } = around.getBoundingClientRect();
    const height = Math.max(last.bottom - first.top, LEAST_PX);
    Object.assign(this.element.style, {
      left: `${Math.min(first.left, last.left) - left + around.scrollLeft}px`,
      top: `${first.top - top + around.scrollTop}px`,
      width: `${Math.max(first.right, last.right) - Math.min(first.left, last.left)}px`,
      // It cuts no number in half.
      minHeight: first === numbers ? `${numbers.height}px` : "",
      maxHeight: `${Math.min(height, around.clientHeight - 2 * EDGE_PX)}px`,
    });
  }
}

/**
 * A comma in a number is a point. Browsers leave it out, which makes the number ten times as large.
 * @param {InputEvent} event
 */
function takeComma(event) {
  const { target, data, cancelable } = event;
  const isNumber = target instanceof HTMLInputElement && target.type === "number";
  if (!isNumber || !cancelable || !data?.includes(",")) return;
  event.preventDefault();
  // A field of a number has no selection that a script could replace.
  document.execCommand("insertText", false, data.replaceAll(",", "."));
}

/**
 * A slider that is dragged follows the pointer no more.
 * @param {EventTarget | null} target
 */
function letGo(target) {
  if (!isSlider(target)) return;
  target.disabled = true;
  target.disabled = false;
}
