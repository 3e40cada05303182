// Hands on the map: in the mode *Edit* layers are selected, moved, resized and tuned, and their text changes with them.
// @ts-check

import { sentenceOf, stemOf } from "./dom.js";
import { EditedLayers } from "./edited_layers.js";
import { HandDrag } from "./hand_drag.js";
import { HandGrip } from "./hand_grip.js";
import { HandKeys } from "./hand_keys.js";
import { HandsView } from "./hands_view.js";
import { LayerEdits } from "./layer_edits.js";
import { ModeSwitch } from "./mode_switch.js";
import { Removal } from "./removal.js";
import { Selection } from "./selection.js";

/** @import { Checked, Files, Layer, Problem } from "../engine/types" */
/** @import { Schema } from "./completion.js" */
/** @import { EditedLayer } from "./edited_layers.js" */
/** @import { Editor } from "./editor.js" */
/** @import { FrictionMap } from "./map.js" */
/** @import { Player } from "./player.js" */
/** @import { Project } from "./project.js" */
/** @typedef {{ map: FrictionMap, editor: Editor, player: Player, project: Project }} Parts */
/** @typedef {Checked & { problems: Problem[] }} Outcome Of the check of a scene that plays. */

export class Hands {
  #parts;
  #layers;
  #selection;
  #edits;
  /** What is shown: the boxes of the layers, and the panel. */
  view;
  #removal;
  mode = new ModeSwitch();
  /** What moves, resizes and tunes the selected layer. */
  grip;
  /**
   * A check that came while a hand held a layer, which may let go without a change.
   * @type {[Outcome, Files] | undefined}
   */
  #heldBack;
  /** A pointer has pressed the map and is not lifted. */
  isPressed = false;
  /** The mode Edit begins: the map is no longer for sliding. */
  onEdit = () => {};
  /**
   * A layer that is not of the scene is added by this action.
   * @type {(add: () => void) => unknown}
   */
  onAdd = (add) => add();
  /** A picture is wanted as a layer. */
  onPicture = () => {};
  /** A layer that starts off is to play once. @type {(layer: Layer) => void} */
  onPlayOnce = () => {};

  /**
   * @param {Parts} parts
   * @param {Schema} schema
   */
  constructor(parts, schema) {
    const { editor, project, map } = parts;
    this.#parts = parts;
    this.#layers = new EditedLayers(editor);
    this.#selection = new Selection(this.#layers, project);
    this.#edits = new LayerEdits(editor, this.#layers);
    this.grip = new HandGrip(parts, this.#layers, this);
    this.view = new HandsView(map, schema, this);
    this.#removal = new Removal(editor, () => {
      // What comes back is selected again, and the keys act on it.
      this.focus(undefined);
      this.undoOrRedo("undo");
    });
    this.mode.onChange = () => this.#changeMode();
    this.view.surface.addEventListener("focusout", () => this.grip.end());
    this.view.boxes.onFocus = (key) => this.select(key);
    new HandDrag(this, this.#layers, map);
    new HandKeys(this);
    const { onLayout } = map;
    map.onLayout = (area) => {
      onLayout(area);
      this.view.cover(area);
      this.draw(false);
    };
  }

  get isEditing() {
    return this.mode.isEditing;
  }

