// Which layer is selected on the map: what becomes of that when a check brings other layers, and what it awaits.
// @ts-check

/** @import { EditedLayer, EditedLayers } from "./edited_layers.js" */
/** @import { Project } from "./project.js" */
/**
 * The layer behind all others in the text of a scene is selected, once a check finds more than `count` layers there.
 * `opened` is the scene, as the project counts them. `isNew`: that scene opens next, and the mode Edit begins with it.
 * @typedef {{ opened: number, count: number, isNew?: boolean }} Awaited
 */

/** So many changes back it is known what was selected. */
const PAST_MAX = 10;

export class Selection {
  #layers;
  #project;
  /** @type {string | undefined} */
  key;
  /** The scene that the layers are of, as the project counts them. */
  #opened = 0;
  /** @type {Awaited | undefined} */
  #awaited;
  /**
   * What was selected in texts before layers came or went: where one of them is back, so is what was selected in it.
   * @type {{ file: string | undefined, text: string, key: string }[]}
   */
  #past = [];

  /**
   * @param {EditedLayers} layers
   * @param {Project} project
   */
  constructor(layers, project) {
    this.#layers = layers;
    this.#project = project;
  }

  get layer() {
    return this.#layers.find(this.key);
  }

  /** Layers are about to come or go. */
  remember() {
    const { layer } = this;
    if (!layer?.toml) return;
    const now = { file: layer.layer.file, text: layer.toml.text, key: layer.key };
    this.#past = [...this.#past, now].slice(-PAST_MAX);
  }

  /** Forgets what was selected in the text that is back, and all since; returns it. */
  #recall() {
    const textOf = (/** @type {string | undefined} */ name) =>
      this.#layers.all.find(({ layer, toml }) => layer.file === name && toml)?.toml?.text;
    const at = this.#past.findLastIndex(({ file, text }) => textOf(file) === text);
    if (at < 0) return undefined;
    const { key } = this.#past[at];
    this.#past = this.#past.slice(0, at);
    return this.#layers.find(key);
  }

  /** Awaits a layer that comes behind those of the scene that is open. */
  awaitLast() {
    this.#awaited = { opened: this.#project.opened, count: this.#layers.all.length };
  }

  awaitNothing() {
    this.#awaited = undefined;
  }

  /**
   * Awaits the last layer of the scene that an action opens.
   * @param {() => Promise<unknown>} open
   */
  async awaitLastOfNext(open) {
    const awaited = { opened: this.#project.opened + 1, count: 0, isNew: true };
    this.#awaited = awaited;
    try {
      await open();
    } catch (error) {
      if (this.#awaited === awaited) this.#awaited = undefined;
      throw error;
    }
  }

  /**
   * A check has brought the layers: the key of that which is selected now, and whether the mode Edit begins with it.
   * @param {EditedLayer | undefined} before That which was selected of the layers before.
   * @param {boolean} isEditing Whether what was selected before an undo is selected again.
   */
  follow(before, isEditing) {
    const { opened } = this.#project;
    const isSameScene = opened === this.#opened;
    this.#opened = opened;
    const awaited = this.#awaited?.opened === opened ? this.#awaited : undefined;
    // What is awaited of a scene that is not open yet stays so.
    if (this.#awaited && this.#awaited.opened <= opened) this.#awaited = undefined;
    const last = awaited && this.#layers.all.length > awaited.count ? this.#layers.last : undefined;
    const after = before && isSameScene ? this.#layers.successor(before) : undefined;
    if (!isSameScene) this.#past = [];
    const recalled = this.#recall();
    return { key: (last ?? after ?? (isEditing ? recalled : undefined))?.key, beginsEdit: awaited?.isNew === true };
  }
}
