// A layer that a hand has taken out: a notice says which, and offers the way back.
// @ts-check

import { shortName } from "./dom.js";
import { notify } from "./notices.js";

/** @import { Layer } from "../engine/types" */
/** @import { Editor } from "./editor.js" */

export class Removal {
  #editor;
  #undo;
  /** The version of the text without the layer. @type {unknown} */
  #version;
  /** @type {string | undefined} */
  #file;
  #forget = () => {};

  /**
   * @param {Editor} editor
   * @param {() => void} undo Takes back the last step.
   */
  constructor(editor, undo) {
    this.#editor = editor;
    this.#undo = undo;
  }

  /** @param {Layer} layer That the text has no more. */
  say({ name, file }) {
    this.#file = file;
    this.#version = this.#editor.versionOf(file);
    const action = () => {
      if (!this.#isLast) {
        notify("The text has changed since: undo it step by step, with Ctrl+Z.");
        return;
      }
      this.#editor.show(file);
      this.#undo();
    };
    this.#forget = notify(`Removed ${shortName(name)}.`, { words: "Undo", action }, { isGood: true });
  }

  /** Whether nothing has changed the text since. */
  get #isLast() {
    return this.#editor.versionOf(this.#file) === this.#version;
  }

  /** The texts were checked: the offer goes once they have changed. */
  follow() {
    if (!this.#isLast) this.#forget();
  }
}
