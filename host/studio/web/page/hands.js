// Hands on the map: in the mode *Edit* layers are selected, moved, resized and tuned, and their text changes with them.
// @ts-check

import { byId, element, sentenceOf } from "./dom.js";
import { EditedLayers } from "./edited_layers.js";
import { HandDrag, withSide } from "./hand_drag.js";
import { HandKeys } from "./hand_keys.js";
import { LayerBoxes } from "./layer_boxes.js";
import { layerNumbers } from "./layer_numbers.js";
import { LayerPanel } from "./layer_panel.js";
import { notify } from "./notices.js";

/** @import { Checked, Files } from "../engine/types" */
/** @import { Schema } from "./completion.js" */
/** @import { EditedLayer } from "./edited_layers.js" */
/** @import { Editor } from "./editor.js" */
/** @import { HeldChange } from "./held_change.js" */
/** @import { Most } from "./layer_numbers.js" */
/** @import { Area, FrictionMap } from "./map.js" */
/** @import { Box } from "./place.js" */
/** @import { Player } from "./player.js" */
/** @import { Project } from "./project.js" */
/** @import { Change } from "./toml_text.js" */
/** @typedef {{ map: FrictionMap, editor: Editor, player: Player, project: Project }} Parts */
/**
 * A change that a hand is making: of which layer, as it was before.
 * @typedef {{ held: HeldChange, from: EditedLayer }} Grip
 */

const ELSEWHERE = "The text has changed: its layers are read again once it has no mistake.";

export class Hands {
  #parts;
  #schema;
  #layers;
  #boxes;
  #panel = new LayerPanel();
  #surface = element("div", { className: "hands", role: "group", tabIndex: -1, hidden: true, "aria-label": "Layers" });
  #buttons = ["Feel", "Edit"].map((words) => element("button", { type: "button", "aria-pressed": "false" }, words));
  /** @type {string | undefined} */
  #selected;
  /** @type {Grip | undefined} */
  #grip;
  #reach = /** @type {Most} */ ({ naturalN: 0.25, lowN: 0.25, highN: 0.38, reachN: 0.38 });
  isEditing = false;
  /** Why the scene that plays cannot be edited here, or "". */
  #whyNot = "";
  /** The scene that the layers are of, as the project counts them. */
  #opened = 0;
  /** The mode Edit begins: the map is no longer for sliding. */
  onEdit = () => {};

  /**
   * @param {Parts} parts
   * @param {Schema} schema
   */
  constructor(parts, schema) {
    this.#parts = parts;
    this.#schema = schema;
    this.#layers = new EditedLayers(parts.editor);
    this.#boxes = new LayerBoxes(this.#surface);
    const { box, onLayout } = parts.map;
    const words = "Press a layer to select it. Drag it to move it, its handles to resize it.";
    box.append(this.#surface, element("p", { className: "hint hands-hint" }, words));
    document.body.append(this.#panel.element);
    this.#makeSwitch();
    new HandDrag(this.#surface, this, parts.map);
    new HandKeys(this.#surface, this, [box, this.#panel.element]);
    this.#listen();
    parts.map.onLayout = (area) => {
      onLayout(area);
      this.#lay(area);
    };
  }

  #makeSwitch() {
    const [feel, edit] = this.#buttons;
    edit.title = "Select, move and resize the layers on the map";
    feel.onclick = () => this.setEditing(false);
    edit.onclick = () => this.setEditing(true);
    const words = "What a press on the map does";
    byId("options").before(element("div", { className: "mode", role: "group", "aria-label": words }, feel, edit));
    this.setEditing(false);
  }

  #listen() {
    this.#surface.addEventListener("focusout", () => this.end());
    this.#panel.element.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      this.end();
      this.#boxes.focus(this.#selected);
    });
    this.#boxes.onFocus = (key) => this.select(key);
    this.#panel.onNumber = ({ path, decimals }, value) => this.change([{ path, value, decimals }]);
    this.#panel.onSide = (side, mm) => this.#toSide(side, mm);
    this.#panel.onEnd = () => this.end();
    this.#panel.onText = () => this.toText();
    this.#panel.onDelete = () => this.delete();
    this.#panel.onClose = () => this.focus(undefined);
  }

