// Tabs, with arrow keys.
// @ts-check

import { byId } from "./dom.js";

/** @param {HTMLElement} list */
export function makeTabs(list) {
  /** @type {NodeListOf<HTMLElement>} */
  const found = list.querySelectorAll('[role="tab"]');
  const tabs = [...found];
  const choose = (/** @type {HTMLElement} */ chosen) => {
    for (const tab of tabs) {
      const isChosen = tab === chosen;
      tab.setAttribute("aria-selected", String(isChosen));
      tab.tabIndex = isChosen ? 0 : -1;
      byId(tab.getAttribute("aria-controls") ?? "").hidden = !isChosen;
    }
  };
  for (const [at, tab] of tabs.entries()) {
    tab.onclick = () => choose(tab);
    tab.onkeydown = ({ key }) => {
      const step = stepOf(key);
      if (!step) return;
      const next = tabs[(at + step + tabs.length) % tabs.length];
      choose(next);
      next.focus();
    };
  }
  choose(tabs[0]);
}

/**
 * How many tabs an arrow key goes on.
 * @param {string} key
 */
export function stepOf(key) {
  return { ArrowLeft: -1, ArrowRight: 1 }[key] ?? 0;
}
