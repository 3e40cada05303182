// The scene that a person works on, kept in the browser, so that a reload or a closed tab does not lose it.

import { projectOf, zipOf } from "./archive.js";
import { settings } from "./dom.js";
import { fromBase64, toBase64 } from "./share.js";

const SETTING = "scene";
/** A pause in typing after which the scene is kept, ms. */
const PAUSE_MS = 400;
/** What stands before the zip: whether the scene was changed since it was opened. */
const MARKS = { edited: "edited ", opened: "opened " };

export class Autosave {
  #current;
  #timer;
  #isKept = true;
  /** Whether the scene was changed since it was opened. */
  isEdited = false;

  /** `current()` gives the project as archive.js packs it. */
  constructor(current) {
    this.#current = current;
    addEventListener("pagehide", () => this.#keepNow());
    addEventListener("beforeunload", (event) => {
      this.#keepNow();
      if (this.isEdited && !this.#isKept) event.preventDefault();
    });
  }

  /** The project that was kept last, with `isEdited`, or undefined. */
  static last() {
    const kept = settings.get(SETTING);
    const mark = Object.values(MARKS).find((each) => kept?.startsWith(each));
    if (!mark) return undefined;
    try {
      return { ...projectOf(fromBase64(kept.slice(mark.length))), isEdited: mark === MARKS.edited };
    } catch {
      return undefined;
    }
  }

  /** The scene was changed by hand. */
  changed() {
    this.isEdited = true;
    this.#later();
  }

  /** Another scene is open. */
  opened(isEdited) {
    this.isEdited = isEdited;
    this.#later();
  }

  #later() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#keep(), PAUSE_MS);
  }

  /** Keeps what waits to be kept. */
  #keepNow() {
    if (this.#timer !== undefined) this.#keep();
  }

  #keep() {
    clearTimeout(this.#timer);
    this.#timer = undefined;
    const mark = this.isEdited ? MARKS.edited : MARKS.opened;
    this.#isKept = settings.set(SETTING, mark + toBase64(zipOf(this.#current())));
  }
}
