// The gallery: bundled scenes to start from, whole or layer by layer.
// @ts-check

import { sceneNames, sceneText } from "./bundled.js";
import { choiceButton } from "./dialogs.js";
import { byId, element, shortName } from "./dom.js";
import { attempt } from "./notices.js";
import { drawScene } from "./scene_picture.js";

/** @import { Engine } from "../engine/engine.js" */
/** @import { Layer } from "../engine/types" */

/** Longer side of a scene's picture, pixels. */
const LONG_SIDE_PX = 300;

export class Gallery {
  #engine;
  #isFilled = false;
  /**
   * A whole scene is chosen: `onScene(name, text)`.
   * @type {(name: string, text: string) => unknown}
   */
  onScene = () => {};
  /**
   * A layer is taken over: `onLayer(text)`.
   * @type {(text: string) => unknown}
   */
  onLayer = () => {};

  /** @param {Engine} engine */
  constructor(engine) {
    this.#engine = engine;
  }

  async open() {
    byId("gallery").showModal();
    if (this.#isFilled) return;
    this.#isFilled = true;
    const cards = sceneNames().map((name) => ({ name, ...emptyCard(name) }));
    byId("gallery-scenes").append(...cards.map(({ card }) => card));
    for (const { name, card, canvas } of cards) await this.#fill(card, canvas, name);
  }

  /**
   * @param {HTMLElement} card
   * @param {HTMLCanvasElement} canvas
   * @param {string} name
   */
  async #fill(card, canvas, name) {
    const text = await sceneText(name);
    const found = await drawScene(this.#engine, text, canvas, LONG_SIDE_PX);
    const open = choiceButton(`Open ${titleOf(name)}`, () => this.onScene(name, text));
    canvas.onclick = () => open.click();
    const list = element("ul", {}, ...this.#layers(text, found));
    const layers = element("details", {}, element("summary", {}, "Layers"), list);
    const words = element("p", { className: "fine" }, introduction(text));
    card.append(words, open, layers);
  }

  /**
   * @param {string} text
   * @param {Layer[]} layers
   */
  #layers(text, layers) {
    return layers.map(({ name: title, from }) => {
      const take = element("button", { "aria-label": `Take over ${title}` }, "Take over");
      take.onclick = () => {
        attempt(() => this.onLayer(layerText(text, from)));
        take.textContent = "Taken ✓";
      };
      return element("li", {}, shortName(title), take);
    });
  }
}

/** The title of a bundled scene; its words are shown with capitals. @param {string} name */
const titleOf = (name) => name.replaceAll("_", " ");

/**
 * A card whose picture has its place before it is drawn.
 * @param {string} name
 */
function emptyCard(name) {
  const canvas = element("canvas", { "aria-hidden": "true" });
  const card = element("article", { className: "scene" }, canvas, element("h3", {}, titleOf(name)));
  return { card, canvas };
}

/**
 * What a finger meets: the comment at a scene's head.
 * @param {string} text
 */
function introduction(text) {
  return /^# (.*)/.exec(text)?.[1] ?? "";
}

/**
 * The text of a layer in these lines, with the comments above it.
 * @param {string} text
 * @param {[number, number]} lines
 */
function layerText(text, [first, last]) {
  const lines = text.split("\n");
  let start = first - 1;
  while (start > 0 && lines[start - 1].startsWith("#")) start -= 1;
  return lines.slice(start, last).join("\n");
}
