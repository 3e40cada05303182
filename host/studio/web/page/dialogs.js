// What the page's dialogs share: the buttons that lead out of them.
// @ts-check

import { element } from "./dom.js";
import { attempt } from "./notices.js";

/** A button with `data-close` closes its dialog before it does anything else. */
export function followCloses() {
  const close = (/** @type {Event} */ { target }) => {
    const button = target instanceof Element ? target.closest("[data-close]") : null;
    button?.closest("dialog")?.close();
  };
  document.addEventListener("click", close, { capture: true });
}

/**
 * A button that closes its dialog and does what was chosen in it.
 * @param {string} words
 * @param {() => unknown} act
 */
export function choiceButton(words, act) {
  return element("button", { className: "primary", "data-close": "", onclick: () => attempt(act) }, words);
}
