// The editor of the scene's text and of the files that belong to it: colours, completion, mistakes in place, undo.
// @ts-check

import { EditorState, EditorView, redo, setDiagnostics, undo } from "../vendor/studio-vendor.js";
import { editorExtensions } from "./editor_setup.js";
import { HeldChange } from "./held_change.js";
import { notify } from "./notices.js";
import { TEXT_MAX_BYTES, bytesOf, tooLarge } from "./project.js";

/** @import { StateCommand, Transaction } from "../vendor/studio-vendor.js" */
/** @import { Problem } from "../engine/types" */
/** @import { Schema } from "./completion.js" */
/** @typedef {{ name: string | undefined, isShown: boolean, mistakes: number }} FileOfScene */

/** A file is called by its name; `undefined` is the scene. */
export class Editor {
  #view;
  #extensions;
  /**
   * The file that is shown, and the states of the others.
   * @type {string | undefined}
   */
  #shown;
  /** @type {Map<string | undefined, EditorState>} */
  #hidden = new Map();
  /** @type {Problem[]} */
  #problems = [];
  /**
   * A text has changed, by hand or not: `undefined` is the file of the scene.
   * @type {(file: string | undefined, text: string) => void}
   */
  onChange = () => {};
  /**
   * What can be undone or redone in the file that is shown may have changed.
   * @type {() => void}
   */
  onHistory = () => {};
  /**
   * Another file is shown, or has other mistakes.
   * @type {(files: FileOfScene[]) => void}
   */
  onFiles = () => {};
  /** A person is led to a place in the text: it has to be seen. */
  onReveal = () => {};

