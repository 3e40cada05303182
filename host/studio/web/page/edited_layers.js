// The layers of the scene as the map shows them for editing: each with its place, as its text says it now.
// @ts-check

import { bounds, placeOf } from "./place.js";
import { SHARED_LINE, TomlText } from "./toml_text.js";

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
  /** Defaults of the layers in each file. @type {Map<string | undefined, string>} */
  #defaults = new Map();

  /** @param {Editor} editor */
  constructor(editor) {
    this.#editor = editor;
  }

  /** @param {string | undefined} key */
  find(key) {
    return this.all.find((each) => each.key === key);
  }

  /** The last layer in the text of the scene. */
  get last() {
    return this.all.findLast(({ at, layer }) => at !== undefined && layer.file === undefined);
  }

  /**
   * The layer that is now what a layer of the texts before was, if that is sure.
   * @param {EditedLayer} before
   */
  successor(before) {
    const there = this.find(before.key);
    const { name, kind, file } = before.layer;
    const isCounted = before.toml !== undefined && countOf(there) === countOf(before);
    if (before.at === undefined || (isCounted && wordsOf(there) === wordsOf(before)))
      return there?.layer.name === name && there.layer.kind === kind ? there : undefined;
    const same = this.all.filter((each) => each.layer.file === file && wordsOf(each) === wordsOf(before));
    if (same.length === 1) return same[0];
    // Its own text has changed; where its name has, nothing else may have.
    const isNamedSo = there?.layer.name === name || unnamedWordsOf(there) === unnamedWordsOf(before);
    return isCounted && isNamedSo && there?.layer.kind === kind ? there : undefined;
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
  take({ layers, screen, defaults }, files, entry) {
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
    this.#defaults = new Map([...names].map((file) => [file, defaults[file ?? entry]]));
    const parsed = new Map([...texts].map(([file, text]) => [file, new TomlText(text, this.#defaults.get(file))]));
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
      return { key: `${file ?? ""} ${at}`, layer, at, toml, place: placeOf(toml, at, layer, this.screen) };
    }
    const why = toml
      ? SHARED_LINE
      : `This layer comes from ${file}: open that file together with the scene to change it here.`;
    return { key: `number ${index}`, layer, place: fixed(layer, this.screen, why) };
  }

  /**
   * The text of a file has changed by a hand: its layers are read anew. Returns the text.
   * @param {string | undefined} file
   * @param {(each: EditedLayer, at: number) => [now: Layer, at: number]} now What a layer of the file is now.
   */
  #follow(file, now) {
    const text = this.#editor.textOf(file) ?? "";
    this.#texts.set(file, text);
    const toml = new TomlText(text, this.#defaults.get(file));
    this.all = this.all.map((each) => {
      if (each.layer.file !== file || each.at === undefined) return each;
      const [layer, at] = now(each, each.at);
      return this.#describe(layer, toml, at);
    });
    return toml;
  }

  /**
   * A hand has changed a layer, which has this new box where only a check knows that.
   * @param {EditedLayer} changed
   * @param {Box} [box] Of its first copy.
   */
  reread(changed, box) {
    this.#follow(changed.layer.file, ({ key, layer, place }, at) => {
      if (!box || key !== changed.key) return [layer, at];
      const { x, y, width, height } = bounds(box, place.copies);
      return [{ ...layer, boxMm: [x, y, width, height] }, at];
    });
  }

  /**
   * A hand has given a layer another name. Returns it.
   * @param {EditedLayer} edited
   * @param {string} name
   */
  rename({ key: renamed, layer: { file } }, name) {
    this.#follow(file, ({ key, layer }, at) => [key === renamed ? { ...layer, name } : layer, at]);
    return this.find(renamed);
  }

  /**
   * A hand is changing a layer: what is felt of the layers now. A check of a text with other layers says nothing.
   * @param {Layer[]} layers In the order of the text.
   */
  feel(layers) {
    const isSame = (/** @type {EditedLayer} */ { layer }, /** @type {number} */ at) =>
      layer.name === layers[at].name && layer.kind === layers[at].kind;
    if (layers.length !== this.all.length || !this.all.every(isSame)) return;
    for (const [at, { layer }] of this.all.entries()) {
      const { index, perceived, felt } = layers[at];
      Object.assign(layer, { index, perceived, felt });
    }
  }

  /**
   * A hand has put a layer into its file, with this number among those of the file. Returns it.
   * @param {Layer} layer
   * @param {number} at
   */
  insert(layer, at) {
    const { file } = layer;
    const toml = this.#follow(file, (each, before) => [each.layer, before < at ? before : before + 1]);
    const made = this.#describe(layer, toml, at);
    const below = this.all.findIndex((each) => each.layer.file === file && each.at === at - 1);
    this.all = this.all.toSpliced(below < 0 ? this.all.length : below + 1, 0, made);
    return made;
  }

  /**
   * A hand has taken a layer out of its file.
   * @param {EditedLayer} edited
   */
  remove(edited) {
    const { layer, at = 0 } = edited;
    this.all = this.all.filter((each) => each !== edited);
    this.#follow(layer.file, (each, before) => [each.layer, before < at ? before : before - 1]);
  }

  /**
   * The layers under a place, the smallest first, of equal ones the upper.
   * @param {number} xMm
   * @param {number} yMm
   * @param {number} nearMm How far from a layer a press still counts.
   */
  under(xMm, yMm, nearMm) {
    const isIn = (/** @type {EditedLayer} */ { place: { box, copies } }) =>
      copies.some(([dx, dy]) => {
        const [x, y] = [xMm - box.x - dx, yMm - box.y - dy];
        return x >= -nearMm && x <= box.width + nearMm && y >= -nearMm && y <= box.height + nearMm;
      });
    return this.all.filter(isIn).reverse().sort((a, b) => areaOf(a) - areaOf(b));
  }
}

/** @param {EditedLayer} edited */
export function areaOf({ place: { box } }) {
  return box.width * box.height;
}

/**
 * The values of a layer, as words to compare.
 * @param {EditedLayer | undefined} edited
 */
function wordsOf(edited) {
  return edited?.at === undefined ? undefined : JSON.stringify(edited.toml?.value(["layer", edited.at]));
}

/**
 * The same without the name.
 * @param {EditedLayer | undefined} edited
 */
function unnamedWordsOf(edited) {
  const words = wordsOf(edited);
  return words && JSON.stringify({ ...JSON.parse(words), name: undefined });
}

/**
 * How many layers the file of a layer has.
 * @param {EditedLayer | undefined} edited
 */
function countOf(edited) {
  const layers = edited?.toml?.value(["layer"]);
  return Array.isArray(layers) ? layers.length : 0;
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
