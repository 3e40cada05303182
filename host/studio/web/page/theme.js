// Light or dark: as the system has it, until the button is pressed.

import { byId, forgetColours, settings } from "./dom.js";

export function makeTheme(onChange) {
  const system = matchMedia("(prefers-color-scheme: dark)");
  const root = document.documentElement;
  const change = () => {
    forgetColours();
    onChange();
  };
  if (settings.get("theme")) {
    root.dataset.theme = settings.get("theme");
    change();
  }
  system.addEventListener("change", change);
  byId("theme").onclick = () => {
    const isDark = (root.dataset.theme ?? (system.matches ? "dark" : "light")) === "dark";
    root.dataset.theme = isDark ? "light" : "dark";
    settings.set("theme", root.dataset.theme);
    change();
  };
}