  /**
   * @param {HTMLElement} parent
   * @param {Schema} schema
   */
  constructor(parent, schema) {
    const changed = EditorView.updateListener.of(({ docChanged, state }) => {
      if (!docChanged) return;
      this.onChange(this.#shown, state.doc.toString());
      this.onHistory();
    });
    const limit = EditorState.changeFilter.of((change) => this.#isShortEnough(change));
    this.#extensions = [editorExtensions(schema), limit, changed];
    const view = new EditorView({ parent, state: this.#newState("") });
    this.#view = view;
    // The list of mistakes opens below the editor: the line that a person writes stays in sight.
    let heightPx = 0;
    new ResizeObserver(() => {
      const { head } = view.state.selection.main;
      const { top, height } = view.dom.getBoundingClientRect();
      const cursor = view.coordsAtPos(head);
      const wasSeen = cursor !== null && cursor.top >= top && cursor.bottom <= top + heightPx;
      heightPx = height;
      if (view.hasFocus && wasSeen) view.dispatch({ effects: EditorView.scrollIntoView(head) });
    }).observe(view.dom);
  }

  /**
   * Whether a change leaves no more text than the studio can check while a person types.
   * @param {Transaction} change
   */
  #isShortEnough({ newDoc, startState }) {
    // A character has three bytes at most.
    if (newDoc.length * 3 <= TEXT_MAX_BYTES) return true;
    const [bytes, before] = [newDoc, startState.doc].map((doc) => bytesOf(doc.toString()));
    if (bytes <= TEXT_MAX_BYTES || bytes <= before) return true;
    notify(tooLarge("text", bytes, TEXT_MAX_BYTES));
    return false;
  }

  /** @param {string} doc */
  #newState(doc) {
    return EditorState.create({ doc, extensions: this.#extensions });
  }

  /** The scene's text. */
  get text() {
    const state = this.#shown === undefined ? this.#view.state : this.#hidden.get(undefined);
    return state?.doc.toString() ?? "";
  }

  /** Replaces the scene's text; undo brings the old one back. */
  set text(text) {
    this.show();
    this.#replace(0, this.#view.state.doc.length, text, 0);
  }

  /**
   * Replaces a part of the shown text, and moves the cursor, which is seen then.
   * @param {number} from
   * @param {number} to
   * @param {string} insert
   * @param {number} anchor
   */
  #replace(from, to, insert, anchor = from + insert.length) {
    this.#view.dispatch({ changes: { from, to, insert }, selection: { anchor }, scrollIntoView: true });
  }

  /**
   * Shows another scene, with a history of its own: undo does not lead back into the scene before.
   * @param {string} text
   */
  open(text) {
    this.show();
    this.#view.setState(this.#newState(text));
    this.onChange(undefined, text);
    this.onHistory();
  }

  /**
   * Sets the files beside the scene, given as `[name, text]`.
   * @param {[string, string][]} files
   */
  setFiles(files) {
    const names = files.map(([name]) => name);
    if (this.#shown !== undefined && !names.includes(this.#shown)) this.show();
    for (const name of this.#hidden.keys()) if (name !== undefined && !names.includes(name)) this.#hidden.delete(name);
    for (const [name, text] of files) {
      if (name !== this.#shown && this.#hidden.get(name)?.doc.toString() !== text)
        this.#hidden.set(name, this.#newState(text));
    }
    this.onFiles(this.files);
  }

  /**
   * The files, the scene's first: name, whether it is shown, and how many mistakes it has.
   * @returns {FileOfScene[]}
   */
  get files() {
    const names = [...this.#hidden.keys(), this.#shown].filter((name) => name !== undefined).sort();
    return [undefined, ...names].map((name) => ({
      name,
      isShown: name === this.#shown,
      mistakes: this.#problems.filter(({ file, severity }) => file === name && severity === "error").length,
    }));
  }

  /** @param {string | undefined} file */
  has(file) {
    return file === this.#shown || this.#hidden.has(file);
  }

  /** @param {string} [file] */
  show(file) {
    const state = this.#hidden.get(file);
    if (file === this.#shown || !state) return;
    this.#hidden.set(this.#shown, this.#view.state);
    this.#shown = file;
    this.#view.setState(state);
    this.#hidden.delete(file);
    this.#markShown();
    this.onFiles(this.files);
    this.onHistory();
  }

  /**
   * The text of a file, if it is here.
   * @param {string | undefined} file
   */
  textOf(file) {
    return this.versionOf(file)?.toString();
  }

  /**
   * The version of that text: another one after each change, also after one that brings a text back.
   * @param {string | undefined} file
   */
  versionOf(file) {
    const state = file === this.#shown ? this.#view.state : this.#hidden.get(file);
    return state?.doc;
  }

  /**
   * Shows a file that a hand changes on the map: all that the hand does is one step of undo.
   * @param {string | undefined} file
   */
  hold(file) {
    this.show(file);
    return new HeldChange(this.#view, () => this.onHistory());
  }

  /**
   * Gives a file this text, in one step of undo.
   * @param {string | undefined} file
   * @param {string} text
   */
  change(file, text) {
    const held = this.hold(file);
    const isMade = held.make(text);
    held.end();
    if (!isMade) throw new Error("The text has no room for this layer.");
  }

  /** @param {string} text */
  append(text) {
    this.show();
    const { doc } = this.#view.state;
    const gap = doc.toString().endsWith("\n") || doc.length === 0 ? "\n" : "\n\n";
    this.#replace(doc.length, doc.length, `${gap}${text.trim()}\n`);
  }

  /**
   * @param {string | undefined} file
   * @param {number} number
   */
  goTo(file, number, { focuses = true } = {}) {
    this.onReveal();
    this.show(file);
    const line = this.#view.state.doc.line(Math.max(1, Math.min(number, this.#view.state.doc.lines)));
    this.#view.dispatch({
      selection: { anchor: line.from },
      effects: EditorView.scrollIntoView(line.from, { y: "center" }),
    });
    if (focuses) this.#view.focus();
  }

  undo() {
    undo(this.#view);
  }

  redo() {
    redo(this.#view);
  }

  get canUndo() {
    return this.#can(undo);
  }

  get canRedo() {
    return this.#can(redo);
  }

  /**
   * A command of the editor tells, without a view to change, whether there is something to do.
   * @param {StateCommand} command
   */
  #can(command) {
    return command({ state: this.#view.state, dispatch: () => {} });
  }

  /**
   * Marks mistakes and warnings of the engine in place, each in its file.
   * @param {Problem[]} problems
   */
  mark(problems) {
    this.#problems = problems;
    this.#markShown();
    this.onFiles(this.files);
  }

  #markShown() {
    const { doc } = this.#view.state;
    const at = (/** @type {number} */ line, /** @type {number | undefined} */ column) => {
      const { from, to } = doc.line(Math.max(1, Math.min(line, doc.lines)));
      return Math.min(to, from + Math.max(0, (column ?? 1) - 1));
    };
    const diagnostics = this.#problems.flatMap(({ file, line, column, endLine, endColumn, severity, message }) => {
      if (file !== this.#shown || line === undefined) return [];
      const from = at(line, column);
      const end = endLine === undefined ? doc.lineAt(from).to : at(endLine, endColumn);
      return [{ from, to: Math.max(from, end), severity, message }];
    });
    const inOrder = diagnostics.sort((a, b) => a.from - b.from);
    this.#view.dispatch(setDiagnostics(this.#view.state, inOrder));
  }
}
