// <frixel-scene>: map, finger and scope of a scene, for any document. docs/design/studio.md says how to use it.
//
// All elements of a document share one simulated board: the scene under the pointer plays on it.
// @ts-check

import { createEngine } from "../engine/engine.js";
import { carriedFiles } from "../page/bundled.js";
import { adoptStyle, element, forgetColours, sentenceOf } from "../page/dom.js";
import { Finger } from "../page/finger.js";
import { FrictionMap, mapSizePx } from "../page/map.js";
import { DRAFT, isPlayable } from "../page/player.js";
import { Samples } from "../page/samples.js";
import { Scope } from "../page/scope.js";

/** @import { Engine } from "../engine/engine.js" */
/** @import { Checked, Files, Frame, Profiles } from "../engine/types" */
/** @typedef {{ files: Files, entry: string }} Source */
/** @typedef {{ engine: Engine, map: FrictionMap, finger: Finger, scope: Scope }} Parts */
/** @typedef {{ map: HTMLElement, picture: HTMLCanvasElement, touched: HTMLCanvasElement, scope: HTMLElement }} Places */

/** Longer side of the map's picture, pixels. */
const MAP_LONG_SIDE_PX = 640;
/** How far from the window an element draws its map already. */
const NEARBY = "400px";
const LABEL = "The screen. Slide with mouse, finger or pen, or hold an arrow key.";
/** Only what differs from the studio's page. */
const STYLE = `
:host { display: block; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 12px; overflow: hidden; }
.map { border-top: 0; aspect-ratio: 3 / 2; }
.scope { height: 190px; }
.line { padding: 4px 12px; min-height: calc(1lh + 8px); }
.bad { color: var(--danger); white-space: pre-line; }
`;
const STYLES = [...(await Promise.all(["base", "parts"].map((name) => studio.text(`styles/${name}.css`)))), STYLE];

/** @type {Promise<Engine> | undefined} */
let shared;
/**
 * The element whose scene plays.
 * @type {FrixelScene | undefined}
 */
let playing;
/**
 * The elements in the document.
 * @type {Set<FrixelScene>}
 */
const present = new Set();

/** The engine of all elements, started for the first one. */
function engineOfAll() {
  shared ??= createEngine().then(
    (engine) => {
      engine.onFrames = (frame) => playing?.feel(frame);
      engine.onFailure = ({ error }) => playing?.say(error);
      return engine;
    },
    (error) => {
      shared = undefined;
      throw new Error(`the simulated board cannot start (${sentenceOf(error)}): ${studio.policy}`);
    },
  );
  return shared;
}

/** Ends the engine when the last element has left the document. */
function endUnused() {
  if (present.size > 0) return;
  shared?.then((engine) => engine.close(), () => {});
  shared = undefined;
}

/**
 * A file of the bundled scenes, by the name that they use.
 * @param {string} name
 */
const bundled = (name) => studio.bytes(`scenes/${name}`);

/**
 * The scene with every file that it names: `read(name)` gives those that are not here yet.
 * @param {Engine} engine
 * @param {Files} found
 * @param {string} entry
 * @param {(name: string) => Promise<Uint8Array<ArrayBuffer>>} read
 * @returns {Promise<Source>}
 */
async function whole(engine, found, entry, read) {
  const files = { ...found };
  /** @type {Set<string>} */
  const sought = new Set();
  for (;;) {
    const { names } = await engine.usedFiles(files, entry);
    const missing = names.filter((name) => !sought.has(name) && !(name in files));
    if (missing.length === 0) return { files, entry };
    for (const name of missing) {
      sought.add(name);
      // Of a file that is not there, the compiler says so.
      await read(name).then(
        (bytes) => (files[name] = bytes),
        () => {},
      );
    }
  }
}

class FrixelScene extends HTMLElement {
  static observedAttributes = ["scene", "src", "finger", "screen", "touch"];

