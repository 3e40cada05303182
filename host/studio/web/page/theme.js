// Light or dark: as the system has it, until the button is pressed.
// @ts-check

import { byId, forgetColours, settings } from "./dom.js";

/** @param {() => void} onChange */
export function makeTheme(onChange) {
  const system = matchMedia("(prefers-color-scheme: dark)");
  const root = document.documentElement;
  const change = () => {
    forgetColours();
    onChange();
  };
  const kept = settings.get("theme");
  if (kept) {
    root.dataset.theme = kept;
    change();
  }
  for (const media of [system, matchMedia("(forced-colors: active)")]) media.addEventListener("change", change);
  byId("theme").onclick = () => {
    const isDark = (root.dataset.theme ?? (system.matches ? "dark" : "light")) === "dark";
    root.dataset.theme = isDark ? "light" : "dark";
    settings.set("theme", root.dataset.theme);
    change();
  };
}
