// A change of a text that goes on as long as a hand holds something: one step of undo, however often the hand moves.
// @ts-check

import { Annotation, Transaction, isolateHistory } from "../vendor/studio-vendor.js";

/** @import { ChangeSet, EditorView } from "../vendor/studio-vendor.js" */

/** Marks changes that belong to the step of undo before. */
const continuesStep = Annotation.define();

/**
 * For CodeMirror's history: whether a change joins the step before, which is not long ago.
 * @param {Transaction} transaction
 * @param {boolean} isAdjacent
 */
export function joinHeld(transaction, isAdjacent) {
  return isAdjacent || transaction.annotation(continuesStep) === true;
}

export class HeldChange {
  #view;
  #onRestored;
  #start;
  #now;
  /** @type {ChangeSet} */
  #made;
  /** @type {number | undefined} */
  #beganMs;

  /**
   * @param {EditorView} view
   * @param {() => void} onRestored There is no step of undo: the change was taken back.
   */
  constructor(view, onRestored = () => {}) {
    this.#view = view;
    this.#onRestored = onRestored;
    this.#start = view.state;
    this.#now = view.state.doc;
    this.#made = view.state.changes([]);
  }

  /** Whether the text is another than this change has left: it must not go on. */
  get isOver() {
    return this.#view.state.doc !== this.#now;
  }

  /**
   * Makes this text of the one before, in place of what was made last. Returns whether the text is this one: the editor
   * takes none that is too long.
   * @param {string} text
   */
  make(text) {
    if (this.isOver) return false;
    const next = this.#start.changes(difference(this.#start.doc.toString(), text));
    const changes = this.#made.invert(this.#start.doc).compose(next);
    if (changes.empty) return true;
    // The history joins changes of one time: the hand may rest as long as it likes.
    const beganMs = this.#beganMs ?? Date.now();
    const step = this.#beganMs === undefined ? isolateHistory.of("before") : continuesStep.of(true);
    this.#view.dispatch({ changes, annotations: [step, Transaction.time.of(beganMs)] });
    if (!this.isOver) return false;
    this.#beganMs = beganMs;
    this.#made = next;
    this.#now = this.#view.state.doc;
    return true;
  }

  /** The hand lets go: what comes next is another step. Where nothing has changed in the end, there is no step. */
  end() {
    if (this.#beganMs === undefined || this.isOver) return;
    if (this.#made.empty) this.#restore();
    else this.#view.dispatch({ annotations: isolateHistory.of("full") });
  }

  /** Brings back what could be undone and redone before. */
  #restore() {
    const { scrollTop } = this.#view.scrollDOM;
    this.#view.setState(this.#start);
    this.#view.scrollDOM.scrollTop = scrollTop;
    this.#onRestored();
  }
}

/**
 * The one replacement that makes a text of another.
 * @param {string} before
 * @param {string} after
 */
function difference(before, after) {
  const shorter = Math.min(before.length, after.length);
  let from = 0;
  while (from < shorter && before[from] === after[from]) from += 1;
  let same = 0;
  while (same < shorter - from && before.at(-1 - same) === after.at(-1 - same)) same += 1;
  return { from, to: before.length - same, insert: after.slice(from, after.length - same) };
}