  /** @param {boolean} isEditing */
  setEditing(isEditing) {
    if (isEditing && this.#whyNot) {
      this.#refuse();
      return;
    }
    this.end();
    this.isEditing = isEditing;
    const [feel, edit] = this.#buttons;
    feel.setAttribute("aria-pressed", String(!isEditing));
    edit.setAttribute("aria-pressed", String(isEditing));
    this.#surface.hidden = !isEditing;
    byId("map").classList.toggle("editing", isEditing);
    byId("map-finger").inert = isEditing;
    if (isEditing) this.onEdit();
    else this.#selected = undefined;
    this.#draw(true);
  }

  /**
   * Takes the layers of a scene that was checked. Where their texts cannot be read here, the scene plays all the same,
   * and is not edited on the map.
   * @param {Checked} check
   * @param {Files} files That were checked.
   */
  show(check, files) {
    if (this.isHolding) return;
    try {
      this.#take(check, files);
      this.#whyNot = "";
    } catch (error) {
      this.#whyNot = `This scene is edited in its text, not on the map: ${sentenceOf(error)}.`;
      if (this.isEditing) this.#refuse();
    }
  }

  /** Says why there is no mode Edit, and leaves it. */
  #refuse() {
    notify(this.#whyNot, undefined, { beside: this.#buttons[1] });
    this.setEditing(false);
  }

  /**
   * @param {Checked} check
   * @param {Files} files
   */
  #take(check, files) {
    const { editor, project } = this.#parts;
    this.#reach = check;
    const before = this.selected;
    if (!this.#layers.take(check, files, project.entry)) return;
    const isSameScene = project.opened === this.#opened;
    this.#opened = project.opened;
    const after = before && isSameScene ? this.#layers.successor(before) : undefined;
    this.#reselect(after?.key);
    // What is selected stands in the text that is shown.
    if (!editor.has(this.selected?.layer.file)) this.#panel.hide();
  }

