// The dialog of New: four small scenes to begin with, one of them with a picture of one's own, and an empty one.
// @ts-check

import { BEGINNINGS, sceneWith } from "./beginnings.js";
import { byId, element } from "./dom.js";
import { attempt } from "./notices.js";
import { drawScene } from "./scene_picture.js";

/** @import { Engine } from "../engine/engine.js" */

/** Longer side of a scene's picture, pixels. */
const LONG_SIDE_PX = 240;
const EMPTY = `version = 1

# Edit adds layers, and so does the Gallery; or type [[layer]], then Ctrl+Space for what a layer can have.
`;

export class NewScene {
  #engine;
  #dialog = byId("new-scene");
  /**
   * A scene is chosen: `onScene(name, text)`.
   * @type {(name: string, text: string) => unknown}
   */
  onScene = () => {};
  /** A scene with a picture of one's own is wanted. */
  onPicture = () => {};

  /** @param {Engine} engine */
  constructor(engine) {
    this.#engine = engine;
    byId("new").onclick = () => attempt(() => this.#open());
  }

  async #open() {
    this.#dialog.showModal();
    this.#dialog.scrollTop = 0;
    if (this.#dialog.childElementCount > 0) return;
    const close = element("button", { onclick: () => this.#dialog.close() }, "Close");
    const scenes = element("div", { className: "scenes" });
    const empty = element("button", { onclick: () => this.#choose("untitled", EMPTY) }, "Empty scene");
    this.#dialog.append(
      element("div", { className: "head" }, element("h2", {}, "New scene"), empty, close),
      element("p", { className: "soft" }, "Begin with one of these, and change it."),
      scenes,
    );
    const cards = BEGINNINGS.map(({ name, words, layer }) => {
      const text = sceneWith(words, layer);
      const canvas = element("canvas", { "aria-hidden": "true" });
      const begin = element("button", { className: "primary" }, `Begin with ${name}`);
      begin.onclick = () => this.#choose(name, text);
      const said = element("p", { className: "fine" }, words);
      const actions = layer.kind === "bitmap" ? [this.#own(), begin] : [begin];
      scenes.append(element("article", { className: "scene" }, canvas, element("h3", {}, name), said, ...actions));
      return { canvas, text };
    });
    for (const { canvas, text } of cards) await drawScene(this.#engine, text, canvas, LONG_SIDE_PX);
  }

  /** The button that lets a person choose a picture. */
  #own() {
    const choose = element("button", {}, "Choose a picture…");
    choose.onclick = () => {
      this.#dialog.close();
      this.onPicture();
    };
    return choose;
  }

  /**
   * @param {string} name
   * @param {string} text
   */
  #choose(name, text) {
    this.#dialog.close();
    attempt(() => this.onScene(name, text));
  }
}
