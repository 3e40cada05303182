// The layers of the scene: what is felt of each, and live switches and gains.

import { attempt, byId, element } from "./dom.js";

export class Layers {
  #engine;
  #editor;
  /** Switches and gains, by layer name or number, as long as the scene plays on. */
  #live = new Map();

  constructor(engine, editor) {
    this.#engine = engine;
    this.#editor = editor;
  }

  show(check) {
    const panel = byId("panel-layers");
    // While a gain is dragged the list stays.
    if (panel.contains(document.activeElement) && document.activeElement.type === "range") return;
    panel.replaceChildren(...check.layers.map((layer) => this.#row(layer)));
    if (check.layers.length === 0) panel.append(element("p", { className: "soft" }, "This scene has no layer yet."));
  }

  /** A play begins: all layers are on, with the gain of the scene. */
  reset() {
    this.#live.clear();
  }

  #row(layer) {
    const { index, name, kind, felt, from } = layer;
    const title = element("div", {}, element("b", {}, name || `layer ${index}`), ` ${kind}`);
    const row = element("div", { className: "layer" }, title, this.#controls(layer));
    if (felt) row.append(element("p", { className: "fine" }, felt));
    if (from) {
      title.style.cursor = "pointer";
      title.onclick = () => this.#editor.goToLine(from[0]);
    }
    return row;
  }

  #controls(layer) {
    const { index, isLive, whyNotLive, from } = layer;
    if (!isLive) {
      const button = element("button", { title: whyNotLive ?? "", disabled: !from }, "Make live");
      button.onclick = () => this.#editor.insertAfterLine(from[0], "live = true");
      return button;
    }
    const state = this.#live.get(index) ?? { on: true, gain: 1 };
    const label = layer.name || `layer ${index}`;
    const isOn = element("input", { type: "checkbox", checked: state.on, "aria-label": `${label} on` });
    const gain = element("input", {
      type: "range",
      min: 0,
      max: 2,
      step: 0.05,
      value: state.gain,
      "aria-label": `gain of ${label}`,
    });
    const shown = element("output", {}, `× ${state.gain}`);
    isOn.onchange = () => this.#change(index, { on: isOn.checked }, isOn.checked ? "on" : "off", state);
    gain.oninput = () => {
      shown.textContent = `× ${Number(gain.value)}`;
      this.#change(index, { gain: Number(gain.value) }, `gain ${Number(gain.value)}`, state);
    };
    return element("div", { className: "live" }, element("label", { className: "check" }, isOn, " on"), gain, shown);
  }

  /** Sends only what was changed: the scene's gain stays until the slider is moved. */
  #change(index, next, words, state) {
    Object.assign(state, next);
    this.#live.set(index, state);
    attempt(() => this.#engine.control(`layer ${index} ${words}`));
  }
}
