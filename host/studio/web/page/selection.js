// Which layer is selected on the map: what becomes of that when a check brings other layers, and what it awaits.
// @ts-check

/** @import { EditedLayer, EditedLayers } from "./edited_layers.js" */
/** @import { Project } from "./project.js" */
/**
 * The layer behind all others in the text of a scene is selected, once a check finds more than `count` layers there.
 * `opened` is the scene, as the project counts them. `isNew`: the scene is about to open, and the mode Edit begins then.
 * @typedef {{ opened: number, count: number, isNew?: boolean }} Awaited
 */

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
   */
  follow(before) {
    const { opened } = this.#project;
    const isSameScene = opened === this.#opened;
    this.#opened = opened;
    const awaited = this.#awaited?.opened === opened ? this.#awaited : undefined;
    // What is awaited of a scene that is not open yet stays so.
    if (this.#awaited && this.#awaited.opened <= opened) this.#awaited = undefined;
    const last = awaited && this.#layers.all.length > awaited.count ? this.#layers.last : undefined;
    const after = before && isSameScene ? this.#layers.successor(before) : undefined;
    return { key: (last ?? after)?.key, beginsEdit: awaited?.isNew === true };
  }
}