  /**
   * The pictures and profiles that the scene inside of the element names.
   * @type {Files}
   */
  files = {};
  /**
   * What shows the scene, once it is near the window.
   * @type {Parts | undefined}
   */
  #parts;
  /** @type {ShadowRoot | undefined} */
  #root;
  /** Aborted when the element leaves the document. */
  #left = new AbortController();
  /** Number of loads that have begun: only the last one is shown. */
  #loads = 0;
  /** @type {Samples | undefined} */
  #samples;
  #line = element("p", { className: "line fine", role: "status" });
  #hint = element("p", { className: "hint" }, "press and slide");
  /**
   * What the engine needs for the scene: files, name of the scene's file, profiles.
   * @type {[Files, string, Profiles] | undefined}
   */
  #scene;
  /** @type {Checked | undefined} */
  #reach;

  connectedCallback() {
    present.add(this);
    this.#left = new AbortController();
    const { signal } = this.#left;
    const places = this.#makeRoom();
    const nearby = new IntersectionObserver(
      ([{ isIntersecting }]) => {
        if (!isIntersecting) return;
        nearby.disconnect();
        this.#start(places, signal).catch((error) => this.say(sentenceOf(error)));
      },
      { rootMargin: NEARBY },
    );
    nearby.observe(this);
    signal.addEventListener("abort", () => nearby.disconnect());
  }

  disconnectedCallback() {
    present.delete(this);
    this.#left.abort();
    // An engine that ends meanwhile has stopped.
    if (playing === this) this.#parts?.engine.stop().catch(() => {});
    if (playing === this) playing = undefined;
    this.#parts = this.#samples = this.#scene = this.#reach = undefined;
    this.#root?.replaceChildren();
    // An element that takes the place of this one, or this one in another place, keeps the engine.
    queueMicrotask(endUnused);
  }

