// The editor of the scene's text: colours, completion, mistakes in place, undo.

import {
  EditorState,
  EditorView,
  HighlightStyle,
  StreamLanguage,
  autocompletion,
  bracketMatching,
  closeBrackets,
  completionKeymap,
  defaultKeymap,
  drawSelection,
  highlightActiveLine,
  highlightActiveLineGutter,
  highlightSpecialChars,
  history,
  historyKeymap,
  keymap,
  lineNumbers,
  lintGutter,
  lintKeymap,
  redo,
  setDiagnostics,
  syntaxHighlighting,
  tags,
  toml,
  undo,
} from "../vendor/studio-vendor.js";
import { completeFrom } from "./completion.js";

const colours = HighlightStyle.define([
  { tag: tags.comment, color: "var(--soft)", fontStyle: "italic" },
  { tag: [tags.propertyName, tags.definition(tags.propertyName)], color: "var(--accent)" },
  { tag: tags.string, color: "var(--good)" },
  { tag: [tags.number, tags.bool, tags.atom], color: "var(--felt)" },
]);

export class Editor {
  #view;

  /** `onChange(text)` is called after each change, by hand or not. */
  constructor(parent, schema, onChange) {
    const changed = EditorView.updateListener.of((update) => update.docChanged && onChange(this.text));
    const label = EditorView.contentAttributes.of({ "aria-label": "Text of the scene" });
    this.extensions = [
      lineNumbers(),
      lintGutter(),
      highlightActiveLineGutter(),
      highlightSpecialChars(),
      history(),
      drawSelection(),
      bracketMatching(),
      closeBrackets(),
      highlightActiveLine(),
      StreamLanguage.define(toml),
      syntaxHighlighting(colours),
      autocompletion({ override: [completeFrom(schema)] }),
      EditorView.lineWrapping,
      changed,
      label,
      // No Tab: it leaves the editor, as everywhere on the page.
      keymap.of([...completionKeymap, ...lintKeymap, ...historyKeymap, ...defaultKeymap]),
    ];
    this.#view = new EditorView({ parent, state: EditorState.create({ extensions: this.extensions }) });
  }

  get text() {
    return this.#view.state.doc.toString();
  }

  /** Replaces the text; undo brings the old one back. */
  set text(text) {
    const { length } = this.#view.state.doc;
    this.#view.dispatch({
      changes: { from: 0, to: length, insert: text },
      selection: { anchor: 0 },
      scrollIntoView: true,
    });
  }

  /** Inserts text behind a line (0: before the first) and shows it. */
  insertAfterLine(number, text) {
    const { doc } = this.#view.state;
    const at = number === 0 ? 0 : doc.line(Math.min(number, doc.lines)).to;
    const insert = number === 0 ? `${text}\n` : `\n${text}`;
    this.#view.dispatch({
      changes: { from: at, insert },
      selection: { anchor: at + insert.length },
      scrollIntoView: true,
    });
  }

  append(text) {
    const { doc } = this.#view.state;
    const gap = doc.toString().endsWith("\n") || doc.length === 0 ? "\n" : "\n\n";
    const insert = `${gap}${text.trim()}\n`;
    this.#view.dispatch({
      changes: { from: doc.length, insert },
      selection: { anchor: doc.length + insert.length },
      scrollIntoView: true,
    });
  }

  goToLine(number) {
    const line = this.#view.state.doc.line(Math.max(1, Math.min(number, this.#view.state.doc.lines)));
    this.#view.dispatch({
      selection: { anchor: line.from },
      effects: EditorView.scrollIntoView(line.from, { y: "center" }),
    });
    this.#view.focus();
  }

  undo() {
    undo(this.#view);
  }

  redo() {
    redo(this.#view);
  }

  /** Marks mistakes and warnings of the engine in place. */
  mark(problems) {
    const { doc } = this.#view.state;
    const at = (line, column) => {
      const { from, to } = doc.line(Math.max(1, Math.min(line, doc.lines)));
      return Math.min(to, from + Math.max(0, (column ?? 1) - 1));
    };
    const diagnostics = problems
      .filter(({ line }) => line !== undefined)
      .map((problem) => {
        const from = at(problem.line, problem.column);
        const end = problem.endLine === undefined ? doc.lineAt(from).to : at(problem.endLine, problem.endColumn);
        return { from, to: Math.max(from, end), severity: problem.severity, message: problem.message };
      });
    this.#view.dispatch(
      setDiagnostics(
        this.#view.state,
        diagnostics.sort((a, b) => a.from - b.from),
      ),
    );
  }
}
