// What the page's dialogs share: their heads, and the buttons that lead out of them.
// @ts-check

import { element } from "./dom.js";
import { attempt } from "./notices.js";

/**
 * Fills a dialog with a title, these buttons and one that closes it, and this content.
 * @param {HTMLDialogElement} dialog
 * @param {string} title
 * @param {HTMLElement[]} buttons
 * @param {(Node | string)[]} content
 */
export function fillDialog(dialog, title, buttons, ...content) {
  const close = element("button", { onclick: () => dialog.close() }, "Close");
  dialog.replaceChildren(element("div", { className: "head" }, element("h2", {}, title), ...buttons, close), ...content);
}

/**
 * A button that closes its dialog and does what was chosen in it.
 * @param {HTMLDialogElement} dialog
 * @param {string} words
 * @param {() => unknown} act
 * @param {{ className?: string }} [about]
 */
export function choiceButton(dialog, words, act, about = { className: "primary" }) {
  const onclick = () => {
    dialog.close();
    attempt(act);
  };
  return element("button", { ...about, onclick }, words);
}
