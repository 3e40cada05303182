// What the editor of texts is made of: colours, completion, keys and history of CodeMirror.
// @ts-check

import {
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
  syntaxHighlighting,
  tags,
  toml,
} from "../vendor/studio-vendor.js";
import { completeFrom } from "./completion.js";
import { joinHeld } from "./held_change.js";

/** @import { Schema } from "./completion.js" */

const colours = HighlightStyle.define([
  { tag: tags.comment, color: "var(--soft)", fontStyle: "italic" },
  { tag: [tags.propertyName, tags.definition(tags.propertyName)], color: "var(--accent)" },
  { tag: tags.string, color: "var(--good)" },
  { tag: [tags.number, tags.bool, tags.atom], color: "var(--felt)" },
]);

/**
 * All that does not depend on the scene.
 * @param {Schema} schema
 */
export function editorExtensions(schema) {
  return [
    lineNumbers(),
    lintGutter(),
    highlightActiveLineGutter(),
    highlightSpecialChars(),
    history({ joinToEvent: joinHeld }),
    drawSelection(),
    bracketMatching(),
    closeBrackets(),
    highlightActiveLine(),
    StreamLanguage.define(toml),
    syntaxHighlighting(colours),
    autocompletion({ override: [completeFrom(schema)] }),
    EditorView.lineWrapping,
    EditorView.contentAttributes.of({ "aria-label": "Text of the scene", tabindex: "0" }),
    // No Tab: it leaves the editor, as everywhere on the page.
    keymap.of([...completionKeymap, ...lintKeymap, ...historyKeymap, ...defaultKeymap]),
  ];
}