  /**
   * The layer that is selected has another key: layers before it came or went.
   * @param {string | undefined} key
   */
  #reselect(key) {
    const hasFocus = this.#surface.contains(document.activeElement);
    const isOther = key !== this.#selected;
    this.#selected = key;
    this.#draw(isOther);
    // The keys act on what is selected.
    if (isOther && hasFocus) this.focus(key);
  }

  /** Whether a hand is changing a layer. */
  get isHeld() {
    return this.#parts.player.isHeld;
  }

  get selected() {
    return this.#layers.find(this.#selected);
  }

  /** @param {string | undefined} key */
  select(key) {
    if (key === this.#selected) return;
    this.end();
    this.#selected = key;
    this.#draw(true);
  }

  /**
   * Selects a layer and gives it the focus, so that the keys act on it.
   * @param {string | undefined} key
   */
  focus(key) {
    this.select(key);
    if (key === undefined) this.#surface.focus({ preventScroll: true });
    else this.#boxes.focus(key);
  }

  /**
   * The layers under a place, that which a press selects first.
   * @param {number} xMm
   * @param {number} yMm
   * @param {number} nearMm
   */
  under(xMm, yMm, nearMm) {
    return this.#layers.under(xMm, yMm, nearMm);
  }

  /** @param {EditedLayer | undefined} edited */
  mark(edited) {
    this.#boxes.mark(edited?.key);
  }

  /** @param {string} sentence */
  say(sentence) {
    this.#panel.note = sentence;
  }

  get isHolding() {
    return this.#grip !== undefined && !this.#grip.held.isOver;
  }

  /**
   * Begins a change of the layer that is selected, or goes on with it; returns what it was before. Where it cannot be
   * changed now, says why.
   */
  grip() {
    if (this.#grip && this.isHolding) return this.#grip.from;
    if (this.#grip) this.end();
    const from = this.selected;
    if (!from || from.at === undefined) return undefined;
    if (!this.#layers.isCurrent) {
      this.say(ELSEWHERE);
      return undefined;
    }
    this.#grip = { from, held: this.#parts.editor.hold(from.layer.file) };
    return from;
  }

  /**
   * Makes changes of the layer as it was before, in place of those that this hand made last.
   * @param {Change[]} changes
   * @param {Box} [box] Where its first copy is then, where its text does not say that.
   */
  change(changes, box) {
    const from = this.grip();
    if (!from?.toml || !this.#grip) return;
    const { player } = this.#parts;
    const replacements = from.toml.replacements(changes);
    if (replacements.length === 0 && !player.isHeld) return;
    player.hold();
    this.#grip.held.make(replacements);
    this.#layers.reread(from, box);
    this.#draw(false);
  }

  /** Takes back what this hand has changed since it began. */
  cancel() {
    if (this.#grip && this.#parts.player.isHeld) this.change([], this.#grip.from.place.box);
    this.end();
  }

  /** The hand lets go: the scene plays as it is now. */
  end() {
    const grip = this.#grip;
    if (!grip) return;
    this.#grip = undefined;
    grip.held.end();
    const { player, editor } = this.#parts;
    if (player.isHeld) player.release(editor.text);
  }

  /**
   * Moves the selected layer from where it was when the change began.
   * @param {number} dxMm
   * @param {number} dyMm
   */
  move(dxMm, dyMm) {
    const place = this.grip()?.place;
    if (!place) return;
    if (place.whyNotMoved) {
      this.say(place.whyNotMoved);
      return;
    }
    const { x, y, width, height } = place.box;
    this.change(place.move(dxMm, dyMm), place.isWholeScreen ? undefined : { x: x + dxMm, y: y + dyMm, width, height });
  }

  /** @param {Box} box */
  resize(box) {
    const place = this.grip()?.place;
    if (!place) return;
    if (place.whyNotResized) this.say(place.whyNotResized);
    else this.change(place.resize(box), box);
  }

  get screen() {
    return this.#layers.screen;
  }

  /**
   * @param {keyof Box} side
   * @param {number} mm
   */
  #toSide(side, mm) {
    const place = this.grip()?.place;
    if (!place) return;
    const isMove = (side === "x" || side === "y") && !place.isWholeScreen;
    if (isMove) this.move(side === "x" ? mm - place.box.x : 0, side === "y" ? mm - place.box.y : 0);
    else this.resize(withSide(place, side, mm, this.screen));
  }

  /** @param {"undo" | "redo"} what */
  goBack(what) {
    this.end();
    this.#parts.editor[what]();
  }

  /**
   * Selects the next layer, or that before; returns whether there is one.
   * @param {1 | -1} by
   */
  focusNeighbour(by) {
    const next = this.#selected && this.#boxes.neighbour(this.#selected, by);
    if (next) this.focus(next);
    return next !== undefined;
  }

  focusPanel() {
    this.#panel.focus();
  }

  toText() {
    const { editor } = this.#parts;
    const { selected } = this;
    if (!selected || !editor.has(selected.layer.file)) return;
    this.end();
    const [first] = selected.at === undefined ? selected.layer.from : (selected.toml?.layerLines(selected.at) ?? [1]);
    editor.goTo(selected.layer.file, first);
  }

  delete() {
    this.end();
    const from = this.grip();
    const grip = this.#grip;
    if (!from?.toml || from.at === undefined || !grip) return;
    this.#grip = undefined;
    grip.held.make(from.toml.removals(from.at));
    grip.held.end();
    this.#layers.all = this.#layers.all.filter((each) => each !== from);
    this.focus(undefined);
  }

  /** @param {Area} area */
  #lay({ left, top, width, height }) {
    Object.assign(this.#surface.style, {
      left: `${left}px`,
      top: `${top}px`,
      width: `${width}px`,
      height: `${height}px`,
    });
    this.#draw(false);
  }

  /** @param {boolean} isNew Whether another layer is selected. */
  #draw(isNew) {
    if (!this.isEditing) {
      this.#panel.hide();
      return;
    }
    const { scale, box } = this.#parts.map;
    this.#boxes.show(this.#layers.all, this.#selected, scale);
    const { selected } = this;
    box.classList.toggle("has-selection", selected !== undefined);
    if (!selected) {
      this.#panel.hide();
      return;
    }
    const { toml, at, layer } = selected;
    const numbers = toml && at !== undefined ? layerNumbers(this.#schema, toml, at, layer.kind, this.#reach) : [];
    this.#panel.show(selected, numbers, this.#reach, isNew);
    const felt = [byId("numbers"), byId("scope").parentElement ?? box].map((each) => each.getBoundingClientRect());
    this.#panel.place(felt, (box.closest(".map-card") ?? box).getBoundingClientRect());
  }
}
