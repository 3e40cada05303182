// The layers of the scene as the map shows them for editing: each with its place, as its text says it now.
// @ts-check

import { bounds, placeOf } from "./place.js";
import { TomlText } from "./toml_text.js";

/** @import { Checked, Files, Layer, Screen } from "../engine/types" */
/** @import { Editor } from "./editor.js" */
/** @import { Box, Place } from "./place.js" */
/**
 * A layer on the map. `at` is its number among those of its file, and `toml` the text of that; both are missing where
 * the text cannot be changed, and the place says why.
 * @typedef {{ key: string, layer: Layer, at?: number, toml?: TomlText, place: Place }} EditedLayer
 */

export class EditedLayers {
  #editor;
  /** @type {EditedLayer[]} */
  all = [];
  /** @type {Screen} */
  screen = { widthMm: 120, heightMm: 80 };
  /**
   * The texts that `all` is for.
   * @type {Map<string | undefined, string>}
   */
  #texts = new Map();
  /**
   * Files that include one with defaults.
   * @type {Set<string | undefined>}
   */
  #withOtherDefaults = new Set();

  /** @param {Editor} editor */
  constructor(editor) {
    this.#editor = editor;
  }

  /** @param {string | undefined} key */
  find(key) {
    return this.all.find((each) => each.key === key);
  }

  /**
   * Whether the texts are those that `all` is for: otherwise a check of them is on its way.
   */
  get isCurrent() {
    return [...this.#texts].every(([file, text]) => this.#editor.textOf(file) === text);
  }

  /**
   * Takes the layers of a check, unless the texts have changed since. Returns whether it did.
   * @param {Checked} check
   * @param {Files} files That were checked.
   * @param {string} entry
   */
  take({ layers, screen }, files, entry) {
    const names = new Set([undefined, ...layers.map(({ file }) => file)]);
    /** @type {Map<string | undefined, string>} */
    const texts = new Map();
    for (const file of names) {
      const text = this.#editor.textOf(file);
      if (text !== undefined) texts.set(file, text);
      if (text !== undefined && text !== files[file ?? entry]) return false;
    }
    this.#texts = texts;
    this.screen = screen;
    const parsed = new Map([...texts].map(([file, text]) => [file, new TomlText(text)]));
    const withDefaults = [...parsed].filter(([, toml]) => includesDefaults(toml, files));
    this.#withOtherDefaults = new Set(withDefaults.map(([file]) => file));
    this.all = layers.map((layer) => {
      const toml = parsed.get(layer.file);
      return this.#describe(layer, toml, toml?.layerAt(layer.from[0]));
    });
    return true;
  }

  /**
   * @param {Layer} layer
   * @param {TomlText | undefined} toml
   * @param {number | undefined} at
   * @returns {EditedLayer}
   */
  #describe(layer, toml, at) {
    const { file, index } = layer;
    if (toml && at !== undefined) {
      const place = placeOf(toml, at, layer, this.screen, this.#withOtherDefaults.has(file));
      return { key: `${file ?? ""} ${at}`, layer, at, toml, place };
    }
    const why = toml
      ? "This layer shares its line with another: change it in the text."
      : `This layer comes from ${file}: open that file together with the scene to change it here.`;
    return { key: `number ${index}`, layer, place: fixed(layer, this.screen, why) };
  }

  /**
   * The text of a file has changed by a hand: its layers are read anew, the changed one with its new box where only a
   * check knows that.
   * @param {EditedLayer} changed
   * @param {Box} [box] Of its first copy.
   */
  reread(changed, box) {
    const { file } = changed.layer;
    const text = this.#editor.textOf(file);
    if (text === undefined) return;
    this.#texts.set(file, text);
    const toml = new TomlText(text);
    this.all = this.all.map((each) => {
      if (each.layer.file !== file || each.at === undefined) return each;
      const all = box && each.key === changed.key ? bounds(box, each.place.copies) : undefined;
      const boxMm = all ? /** @type {Layer["boxMm"]} */ ([all.x, all.y, all.width, all.height]) : each.layer.boxMm;
      return this.#describe({ ...each.layer, boxMm }, toml, each.at);
    });
  }

  /**
   * The layers under a place, the smallest first, of equal ones the upper.
   * @param {number} xMm
   * @param {number} yMm
   * @param {number} nearMm How far from a layer a press still counts.
   */
  under(xMm, yMm, nearMm) {
    const area = (/** @type {EditedLayer} */ { place: { box } }) => box.width * box.height;
    const isIn = (/** @type {EditedLayer} */ { place: { box, copies } }) =>
      copies.some(([dx, dy]) => {
        const [x, y] = [xMm - box.x - dx, yMm - box.y - dy];
        return x >= -nearMm && x <= box.width + nearMm && y >= -nearMm && y <= box.height + nearMm;
      });
    return this.all.filter(isIn).reverse().sort((a, b) => area(a) - area(b));
  }
}

/**
 * @param {TomlText} toml
 * @param {Files} files
 * @returns {boolean}
 */
function includesDefaults(toml, files) {
  const names = toml.value(["include"]);
  return Array.isArray(names) && names.some((name) => {
    const content = files[String(name)];
    if (typeof content !== "string") return false;
    const included = new TomlText(content);
    return included.value(["defaults"]) !== undefined || includesDefaults(included, files);
  });
}

/**
 * A place that a hand cannot change.
 * @param {Layer} layer
 * @param {Screen} screen
 * @param {string} why
 * @returns {Place}
 */
function fixed({ boxMm }, { widthMm, heightMm }, why) {
  const [x, y, width, height] = boxMm ?? [0, 0, widthMm, heightMm];
  return {
    box: { x, y, width, height },
    copies: [[0, 0]],
    isWholeScreen: boxMm === null,
    keepsRatio: false,
    whyNotMoved: why,
    whyNotResized: why,
    move: () => [],
    resize: () => [],
  };
}
