// Real size, also on the full screen: a bank card held to the screen says how many pixels a millimetre has.
// @ts-check

import { byId, settings } from "./dom.js";
import { attempt } from "./notices.js";

/** @import { FrictionMap } from "./map.js" */

/** Default CSS pixels per mm, without a measurement by a card: a CSS inch has 96. */
const NOMINAL_PX_PER_MM = 96 / 25.4;

export class RealSize {
  #map;
  #button = byId("real-size");
  /** @type {number | undefined} */
  #pixelsPerMm = Number(settings.get("pixelsPerMm")) || undefined;

  /** @param {FrictionMap} map */
  constructor(map) {
    this.#map = map;
    this.#button.setAttribute("aria-pressed", "false");
    this.#button.onclick = () => {
      if (this.#map.realSize) this.#show(undefined);
      else this.#ask((scale) => this.#show(scale));
    };
    const fullScreen = byId("full-screen");
    // A telephone may have none.
    fullScreen.hidden = !document.fullscreenEnabled;
    fullScreen.onclick = () => {
      if (this.#pixelsPerMm) attempt(() => this.#fillScreen(this.#pixelsPerMm));
      else this.#ask((scale) => attempt(() => this.#fillScreen(scale)));
    };
  }

  /**
   * Shows the map on the full screen, in real size, until a person leaves it; state, Stop and notices stay in sight.
   * @param {number | undefined} pixelsPerMm
   */
  async #fillScreen(pixelsPerMm) {
    const before = this.#map.realSize;
    await document.documentElement.requestFullscreen();
    document.body.classList.add("full-screen");
    this.#show(pixelsPerMm);
    document.onfullscreenchange = () => {
      if (document.fullscreenElement) return;
      document.body.classList.remove("full-screen");
      this.#show(before);
    };
  }

  /** @param {number | undefined} pixelsPerMm */
  #show(pixelsPerMm) {
    this.#map.realSize = pixelsPerMm;
    this.#button.setAttribute("aria-pressed", String(pixelsPerMm !== undefined));
    byId("real-size-mark").hidden = pixelsPerMm === undefined;
    this.#map.layout();
  }

  /**
   * Asks for the size of a bank card, and calls `show(pixelsPerMm)` once a person has given it.
   * @param {(pixelsPerMm: number) => void} show
   */
  #ask(show) {
    const width = byId("card-width");
    const draw = () => byId("bank-card").style.setProperty("--px-per-mm", width.value);
    width.value = String(this.#pixelsPerMm ?? NOMINAL_PX_PER_MM);
    width.oninput = draw;
    draw();
    byId("size-done").onclick = () => {
      this.#pixelsPerMm = Number(width.value);
      settings.set("pixelsPerMm", width.value);
      show(this.#pixelsPerMm);
    };
    byId("size").showModal();
  }
}
