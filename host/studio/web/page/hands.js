// Hands on the map: in the mode *Edit* layers are selected, moved, resized and tuned, and their text changes with them.
// @ts-check

import { byId, element, sentenceOf } from "./dom.js";
import { EditedLayers } from "./edited_layers.js";
import { HandDrag } from "./hand_drag.js";
import { TEXT_CHANGED, HandGrip } from "./hand_grip.js";
import { HandKeys } from "./hand_keys.js";
import { LayerBoxes } from "./layer_boxes.js";
import { LayerEdits } from "./layer_edits.js";
import { layerNumbers, repeatNumbers } from "./layer_numbers.js";
import { LayerPanel } from "./layer_panel.js";
import { ModeSwitch } from "./mode_switch.js";

/** @import { Checked, Files } from "../engine/types" */
/** @import { Schema } from "./completion.js" */
/** @import { EditedLayer } from "./edited_layers.js" */
/** @import { Editor } from "./editor.js" */
/** @import { Most } from "./layer_numbers.js" */
/** @import { Area, FrictionMap } from "./map.js" */
/** @import { Player } from "./player.js" */
/** @import { Project } from "./project.js" */
/** @typedef {{ map: FrictionMap, editor: Editor, player: Player, project: Project }} Parts */

export class Hands {
  #parts;
  #schema;
  #layers;
  #boxes;
  #edits;
  #panel = new LayerPanel();
  #surface = element("div", { className: "hands", role: "group", tabIndex: -1, hidden: true, "aria-label": "Layers" });
  #mode = new ModeSwitch();
  /** @type {string | undefined} */
  #selected;
  #reach = /** @type {Most} */ ({ naturalN: 0.25, lowN: 0.25, highN: 0.38, reachN: 0.38 });
  /** What moves, resizes and tunes the selected layer. */
  grip;
  /** The scene that the layers are of, as the project counts them. */
  #opened = 0;
  /**
   * A layer is put behind all others in the text, of which there are so many in that scene, to be selected once its
   * check is there. For a scene that is about to open, the mode Edit begins then.
   * @type {{ opened: number, count: number, isNew?: boolean } | undefined}
   */
  #awaited;
  /**
   * A check that came while a hand held a layer, which may let go without a change.
   * @type {[Checked, Files] | undefined}
   */
  #heldBack;
  /** The mode Edit begins: the map is no longer for sliding. */
  onEdit = () => {};
  /**
   * A layer that is not of the scene is added by this action.
   * @type {(add: () => void) => unknown}
   */
  onAdd = (add) => add();
  /** A picture is wanted as a layer. */
  onPicture = () => {};

