// The gallery: bundled scenes to start from, whole or layer by layer.

import { picture, sceneNames, sceneText } from "./bundled.js";
import { imageOf } from "./colors.js";
import { byId, element } from "./dom.js";
import { ENTRY, Project } from "./project.js";

const WIDTH_PX = 300;

export class Gallery {
  #engine;
  #dialog = byId("gallery");
  #isFilled = false;
  /** A whole scene is chosen: `onScene(name, text)`. */
  onScene = () => {};
  /** A layer is taken over: `onLayer(text, scene)`. */
  onLayer = () => {};

  constructor(engine) {
    this.#engine = engine;
  }

  async open() {
    this.#dialog.showModal();
    if (this.#isFilled) return;
    this.#isFilled = true;
    const close = element("button", { onclick: () => this.#dialog.close() }, "Close");
    const scenes = element("div", { className: "scenes" });
    this.#dialog.append(
      element("div", { className: "head" }, element("h2", {}, "Gallery"), close),
      element(
        "p",
        { className: "soft" },
        "Open a scene, or take single layers over into yours. Undo brings your scene back.",
      ),
      scenes,
    );
    const cards = sceneNames().map((name) => ({ name, card: element("article", { className: "scene" }) }));
    scenes.append(...cards.map(({ card }) => card));
    for (const { name, card } of cards) await this.#fill(card, name);
  }

  async #fill(card, name) {
    const text = await sceneText(name);
    const canvas = element("canvas", { ...sizeOf(text), "aria-hidden": "true" });
    const open = element("button", { className: "primary" }, `Open ${name}`);
    open.onclick = () => {
      this.#dialog.close();
      this.onScene(name, text);
    };
    const layers = element(
      "details",
      {},
      element("summary", {}, "Layers"),
      element("ul", {}, ...this.#layers(name, text)),
    );
    card.append(canvas, element("h3", {}, name), element("p", { className: "fine" }, introduction(text)), open, layers);
    const files = { [ENTRY]: text };
    for (const each of Project.namesIn(text)) files[each] = await picture(each);
    const map = await this.#engine.map(
      files,
      ENTRY,
      {},
      { widthPx: canvas.width, heightPx: canvas.height, speedMmPerS: 100 },
    );
    canvas.getContext("2d").putImageData(imageOf(map), 0, 0);
  }

  #layers(name, text) {
    return layerTexts(text).map((layer) => {
      const title =
        /^\s*name\s*=\s*"([^"]*)"/m.exec(layer)?.[1] ?? /^\s*kind\s*=\s*"([^"]*)"/m.exec(layer)?.[1] ?? "layer";
      const take = element("button", { "aria-label": `Take over ${title}` }, "Take over");
      take.onclick = () => {
        this.onLayer(layer, name);
        take.textContent = "Taken ✓";
      };
      return element("li", {}, title, take);
    });
  }
}

/** Size of a scene's picture: its screen is the example one where it has none of its own. */
function sizeOf(text) {
  const number = (name, usual) =>
    Number(new RegExp(`^${name}\\s*=\\s*([\\d.]+)`, "m").exec(screen(text))?.[1] ?? usual);
  return { width: WIDTH_PX, height: Math.round((WIDTH_PX * number("height_mm", 80)) / number("width_mm", 120)) };
}

function screen(text) {
  return /^\[screen\]\n((?:[^[].*\n|\n)*)/m.exec(text)?.[1] ?? "";
}

/** The comment at a scene's head, up to its first two sentences. */
function introduction(text) {
  const comment = /^(?:#.*\n)+/.exec(text)?.[0].replaceAll(/^# ?/gm, "").replaceAll("\n", " ") ?? "";
  return comment
    .split(/(?<=\.) /)
    .slice(0, 2)
    .join(" ");
}

/** The layers of a text, each with the comments above it. */
export function layerTexts(text) {
  const layers = [];
  let comments = [];
  let current;
  for (const line of text.split("\n")) {
    if (/^\s*\[/.test(line)) {
      current = /^\s*\[\[layer\]\]/.test(line) ? [...comments, line] : undefined;
      if (current) layers.push(current);
      comments = [];
    } else if (/^#/.test(line)) comments.push(line);
    else if (line.trim() === "") comments = [];
    else if (current) current.push(...comments.splice(0), line);
  }
  return layers.map((lines) => lines.join("\n"));
}
