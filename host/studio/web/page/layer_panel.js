// The panel of the mode Edit: place and numbers of the layer that is selected, and layers to add.
// @ts-check

import { element } from "./dom.js";
import { feltLine } from "./felt.js";
import { LayerName } from "./layer_name.js";
import { UNCHECKED } from "./layer_edits.js";
import { ChoiceRow, NumberRow } from "./number_row.js";
import { additions, numberText } from "./toml_text.js";

/** @import { Layer } from "../engine/types" */
/** @import { EditedLayer } from "./edited_layers.js" */
/** @import { Most, Tuned } from "./layer_numbers.js" */
/** @import { Place, Side } from "./place.js" */

/** @typedef {{ nameLayer: (layer: string) => void, show: (about: any) => void }} Row Of numbers or of words. */

/** @type {[Side, string][]} */
const SIDES = [["x", "left"], ["y", "top"], ["width", "width"], ["height", "height"]];
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
  element = element("div", { className: "layer-panel", role: "group", hidden: true });
  /** The field of the name. */
  name = new LayerName();
  /** The kind, where the name does not say it. */
  #kind = element("span", {});
  #note = element("p", { className: "fine note", role: "status" });
  #felt = element("div", { className: "layer-felt" });
  /** Why it is felt or not. It stands below the numbers, so that no number moves when its words change. */
  #why = element("p", { className: "fine layer-why" });
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
  /**
   * A number of the layer is being changed, or a word chosen: `onTuned(about, value)`, until `onEnd()`.
   * @type {(about: Tuned, value: number | string) => void}
   */
  onTuned = () => {};
  /**
   * Likewise a side of its box.
   * @type {(side: Side, mm: number) => void}
   */
  onSide = () => {};
  onEnd = () => {};
  onText = () => {};
  onPlayOnce = () => {};
  onDuplicate = () => {};
  onDelete = () => {};
  onClose = () => {};
  /**
   * A layer is to be added: `onAdd(name)`, one of those that can be.
   * @type {(name: string) => void}
   */
  onAdd = () => {};
  /** Likewise a picture, which has to be chosen first. */
  onPicture = () => {};

  constructor() {
    // A key that is held when the focus leaves is released elsewhere: no keyup is heard here.
    this.element.addEventListener("focusout", () => this.onEnd());
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
    /** @type {HTMLElement | null} */
    const first = this.element.querySelector("input[type=number]") ?? this.element.querySelector("button");
    first?.focus();
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
    this.#kind.textContent = name === kind ? "" : kind;
    for (const [side, label] of SIDES) this.#sides.get(side)?.setAttribute("aria-label", `${label} of ${name}, mm`);
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
    this.#felt.replaceChildren(...(isChecked ? [feltLine(layer, reach)] : []));
    // The sentence begins with the verdict, which the line shows.
    this.#why.textContent = isChecked ? felt.replace(`${perceived?.verdict}: `, "") : "";
  }

  /**
   * Shows what there is to do while no layer is selected.
   * @param {number} count Of the scene's layers.
   * @param {boolean} isNew Whether a layer was selected before.
   */
  showNone(count, isNew) {
    const madeFor = `none of ${Math.min(count, 1)}`;
    if (isNew) this.sayFirst();
    if (madeFor !== this.#madeFor) {
      this.element.setAttribute("aria-label", "Layers to add");
      const hint = element("p", { className: "soft" }, count > 0 ? HINT : EMPTY_HINT);
      this.element.replaceChildren(hint, this.#note, this.#additions());
    }
    this.#madeFor = madeFor;
    this.element.hidden = false;
  }

  hide() {
    this.element.hidden = true;
    this.#madeFor = "";
  }

  /** The buttons that add layers. */
  #additions() {
    const buttons = additions().map(({ name, words, isPicture }) => {
      const onclick = () => (isPicture ? this.onPicture() : this.onAdd(name));
      const about = { title: words, "aria-label": `Add ${name}`, onclick };
      return element("button", about, isPicture ? `${name}…` : name);
    });
    return element("div", { className: "layer-add", role: "group", "aria-label": "Add a layer" }, "Add", ...buttons);
  }

  /**
   * @param {EditedLayer} edited
   * @param {Tuned[]} tuned
   */
  #make({ layer: { name, startsOn }, at }, tuned) {
    this.#sides.clear();
    this.#rows.clear();
    const onclick = () => this.onClose();
    const close = element("button", { "aria-label": "Deselect", title: "Deselect (Escape)", onclick }, "✕");
    const named = at === undefined ? element("b", {}, name) : this.name.element;
    const head = element("div", { className: "layer-panel-head" }, named, this.#kind, close);
    this.element.replaceChildren(head);
    if (at === undefined) this.element.append(this.#note);
    else {
      const sides = SIDES.map(([side, label]) => this.#side(side, label));
      this.element.append(
        this.#felt,
        element("div", { className: "layer-sides" }, ...sides),
        element("div", { className: "layer-numbers" }, ...tuned.map((about) => this.#row(about, name))),
        this.#note,
        this.#why,
        this.#actions(startsOn),
      );
    }
    this.element.append(this.#additions());
    this.element.scrollTop = 0;
  }

  /** @param {boolean} startsOn */
  #actions(startsOn) {
    const action = (/** @type {string} */ words, /** @type {string} */ title, /** @type {() => void} */ onclick) =>
      element("button", { type: "button", title, onclick }, words);
    return element(
      "div",
      { className: "layer-actions" },
      ...(startsOn
        ? []
        : [action("Play once", "Plays this layer, which starts off, under a finger that slides", () => this.onPlayOnce())]),
      action("Duplicate", "A copy beside it (Ctrl+D)", () => this.onDuplicate()),
      action("Text", "To its text (Ctrl+Enter)", () => this.onText()),
      action("Delete", "Take it out (Delete)", () => this.onDelete()),
    );
  }

  /**
   * @param {Side} side
   * @param {string} label
   */
  #side(side, label) {
    const input = element("input", { type: "number", step: 0.5 });
    input.oninput = () => {
      if (input.value !== "" && Number.isFinite(input.valueAsNumber)) this.onSide(side, input.valueAsNumber);
    };
    input.onchange = () => {
      this.onEnd();
      // What is no number was not taken.
      if (input.value === "" && this.#place) input.value = numberText(this.#place.box[side], SIDE_DECIMALS);
    };
    this.#sides.set(side, input);
    return element("label", {}, label, input);
  }

  /**
   * @param {Tuned} about
   * @param {string} layer
   */
  #row(about, layer) {
    const row = "options" in about ? new ChoiceRow(about, layer) : new NumberRow(about, layer);
    row.onValue = (value) => this.onTuned(about, value);
    row.onEnd = () => this.onEnd();
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