  /**
   * @param {Parts} parts
   * @param {Schema} schema
   */
  constructor(parts, schema) {
    this.#parts = parts;
    this.#schema = schema;
    this.#layers = new EditedLayers(parts.editor);
    this.#boxes = new LayerBoxes(this.#surface);
    this.#edits = new LayerEdits(parts.editor, this.#layers);
    this.grip = new HandGrip(parts, this.#layers);
    const { box, onLayout } = parts.map;
    box.append(this.#surface);
    box.closest("main")?.append(this.#panel.element);
    new HandDrag(this.#surface, this, parts.map);
    new HandKeys(this.#surface, this, this.#panel.element);
    this.#listen();
    parts.map.onLayout = (area) => {
      onLayout(area);
      this.#lay(area);
    };
  }

  #listen() {
    const { grip } = this;
    this.#mode.onChange = () => this.#changeMode();
    grip.selected = () => this.selected;
    grip.onChange = () => this.#draw(false);
    grip.onEnd = () => {
      if (this.#heldBack) this.show(...this.#heldBack);
    };
    grip.onSay = (sentence) => this.say(sentence);
    this.#surface.addEventListener("focusout", () => grip.end());
    this.#panel.element.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      if (grip.isHolding) {
        event.preventDefault();
        grip.cancel();
        letGo(event.target);
      }
      this.#boxes.focus(this.#selected);
    });
    this.#boxes.onFocus = (key) => this.select(key);
    const panel = this.#panel;
    panel.onNumber = ({ path, decimals }, value) => grip.change([{ path, value, decimals }]);
    panel.onSide = (side, mm) => grip.setSide(side, mm);
    panel.onEnd = () => grip.end();
    panel.onText = () => this.toText();
    panel.onDuplicate = () => this.duplicate();
    panel.onDelete = () => this.delete();
    panel.onClose = () => this.focus(undefined);
    panel.onAdd = (beginning) => {
      if (this.canEdit()) this.onAdd(() => this.#edit(() => this.#edits.add(beginning)));
    };
    panel.onPicture = () => this.onPicture();
  }

  get isEditing() {
    return this.#mode.isEditing;
  }

  /** @param {boolean} isEditing */
  setEditing(isEditing) {
    this.#mode.set(isEditing);
  }

  #changeMode() {
    this.grip.end();
    this.#surface.hidden = !this.isEditing;
    if (this.isEditing) this.onEdit();
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
    this.#heldBack = this.grip.isHolding ? [check, files] : undefined;
    if (this.#heldBack) {
      this.#layers.feel(check.layers);
      this.#draw(false);
      return;
    }
    try {
      this.#take(check, files);
      this.#mode.whyNot = "";
    } catch (error) {
      this.#mode.whyNot = `This scene is edited in its text, not on the map: ${sentenceOf(error)}.`;
      if (this.isEditing) this.setEditing(true);
    }
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
    const awaited = this.#awaited?.opened === project.opened ? this.#awaited : undefined;
    const last = awaited && this.#layers.all.length > awaited.count ? this.#layers.last : undefined;
    // What is awaited of a scene that is not open yet stays so.
    if (this.#awaited && this.#awaited.opened <= project.opened) this.#awaited = undefined;
    if (awaited?.isNew && !this.isEditing) {
      this.#mode.whyNot = "";
      this.setEditing(true);
    }
    this.#reselect((last ?? after)?.key);
    // What was said was about the layers before.
    this.say(this.selected?.at === undefined ? (this.selected?.place.whyNotMoved ?? "") : "");
    // What is selected stands in the text that is shown.
    if (!editor.has(this.selected?.layer.file)) this.#panel.hide();
  }

  /** A layer comes behind all others in the text of the scene: while layers are edited, it is selected. */
  selectLastAfterCheck() {
    const { opened } = this.#parts.project;
    this.#awaited = this.isEditing ? { opened, count: this.#layers.all.length } : undefined;
  }

  /**
   * Runs an action that opens another scene, whose last layer is selected in the mode Edit.
   * @param {() => Promise<unknown>} open
   */
  async editNext(open) {
    const awaited = { opened: this.#parts.project.opened + 1, count: 0, isNew: true };
    this.#awaited = awaited;
    try {
      await open();
    } catch (error) {
      if (this.#awaited === awaited) this.#awaited = undefined;
      throw error;
    }
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

  get screen() {
    return this.#layers.screen;
  }

  /** @param {string | undefined} key */
  select(key) {
    if (key === this.#selected) return;
    this.grip.end();
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

  /** @param {"undo" | "redo"} what */
  undoOrRedo(what) {
    this.grip.end();
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

  /** Goes to the lines of the selected layer in the text. */
  toText() {
    this.showText({ focuses: true });
  }

  /** Shows them: the keys act on the layer still, unless it `focuses` the text. */
  showText({ focuses = false } = {}) {
    const { editor } = this.#parts;
    const { selected } = this;
    if (!selected || !editor.has(selected.layer.file)) return;
    this.grip.end();
    const [first] = selected.at === undefined ? selected.layer.from : (selected.toml?.layerLines(selected.at) ?? [1]);
    editor.goTo(selected.layer.file, first, { focuses });
  }

  /**
   * Adds a picture of the scene as a layer.
   * @param {string} name
   * @param {number} aspect Its width over its height.
   */
  addPicture(name, aspect) {
    this.#edit(() => this.#edits.addPicture(name, aspect));
  }

  /** Whether layers can come and go now; where not, says why. */
  canEdit() {
    try {
      if (!this.#layers.isCurrent) throw new Error(TEXT_CHANGED);
      this.#edits.assertVersion();
      return true;
    } catch (error) {
      this.say(sentenceOf(error));
      return false;
    }
  }

  duplicate() {
    const { selected } = this;
    if (selected) this.#edit(() => this.#edits.duplicate(selected));
  }

  delete() {
    const { selected } = this;
    if (selected) this.#edit(() => this.#edits.remove(selected));
  }

  /**
   * Adds or takes out a layer, in one step of undo, and selects what came of it.
   * @param {() => EditedLayer | void} edit
   */
  #edit(edit) {
    this.grip.end();
    if (!this.canEdit()) return;
    try {
      const made = edit();
      this.#draw(false);
      this.focus(made?.key);
    } catch (error) {
      this.say(sentenceOf(error));
    }
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
    // Where there is no layer, the keys lead from the map to what adds one.
    this.#surface.tabIndex = this.#layers.all.length > 0 ? -1 : 0;
    const { selected } = this;
    const { toml, at, layer } = selected ?? {};
    const isTuned = layer && toml && at !== undefined;
    const numbers = isTuned ? layerNumbers(this.#schema, toml, at, layer.kind, this.#reach) : [];
    if (selected) numbers.push(...repeatNumbers(selected, this.screen));
    if (selected) this.#panel.show(selected, numbers, this.#reach, isNew);
    else this.#panel.showNone(this.#layers.all.length, isNew);
    const around = [byId("numbers"), byId("scope").parentElement ?? box, box.closest(".map-card") ?? box];
    const [numbersRect, scope, map] = around.map((each) => each.getBoundingClientRect());
    this.#panel.place(numbersRect, scope, map);
  }
}

/**
 * A slider that is dragged follows the pointer no more.
 * @param {EventTarget | null} target
 */
function letGo(target) {
  if (!(target instanceof HTMLInputElement) || target.type !== "range") return;
  target.disabled = true;
  target.disabled = false;
}
