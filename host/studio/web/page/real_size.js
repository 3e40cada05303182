// Real size, also on the full screen: a bank card held to the screen says how many pixels a millimetre has.
// @ts-check

import { byId, element, settings } from "./dom.js";
import { attempt } from "./notices.js";

/** @import { FrictionMap } from "./map.js" */

/** A bank card, mm (ISO/IEC 7810 ID-1). */
const CARD = { widthMm: 85.6, heightMm: 53.98 };
/** Default CSS pixels per mm, without a measurement by a card: a CSS inch has 96. */
const NOMINAL_PX_PER_MM = 96 / 25.4;

export class RealSize {
  #map;
  #button = byId("real-size");
  #dialog = byId("size");
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
    let scale = this.#pixelsPerMm ?? NOMINAL_PX_PER_MM;
    const card = element("div", { className: "bank-card" }, "bank card");
    const size = element("input", {
      type: "range",
      min: 1.5,
      max: 12,
      step: 0.01,
      value: scale,
      "aria-label": "Width of the card",
    });
    Object.assign(size.style, { width: "100%", margin: "12px 0 0" });
    const draw = () =>
      Object.assign(card.style, {
        width: `${CARD.widthMm * scale}px`,
        height: `${CARD.heightMm * scale}px`,
        borderRadius: `${3.18 * scale}px`,
      });
    size.oninput = () => {
      scale = Number(size.value);
      draw();
    };
    draw();
    const done = element("button", { className: "primary" }, "Show in real size");
    done.onclick = () => {
      this.#pixelsPerMm = scale;
      settings.set("pixelsPerMm", String(scale));
      this.#dialog.close();
      show(scale);
    };
    const cancel = element("button", { onclick: () => this.#dialog.close() }, "Cancel");
    this.#dialog.replaceChildren(
      element("div", { className: "head" }, element("h2", {}, "Real size"), cancel, done),
      element(
        "p",
        {},
        "Hold a bank card (85.60 mm wide) to the screen and move the slider until the outline is as wide.",
      ),
      size,
      card,
    );
    this.#dialog.showModal();
  }
}
