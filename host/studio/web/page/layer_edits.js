// Layers that are added to a scene on the map, doubled, or taken out of it: each is one step of undo.
// @ts-check

import { TEXT_CHANGED } from "./hand_grip.js";
import { bounds, clamp, placeOf } from "./place.js";
import { TomlText, withLayer } from "./toml_text.js";

/** @import { Layer } from "../engine/types" */
/** @import { EditedLayer, EditedLayers } from "./edited_layers.js" */
/** @import { Editor } from "./editor.js" */
/** @import { BoxMm } from "./toml_text.js" */

/** How far a copy lies from its layer, along both sides, mm. */
const COPY_MM = 5;
/** Number of a layer that no check has seen yet. */
export const UNCHECKED = 0;

export class LayerEdits {
  #editor;
  #layers;

  /**
   * @param {Editor} editor
   * @param {EditedLayers} layers
   */
  constructor(editor, layers) {
    this.#editor = editor;
    this.#layers = layers;
  }

  /** Throws a sentence where layers cannot come and go now. */
  assertPossible() {
    if (!this.#layers.isCurrent) throw new Error(TEXT_CHANGED);
  }

  /**
   * Adds a layer where there is room, above all others; returns it.
   * @param {string} base Its name, unless another layer has that.
   * @param {string | [file: string, aspect: number]} layer Which of those that can be added, or a picture.
   */
  add(base, layer) {
    const { screen } = this.#layers;
    const name = freeLayerName(base, this.#names());
    const screenMm = /** @type {[number, number]} */ ([screen.widthMm, screen.heightMm]);
    const added = withLayer({ text: this.#editor.text, name, layer, screenMm, takenMm: this.#taken() });
    this.#editor.change(undefined, added.text);
    const layers = new TomlText(added.text).value(["layer"]);
    const at = Array.isArray(layers) ? layers.length - 1 : 0;
    const { kind } = /** @type {{ kind: string }} */ (/** @type {any} */ (layers)[at]);
    return this.#layers.insert(newLayer(name, kind, added.boxMm), at);
  }

  /**
   * Puts a copy of a layer beside it, right above it; returns the copy.
   * @param {EditedLayer} edited
   */
  duplicate({ layer, toml, at, place }) {
    if (!toml || at === undefined) throw new Error(place.whyNotMoved);
    const copied = new TomlText(toml.withCopy(at), toml.defaults);
    const own = copied.value(["layer", at + 1, "name"]);
    const name = typeof own === "string" ? freeLayerName(own, this.#names()) : layer.name;
    const { screen } = this.#layers;
    const to = placeOf(copied, at + 1, layer, screen);
    const all = bounds(place.box, place.copies);
    const isMoved = !place.whyNotMoved;
    const dx = isMoved ? aside(all.x, screen.widthMm - all.x - all.width) : 0;
    const dy = isMoved ? aside(all.y, screen.heightMm - all.y - all.height) : 0;
    const changes = isMoved ? to.move(dx, dy) : [];
    if (typeof own === "string") changes.push({ path: ["layer", at + 1, "name"], value: name, decimals: 0 });
    this.#editor.change(layer.file, copied.with(changes));
    const [x, y, width, height] = layer.boxMm ?? [0, 0, 0, 0];
    const boxMm = layer.boxMm && /** @type {Layer["boxMm"]} */ ([x + dx, y + dy, width, height]);
    return this.#layers.insert({ ...layer, index: UNCHECKED, name, boxMm }, at + 1);
  }

  /**
   * @param {EditedLayer} edited
   * @param {string} name
   */
  rename(edited, name) {
    const { toml, at, layer, place } = edited;
    if (!toml || at === undefined) throw new Error(place.whyNotMoved);
    if (this.#names().includes(name)) throw new Error(`Another layer is called ${name}.`);
    this.#editor.change(layer.file, toml.with([{ path: ["layer", at, "name"], value: name, decimals: 0 }]));
    return this.#layers.rename(edited, name);
  }

  /** @param {EditedLayer} edited */
  remove(edited) {
    if (!edited.toml || edited.at === undefined) throw new Error(edited.place.whyNotMoved);
    this.#editor.change(edited.layer.file, edited.toml.without(edited.at));
    this.#layers.remove(edited);
  }

  #names() {
    return this.#layers.all.map(({ layer }) => layer.name);
  }

  /** Where the layers are that do not cover the whole screen. */
  #taken() {
    const placed = this.#layers.all.filter(({ place }) => !place.isWholeScreen);
    return placed.flatMap(({ place: { box, copies } }) =>
      copies.map(([dx, dy]) => /** @type {BoxMm} */ ([box.x + dx, box.y + dy, box.width, box.height])),
    );
  }
}

/**
 * A name that no other layer has: the same with a number.
 * @param {string} name
 * @param {string[]} taken
 */
function freeLayerName(name, taken) {
  const base = name.replace(/ \d+$/, "");
  let free = name;
  for (let number = 2; taken.includes(free); number += 1) free = `${base} ${number}`;
  return free;
}

/**
 * How far a copy moves along an axis: to where there is more room.
 * @param {number} before
 * @param {number} behind
 */
function aside(before, behind) {
  const by = behind >= Math.min(COPY_MM, before) ? COPY_MM : -COPY_MM;
  return clamp(by, -before, behind);
}

/**
 * What is known of a layer that no check has seen yet.
 * @param {string} name
 * @param {string} kind
 * @param {BoxMm | null} boxMm
 * @returns {Layer}
 */
function newLayer(name, kind, boxMm) {
  return {
    index: UNCHECKED,
    name,
    kind,
    felt: "",
    perceived: null,
    isLive: false,
    whyNotLive: "",
    startsOn: true,
    gain: 1,
    gainMin: 0,
    gainMax: 1,
    gainReach: null,
    controls: [],
    from: [1, 1],
    boxMm,
  };
}