  attributeChangedCallback() {
    if (this.#parts) this.#load(this.#parts).catch((error) => this.say(sentenceOf(error)));
  }

  /**
   * Takes the room of the whole scene at once: what stands below stays in its place when the scene comes.
   * @returns {Places}
   */
  #makeRoom() {
    this.#root ??= this.attachShadow({ mode: "open" });
    this.#root.adoptedStyleSheets = [];
    this.#hint.hidden = false;
    this.#line.textContent = "";
    const picture = element("canvas", { id: "map-picture" });
    const touched = element("canvas", { id: "map-finger", role: "application", "aria-label": LABEL });
    const map = element("div", { className: "map" }, picture, touched, this.#hint);
    const scope = element("div", { className: "scope" });
    const card = element("div", { className: "card" }, map, this.#line, scope);
    this.#root.append(card);
    adoptStyle(card, STYLES.join(""));
    return { map, picture, touched, scope };
  }

  /**
   * @param {Places} places
   * @param {AbortSignal} signal
   */
  async #start({ map, picture, touched, scope }, signal) {
    // Until the document is read, a scene inside of the element may be incomplete.
    if (document.readyState === "loading")
      await new Promise((done) => addEventListener("DOMContentLoaded", done, { once: true, signal }));
    const engine = await engineOfAll();
    if (signal.aborted) return;
    touched.tabIndex = 0;
    const shown = new FrictionMap(map, picture);
    const finger = new Finger(engine, shown, touched);
    this.#samples = new Samples();
    const parts = { engine, map: shown, finger, scope: new Scope(this.#samples, scope) };
    this.#parts = parts;
    signal.addEventListener("abort", () => {
      for (const part of [parts.map, parts.finger, parts.scope]) part.close();
    });
    finger.onDown = () => (this.#hint.hidden = true);
    for (const type of ["pointerenter", "pointerdown", "focus"])
      touched.addEventListener(type, () => this.#play(parts).catch((error) => this.say(sentenceOf(error))));
    const restyle = () => {
      forgetColours();
      parts.map.draw();
      parts.scope.restyle();
    };
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", restyle, { signal });
    await this.#load(parts);
  }

  /**
   * Reads the scene, compiles it and draws its map.
   * @param {Parts} parts
   */
  async #load(parts) {
    const { engine, map } = parts;
    const load = ++this.#loads;
    const profiles = {
      finger: this.getAttribute("finger") ?? undefined,
      screen: this.getAttribute("screen") ?? undefined,
      touch: this.getAttribute("touch") ?? undefined,
    };
    const { files, entry } = await this.#read(engine);
    const compiled = await engine.compile(files, entry, profiles);
    if (!isPlayable(compiled)) {
      const places = compiled.problems.map(({ file, line, message }) => `${file ?? entry}:${line ?? 1}: ${message}`);
      throw new Error(places.join("\n"));
    }
    const sizePx = mapSizePx(compiled.screen, MAP_LONG_SIDE_PX);
    const drawn = await engine.map(files, entry, profiles, { ...sizePx, speedMmPerS: 100 });
    // It has left the document, or another scene was given to it meanwhile.
    if (this.#parts !== parts || this.#loads !== load) return;
    this.#scene = [files, entry, profiles];
    this.#reach = compiled;
    map.show(drawn, compiled);
    this.#line.className = "line fine";
    this.#line.textContent = compiled.isDraft ? `${entry}: ${DRAFT}` : entry;
    this.dispatchEvent(new CustomEvent("ready", { detail: compiled }));
    if (playing === this) {
      playing = undefined;
      await this.#play(parts);
    }
  }

  /**
   * The files of the scene that the attributes name, or that stands in the element.
   * @param {Engine} engine
   * @returns {Promise<Source>}
   */
  async #read(engine) {
    const carried = await carriedFiles();
    const [name, src, text] = [this.getAttribute("scene"), this.getAttribute("src"), this.textContent.trim()];
    if (name !== null) {
      if (`${name}.toml` in carried) return whole(engine, carried, `${name}.toml`, bundled);
      throw new Error(`scene="${name}": no bundled scene has this name`);
    }
    if (src !== null) return this.#fetched(engine, new URL(src, document.baseURI), carried);
    if (text !== "") return whole(engine, { ...carried, ...this.files, "scene.toml": text }, "scene.toml", bundled);
    throw new Error('<frixel-scene> has no scene: give it scene="brick", src="my.toml", or a scene\'s text inside');
  }

  /**
   * The scene at an address, and the files that it names, from there.
   * @param {Engine} engine
   * @param {URL} url
   * @param {Files} carried
   * @returns {Promise<Source>}
   */
  async #fetched(engine, url, carried) {
    const entry = decodeURIComponent(url.pathname.split("/").at(-1) ?? "") || "scene.toml";
    const content = async (/** @type {URL} */ address) => {
      const answer = await fetch(address);
      if (!answer.ok) throw new Error(`${address}: ${answer.status} ${answer.statusText}`);
      return new Uint8Array(await answer.arrayBuffer());
    };
    const beside = (/** @type {string} */ file) => content(new URL(file, url)).catch(() => bundled(file));
    if (url.protocol === "file:") {
      throw new Error(
        `src="${this.getAttribute("src")}": a document that was opened from a file can read no other file; ` +
          "put the scene's text inside of the element",
      );
    }
    return whole(engine, { ...carried, [entry]: await content(url) }, entry, beside);
  }

  /** @param {Parts} parts */
  async #play({ engine }) {
    if (playing === this || !this.#scene) return;
    playing = this;
    await engine.play(...this.#scene);
  }

  /**
   * Takes what was felt. Documents get it as the event `feel`.
   * @param {Frame} frame
   */
  feel(frame) {
    this.#samples?.add(frame);
    if (this.#reach) this.#parts?.finger.feel(frame, this.#reach);
    this.dispatchEvent(new CustomEvent("feel", { detail: frame }));
  }

  /**
   * Shows a sentence.
   * @param {string} sentence
   */
  say(sentence) {
    this.#line.className = "line bad";
    this.#line.textContent = sentence;
  }
}

customElements.define("frixel-scene", FrixelScene);
