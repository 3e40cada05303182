// The layers of the scene: what is felt of each, and live switches and gains.
// @ts-check

import { byId, element, shortName } from "./dom.js";
import { feltLine, stepWords } from "./felt.js";
import { attempt, notify } from "./notices.js";
import { SHARED_LINE, TomlText } from "./toml_text.js";

/** @import { Engine } from "../engine/engine.js" */
/** @import { Layer } from "../engine/types" */
/** @import { Scale } from "./felt.js" */
/** @import { Editor } from "./editor.js" */
/** @typedef {{ on: boolean, gain: number }} Live */

export class Layers {
  #engine;
  #editor;
  /**
   * Switches and gains, by layer number, as long as the scene plays on.
   * @type {Map<number, Live>}
   */
  #live = new Map();
  /** @type {Layer[]} */
  #shown = [];
  /** Whether another scene is on its way to the board, whose layers have other numbers. */
  isSceneLoading = false;
  /**
   * Switches or gains differ from the scene's text: `onLive(["brick off", ...])`; empty where none does.
   * @type {(changes: string[]) => void}
   */
  onLive = () => {};
  /**
   * The name of a layer is pressed: whether it is selected elsewhere, and has the focus there.
   * @type {(layer: Layer) => boolean}
   */
  onChoose = () => false;
  /** A layer that starts off is to play once. @type {(layer: Layer) => void} */
  onPlayOnce = () => {};

  /**
   * @param {Engine} engine
   * @param {Editor} editor
   */
  constructor(engine, editor) {
    this.#engine = engine;
    this.#editor = editor;
  }