  #changeMode() {
    this.grip.end();
    this.view.surface.hidden = !this.isEditing;
    if (this.isEditing) this.onEdit();
    else this.#selection.key = undefined;
    this.draw(true);
  }

  /** A hand has let go of its layer. */
  takeHeldBack() {
    if (this.#heldBack) this.show(...this.#heldBack);
  }

  /**
   * Takes the layers of a scene that was checked.
   * @param {Outcome} check
   * @param {Files} files That were checked.
   */
  show(check, files) {
    this.#removal.follow();
    const mistake = mistakeIn(check.problems);
    this.view.panel.refusal = mistake && `A board refuses this draft: ${mistake}`;
    this.#heldBack = this.grip.isHolding ? [check, files] : undefined;
    if (this.#heldBack) {
      this.#layers.feel(check.layers);
      // A mistake that the hand made is over.
      if (this.grip.hasChanged) this.view.panel.sayFirst(this.selected);
      this.draw(false);
      return;
    }
    this.#take(check, files);
  }

  /**
   * The check found mistakes: while layers are edited, the first one is said beside them.
   * @param {Problem[]} problems
   */
  showMistakes(problems) {
    const { panel } = this.view;
    panel.refusal = mistakeIn(problems);
    if (this.isEditing && panel.refusal) this.say(panel.refusal);
  }

  /**
   * @param {Checked} check
   * @param {Files} files
   */
  #take(check, files) {
    const { editor, project } = this.#parts;
    this.view.reach = check;
    const before = this.selected;
    if (!this.#layers.take(check, files, project.entry)) return;
    const { key, beginsEdit } = this.#selection.follow(before, this.isEditing);
    if (beginsEdit && !this.isEditing) this.mode.set(true);
    this.#reselect(key);
    // As after Add, unless a person types elsewhere meanwhile.
    if (beginsEdit && document.activeElement?.matches("body, button")) this.focus(key);
    // What was said was about the layers before.
    this.view.panel.sayFirst(this.selected);
    // What is selected stands in the text that is shown.
    if (!editor.has(this.selected?.layer.file)) this.view.panel.hide();
  }

  /** A layer comes behind all others in the text of the scene: while layers are edited, it is selected. */
  selectLastAfterCheck() {
    if (this.isEditing) this.#selection.awaitLast();
    else this.#selection.awaitNothing();
  }

  /**
   * Runs an action that opens another scene, whose last layer is selected in the mode Edit.
   * @param {() => Promise<unknown>} open
   */
  editNext(open) {
    return this.#selection.awaitLastOfNext(open);
  }

  /**
   * The layer that is selected has another key: layers before it came or went.
   * @param {string | undefined} key
   */
  #reselect(key) {
    const hasFocus = this.view.surface.contains(document.activeElement);
    const isOther = key !== this.#selection.key;
    this.#selection.key = key;
    this.draw(isOther);
    // The keys act on what is selected.
    if (isOther && hasFocus) this.focus(key);
  }

  get selected() {
    return this.#selection.layer;
  }

  /** @param {string | undefined} key */
  select(key) {
    if (key === this.#selection.key) return;
    // What was typed is the name of the layer that was selected.
    this.view.panel.name.commit();
    this.grip.end();
    this.#selection.key = key;
    this.draw(true);
  }

  /**
   * Selects a layer and gives it the focus, so that the keys act on it.
   * @param {string | undefined} key
   */
  focus(key) {
    this.select(key);
    this.view.focus(key);
  }

  /** @param {string} sentence */
  say(sentence) {
    this.view.panel.note = sentence;
  }

  /** @param {"undo" | "redo"} what */
  undoOrRedo(what) {
    this.grip.end();
    this.#parts.editor[what]();
  }

  /**
   * Selects the next layer, or that before, if there is one.
   * @param {1 | -1} by
   */
  focusNeighbour(by) {
    const next = this.view.boxes.neighbour(this.#selection.key, by);
    if (next) this.focus(next);
  }

  /**
   * A layer was chosen elsewhere by its number: in the mode Edit it is selected on the map. Returns whether it is.
   * @param {number} index
   */
  choose(index) {
    if (!this.isEditing || !this.#layers.isCurrent) return false;
    const found = this.#layers.all.find(({ layer }) => layer.index === index);
    if (!found) return false;
    this.focus(found.key);
    this.view.surface.scrollIntoView({ block: "nearest" });
    return true;
  }

  /** Leads to the lines of the selected layer in the text. */
  showText() {
    const { editor } = this.#parts;
    const { selected } = this;
    if (!selected || !editor.has(selected.layer.file)) return;
    this.grip.end();
    const { layer, at, toml } = selected;
    editor.goTo(layer.file, at === undefined || !toml ? layer.from[0] : toml.lineOf(at));
  }

  /**
   * Adds a layer that is not of the scene.
   * @param {string} name Which of those that can be added.
   */
  add(name) {
    if (this.canEdit()) this.onAdd(() => this.#edit(() => this.#edits.add(name, name)));
  }

  /**
   * Adds a picture of the scene as a layer.
   * @param {string} name
   * @param {number} aspect Its width over its height.
   */
  addPicture(name, aspect) {
    this.#edit(() => this.#edits.add(stemOf(name), [name, aspect]));
  }

  /** Whether layers can come and go now; where not, says why. */
  canEdit() {
    return this.#try(() => this.#edits.assertPossible());
  }

  /** @param {string} name That the selected layer is to have; the focus stays where it is. */
  rename(name) {
    const { selected } = this;
    if (selected) this.#edit(() => this.#edits.rename(selected, name), { focuses: false });
  }

  focusName() {
    if (this.selected) this.view.panel.name.focus();
  }

  /** Plays the selected layer once. */
  playOnce() {
    this.grip.end();
    if (this.selected) this.onPlayOnce(this.selected.layer);
  }

  duplicate() {
    const { selected } = this;
    if (selected) this.#edit(() => this.#edits.duplicate(selected));
  }

  delete() {
    const { selected } = this;
    if (selected && this.#edit(() => this.#edits.remove(selected))) this.#removal.say(selected.layer);
  }

  /**
   * Adds, renames or takes out a layer, in one step of undo, and selects what came of it. Returns whether it could.
   * @param {() => EditedLayer | void} edit
   */
  #edit(edit, { focuses = true } = {}) {
    this.grip.end();
    return this.#try(() => {
      this.#edits.assertPossible();
      this.#selection.remember();
      const made = edit();
      this.draw(false);
      if (focuses) this.focus(made?.key);
    });
  }

  /**
   * Returns whether an action succeeds; where it does not, says why.
   * @param {() => void} act
   */
  #try(act) {
    try {
      act();
      return true;
    } catch (error) {
      this.say(sentenceOf(error));
      return false;
    }
  }

  /** @param {boolean} isNew Whether another layer is selected. */
  draw(isNew) {
    if (this.isEditing) this.view.draw(this.#layers, this.selected, isNew);
    else this.view.panel.hide();
  }
}

/**
 * Returns the first mistake among the problems of a check; empty without one.
 * @param {Problem[]} problems
 */
function mistakeIn(problems) {
  return problems.find(({ severity }) => severity === "error")?.message ?? "";
}
