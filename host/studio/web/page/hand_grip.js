// What a hand holds: the layer that is selected, which it moves, resizes or tunes until it lets go.
// @ts-check

import { withSide } from "./hand_drag.js";

/** @import { EditedLayer, EditedLayers } from "./edited_layers.js" */
/** @import { Editor } from "./editor.js" */
/** @import { Hands } from "./hands.js" */
/** @import { HeldChange } from "./held_change.js" */
/** @import { Box, Side } from "./place.js" */
/** @import { Player } from "./player.js" */
/** @import { Change } from "./toml_text.js" */

/** Why nothing can be changed while the layers are not those of the text. */
export const TEXT_CHANGED = "The text has changed: its layers are read again once it has no mistake.";

export class HandGrip {
  #editor;
  #player;
  #layers;
  /**
   * The change that goes on, and the layer as it was before.
   * @type {{ held: HeldChange, from: EditedLayer } | undefined}
   */
  #held;
  #hands;

  /**
   * @param {{ editor: Editor, player: Player }} parts
   * @param {EditedLayers} layers
   * @param {Hands} hands
   */
  constructor({ editor, player }, layers, hands) {
    this.#hands = hands;
    this.#editor = editor;
    this.#player = player;
    this.#layers = layers;
  }

  get isHolding() {
    return this.#held !== undefined && !this.#held.held.isOver;
  }

  /** Whether a hand has changed a layer and holds it still. */
  get hasChanged() {
    return this.#player.isHeld;
  }

  /**
   * Begins a change of the layer that is selected, or goes on with it; returns what it was before. Where it cannot be
   * changed now, says why.
   */
  begin() {
    if (this.#held && this.isHolding) return this.#held.from;
    if (this.#held) this.end();
    const from = this.#hands.selected;
    if (!from || from.at === undefined) return undefined;
    if (!this.#layers.isCurrent) {
      this.#hands.say(TEXT_CHANGED);
      return undefined;
    }
    this.#held = { from, held: this.#editor.hold(from.layer.file) };
    return from;
  }

  /**
   * Makes changes of the layer as it was before, in place of those that this hand made last.
   * @param {Change[]} changes
   * @param {Box} [box] Where its first copy is then, where its text does not say that.
   */
  change(changes, box) {
    const from = this.begin();
    if (!from?.toml || !this.#held) return;
    const text = from.toml.with(changes);
    if (text === from.toml.text && !this.#player.isHeld) return;
    this.#player.hold();
    this.#held.held.make(text);
    this.#layers.reread(from, box);
    this.#hands.say("");
    this.#hands.draw(false);
  }

  /** Takes back what this hand has changed since it began. */
  cancel() {
    if (this.#held && this.#player.isHeld) this.change([], this.#held.from.place.box);
    this.end();
  }

  /** The hand lets go: the scene plays as it is now. */
  end() {
    const grip = this.#held;
    if (!grip) return;
    this.#held = undefined;
    grip.held.end();
    if (this.#player.isHeld) this.#player.release(this.#editor.text);
    this.#hands.takeHeldBack();
  }

  /**
   * Moves the selected layer from where it was when the change began.
   * @param {number} dxMm
   * @param {number} dyMm
   */
  move(dxMm, dyMm) {
    const place = this.begin()?.place;
    if (!place) return;
    if (place.whyNotMoved) {
      this.#hands.say(place.whyNotMoved);
      return;
    }
    const { x, y, width, height } = place.box;
    this.change(place.move(dxMm, dyMm), place.isWholeScreen ? undefined : { x: x + dxMm, y: y + dyMm, width, height });
  }

  /** @param {Box} box */
  resize(box) {
    const place = this.begin()?.place;
    if (!place) return;
    if (place.whyNotResized) this.#hands.say(place.whyNotResized);
    else this.change(place.resize(box), box);
  }

  /**
   * Moves or resizes it so that a side is as typed.
   * @param {Side} side
   * @param {number} mm
   */
  setSide(side, mm) {
    const place = this.begin()?.place;
    if (!place) return;
    const isMove = (side === "x" || side === "y") && !place.isWholeScreen;
    if (isMove) this.move(side === "x" ? mm - place.box.x : 0, side === "y" ? mm - place.box.y : 0);
    else this.resize(withSide(place, side, mm, this.#layers.screen));
  }
}