  /**
   * @param {Layer[]} layers
   * @param {Scale} scale
   */
  show(layers, scale) {
    const panel = byId("panel-layers");
    const active = document.activeElement;
    const focused = panel.contains(active) ? active?.getAttribute("aria-label") : undefined;
    this.#shown = layers;
    panel.replaceChildren(...layers.map((layer) => this.#row(layer, scale)));
    if (layers.length > 0) panel.append(element("p", { className: "fine step-words" }, stepWords()));
    else panel.append(element("p", { className: "soft" }, "This scene has no layer yet."));
    if (!focused) return;
    /** @type {HTMLElement | null} */
    const again = panel.querySelector(`[aria-label="${CSS.escape(focused)}"]`);
    again?.focus();
  }

  /** A play begins: layers are on or off, with a gain, as the scene says. */
  reset() {
    this.#live.clear();
    this.onLive([]);
  }

  /**
   * @param {Layer} layer
   * @param {Scale} scale
   */
  #row(layer, scale) {
    const { kind, file, from, controls } = layer;
    const name = shortName(layer.name);
    const shown = { className: "link", title: file ?? "" };
    const goTo = () => {
      const isChosen = this.onChoose(layer);
      this.#editor.goTo(file, from[0], { focuses: !isChosen });
    };
    const title = element(
      "div",
      {},
      this.#editor.has(file)
        ? element("button", { ...shown, type: "button", onclick: goTo }, name)
        : element("b", shown, name),
      ` ${kind}${controls.length > 1 ? ` × ${controls.length}` : ""}${file ? `, ${file}` : ""}`,
    );
    const note = element("p", { className: "fine live-note", hidden: true });
    const row = element("div", { className: "layer" }, title, this.#controls(layer, note), note);
    row.append(feltLine(layer, scale));
    return row;
  }

  /**
   * @param {Layer} layer
   * @param {HTMLElement} note
   */
  #controls(layer, note) {
    const { index, isLive, whyNotLive, file } = layer;
    const label = shortName(layer.name);
    if (!isLive) {
      const about = { title: whyNotLive, disabled: !this.#editor.has(file) };
      return element("button", { ...about, onclick: () => attempt(() => this.#makeLive(layer)) }, "Make live: switch, gain");
    }
    const state = this.#live.get(index) ?? { on: layer.startsOn, gain: layer.gain };
    const isOn = element("input", { type: "checkbox", checked: state.on, "aria-label": `${label} on` });
    // The slider has the gains of every day, as far as the drive can give them; the number all that a board takes.
    const [reachMin, reachMax] = layer.gainReach ?? [layer.gainMin, layer.gainMax];
    const most = Math.min(reachMax, Math.max(2, 2 * layer.gain));
    const least = Math.max(reachMin, Math.min(0, 2 * layer.gain));
    /** @type {(type: string, min: number, max: number, name: string) => HTMLInputElement} */
    const input = (type, min, max, name) =>
      element("input", { type, min, max, step: "any", value: state.gain, "aria-label": name });
    const slider = input("range", least, most, `gain of ${label}`);
    slider.step = "any";
    slider.value = `${state.gain}`;
    const number = input("number", layer.gainMin, layer.gainMax, `gain of ${label}, as a number`);
    isOn.onchange = async () => {
      const on = isOn.checked;
      if (!(await this.#change(layer, { on }, on ? "on" : "off", state))) isOn.checked = state.on;
      this.#note(layer, state, note);
    };
    const change = (/** @type {HTMLInputElement} */ from, /** @type {HTMLInputElement} */ to) => async () => {
      const gain = Number(from.value);
      if (from.value === "" || (from === number && !from.checkValidity())) return;
      to.value = `${gain}`;
      if (!(await this.#change(layer, { gain }, `gain ${gain}`, state))) from.value = to.value = `${state.gain}`;
      this.#note(layer, state, note);
    };
    slider.oninput = change(slider, number);
    number.oninput = change(number, slider);
    number.onchange = () => {
      if (number.value !== "" && number.checkValidity()) return;
      const range = `from ${layer.gainMin} to ${layer.gainMax}`;
      notify(`A gain of ${label} is a number ${range}: it stays ${state.gain}.`, undefined, { beside: number });
      number.value = `${state.gain}`;
    };
    const times = element("label", {}, "× ", number);
    const on = element("label", { className: "check" }, isOn, " on");
    const once = element("button", { type: "button", "aria-label": `Play ${label} once` }, "Play once");
    once.onclick = () => this.onPlayOnce(layer);
    return element("div", { className: "live" }, on, slider, times, ...(layer.startsOn ? [] : [once]));
  }

  /** @param {Layer} layer */
  #makeLive({ file, from }) {
    const toml = new TomlText(this.#editor.textOf(file) ?? "");
    const at = toml.layerAt(from[0]);
    if (at === undefined) throw new Error(SHARED_LINE);
    const live = { path: ["layer", at, "live"], value: true, decimals: 0, after: "kind" };
    this.#editor.change(file, toml.with([live]));
    this.#editor.onReveal();
  }

  /**
   * Says at the layer, and to the map, what differs from the scene's text.
   * @param {Layer} layer
   * @param {Live} state
   * @param {HTMLElement} note
   */
  #note({ gain: written, startsOn }, { on, gain }, note) {
    const isGain = gain !== written;
    note.hidden = on === startsOn && !isGain;
    const now = on ? (isGain ? `Gain ${gain} now` : "On now") : "Off now";
    const keep = isGain ? `, and write \`gain = ${gain}\` into it to keep it` : "";
    note.textContent = `${now}, until the scene changes. What is said here is for the scene as it is written${keep}.`;
    const changes = [...this.#live].flatMap(([index, state]) => {
      const layer = this.#shown.find((each) => each.index === index);
      if (!layer) return [];
      if (state.on !== layer.startsOn) return [`${layer.name} ${state.on ? "on" : "off"}`];
      return state.gain === layer.gain ? [] : [`${layer.name} × ${state.gain}`];
    });
    this.onLive(changes);
  }

  /**
   * Plays a layer that is off once, with all of its copies.
   * @param {Layer} layer Of the last check, which may be newer than the scene that plays.
   */
  async playOnce({ controls }) {
    if (this.isSceneLoading || controls.length === 0) {
      notify("The scene is on its way to the board: play its layer once it is there.");
      return;
    }
    for (const number of controls) await this.#engine.control(`trigger ${number}`);
  }

  /**
   * Sends only what was changed: the scene's gain stays until the slider is moved. Resolves to whether it was done. If
   * one copy is refused, those before it get their old setting back.
   * @param {Layer} layer
   * @param {{ on: boolean } | { gain: number }} next
   * @param {string} words
   * @param {Live} state
   */
  async #change({ index, controls }, next, words, state) {
    const before = "on" in next ? (state.on ? "on" : "off") : `gain ${state.gain}`;
    for (const [copy, number] of controls.entries()) {
      // Another scene may come between two copies.
      if (this.isSceneLoading) {
        notify("The scene is on its way to the board: change its layers once it is there.");
        return false;
      }
      const answer = await attempt(() => this.#engine.control(`layer ${number} ${words}`));
      if (answer === undefined) {
        for (const changed of controls.slice(0, copy)) {
          if (!this.isSceneLoading) await attempt(() => this.#engine.control(`layer ${changed} ${before}`));
        }
        return false;
      }
      if (answer.notice) notify(answer.notice);
    }
    Object.assign(state, next);
    this.#live.set(index, state);
    return true;
  }
}
