// The dialog of New: four small scenes to begin with, and an empty one.
// @ts-check

import { carriedFiles } from "./bundled.js";
import { imageOf } from "./colors.js";
import { byId, contextOf, element } from "./dom.js";
import { mapSizePx } from "./map.js";
import { attempt } from "./notices.js";

/** @import { Engine } from "../engine/engine.js" */
/** @typedef {{ name: string, text: string }} Beginning */

/** Longer side of a scene's picture, pixels. */
const LONG_SIDE_PX = 240;

/** @type {Beginning[]} */
export const BEGINNINGS = [
  {
    name: "stripes",
    text: `# Broad stripes across the screen: a finger that slides over them meets one ridge after another.
version = 2

[[layer]]
name = "stripes"
kind = "grating"
wave = "sine"
wavelength_mm = 10
low_fraction = 0
high_fraction = 0.8
`,
  },
  {
    name: "button",
    text: `# One button: a rim that holds the finger back, and a rougher face inside of it.
version = 2

[[layer]]
name = "button"
kind = "button"
region = { x_mm = 35, y_mm = 20, width_mm = 50, height_mm = 40 }
rim_width_mm = 5
rim_fraction = 0.9
face_fraction = 0.35
`,
  },
  {
    name: "picture",
    text: `# The grain of a photo of wood, rough where it is bright: drop a picture of yours and name it here.
version = 2

[[layer]]
name = "wood"
kind = "bitmap"
picture = "textures/wood.jpg"
x_mm = 15
y_mm = 10
width_mm = 90
`,
  },
  {
    name: "noise",
    text: `# An uneven ground like coarse sand: no two places of it are alike.
version = 2

[[layer]]
name = "sand"
kind = "noise"
wavelength_min_mm = 3
wavelength_max_mm = 8
low_fraction = 0
high_fraction = 0.9
`,
  },
];

const EMPTY = `version = 2

# Type [[layer]], then Ctrl+Space for what a layer can have; or take layers from the Gallery.
`;

export class NewScene {
  #engine;
  #dialog = byId("new-scene");
  /**
   * A scene is chosen: `onScene(name, text)`.
   * @type {(name: string, text: string) => unknown}
   */
  onScene = () => {};

  /** @param {Engine} engine */
  constructor(engine) {
    this.#engine = engine;
    byId("new").onclick = () => attempt(() => this.#open());
  }

  async #open() {
    this.#dialog.showModal();
    if (this.#dialog.childElementCount > 0) return;
    const close = element("button", { onclick: () => this.#dialog.close() }, "Close");
    const scenes = element("div", { className: "scenes" });
    const empty = element("button", { onclick: () => this.#choose("untitled", EMPTY) }, "Empty scene");
    this.#dialog.append(
      element("div", { className: "head" }, element("h2", {}, "New scene"), empty, close),
      element("p", { className: "soft" }, "Begin with one of these, and change it."),
      scenes,
    );
    const cards = BEGINNINGS.map(({ name, text }) => {
      const canvas = element("canvas", { "aria-hidden": "true" });
      const begin = element("button", { className: "primary" }, `Begin with ${name}`);
      begin.onclick = () => this.#choose(name, text);
      const words = element("p", { className: "fine" }, text.slice(2, text.indexOf("\n")));
      scenes.append(element("article", { className: "scene" }, canvas, element("h3", {}, name), words, begin));
      return { canvas, text };
    });
    for (const { canvas, text } of cards) await this.#draw(canvas, text);
  }

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {string} text
   */
  async #draw(canvas, text) {
    const files = { ...(await carriedFiles()), "new.toml": text };
    const check = await this.#engine.check(files, "new.toml", {});
    if (!("screen" in check)) throw new Error(check.problems.map(({ message }) => message).join("\n"));
    const size = { ...mapSizePx(check.screen, LONG_SIDE_PX), speedMmPerS: 100 };
    const map = await this.#engine.map(files, "new.toml", {}, size);
    Object.assign(canvas, { width: map.widthPx, height: map.heightPx });
    contextOf(canvas).putImageData(imageOf(map), 0, 0);
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
