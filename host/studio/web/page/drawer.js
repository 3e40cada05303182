// The drawer with text and tools: closed at the first visit, and as it was left at the next ones.
// @ts-check

import { byId, settings } from "./dom.js";

/** Where it is kept whether the drawer is open. */
const SETTING = "drawer";

export class Drawer {
  #drawer = byId("drawer");
  #toggle = byId("toggle-drawer");

  constructor() {
    this.#toggle.onclick = () => (this.isOpen ? this.#show(false) : this.open());
    this.#show(settings.get(SETTING) === "open");
  }

  get isOpen() {
    return !this.#drawer.hidden;
  }

  open() {
    if (this.isOpen) return;
    this.#show(true);
    // In a low or narrow window it stands below what is felt.
    this.#drawer.scrollIntoView({ block: "nearest" });
  }

  /** @param {boolean} isOpen */
  #show(isOpen) {
    this.#drawer.hidden = !isOpen;
    this.#toggle.setAttribute("aria-expanded", String(isOpen));
    document.querySelector("main")?.classList.toggle("has-drawer", isOpen);
    settings.set(SETTING, isOpen ? "open" : "closed");
  }
}
