// The dialog of New: small scenes to begin with, one of them with a picture of one's own, and an empty one.
// @ts-check

import { choiceButton } from "./dialogs.js";
import { byId, element } from "./dom.js";
import { attempt } from "./notices.js";
import { drawScene } from "./scene_picture.js";
import { additions } from "./toml_text.js";

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
    byId("empty-scene").onclick = () => attempt(() => this.onScene("untitled", EMPTY));
  }

  async #open() {
    this.#dialog.showModal();
    this.#dialog.scrollTop = 0;
    const scenes = byId("new-scenes");
    if (scenes.childElementCount > 0) return;
    const cards = additions().map(({ name, words, isPicture, scene: text }) => {
      const canvas = element("canvas", { "aria-hidden": "true" });
      const begin = choiceButton(`Begin with ${name}`, () => this.onScene(name, text));
      const own = choiceButton("Choose a picture…", () => this.onPicture());
      own.className = "";
      const said = element("p", { className: "fine" }, words);
      const actions = isPicture ? [own, begin] : [begin];
      scenes.append(element("article", { className: "scene" }, canvas, element("h3", {}, name), said, ...actions));
      return { canvas, text };
    });
    for (const { canvas, text } of cards) await drawScene(this.#engine, text, canvas, LONG_SIDE_PX);
  }
}
