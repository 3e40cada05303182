// <frixel-scene>: map, finger and scope of a scene, for any document. docs/studio.md says how to use it.
//
// All elements of a document share one simulated board: the scene under the pointer plays on it.

import { createEngine } from "../engine/engine.js";
import { carriedFiles } from "../page/bundled.js";
import { element, forgetColours } from "../page/dom.js";
import { Finger } from "../page/finger.js";
import { FrictionMap, mapSizePx } from "../page/map.js";
import { Samples } from "../page/samples.js";
import { Scope } from "../page/scope.js";

/** Longer side of the map's picture, pixels. */
const MAP_LONG_SIDE_PX = 640;
/** How far from the window an element draws its map already. */
const NEARBY = "400px";
const LABEL = "The screen. Slide with mouse, finger or pen, or hold an arrow key.";
/** Only what differs from the studio's page. */
const STYLE = `
:host { display: block; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 12px; overflow: hidden; }
.map { border-top: 0; }
.line { padding: 4px 12px; }
.bad { color: var(--danger); white-space: pre-line; }
`;

let shared;
/** The element whose scene plays. */
let playing;

/** The engine of all elements, started for the first one. */
function engineOfAll() {
  shared ??= createEngine().then((engine) => {
    engine.onFrames = (frame) => playing?.feel(frame);
    engine.onFailure = ({ error }) => playing?.say(error);
    return engine;
  });
  return shared;
}

class FrixelScene extends HTMLElement {
  static observedAttributes = ["scene", "src", "finger", "screen"];

  #engine;
  #map;
  #finger;
  #samples = new Samples();
  #scope;
  #line = element("p", { className: "line fine", role: "status" });
  #hint = element("p", { className: "hint" }, "press and slide");
  /** What the engine needs for the scene: files, name of the scene's file, profiles. */
  #scene;
  #check;

  connectedCallback() {
    if (this.shadowRoot) return;
    this.attachShadow({ mode: "open" });
    const nearby = new IntersectionObserver(
      ([{ isIntersecting }]) => {
        if (!isIntersecting) return;
        nearby.disconnect();
        this.#start().catch((error) => this.say(error.message));
      },
      { rootMargin: NEARBY },
    );
    nearby.observe(this);
  }

  disconnectedCallback() {
    if (playing !== this) return;
    playing = undefined;
    this.#engine.stop();
  }

  attributeChangedCallback() {
    if (this.#map) this.#load().catch((error) => this.say(error.message));
  }

  async #start() {
    // Until the document is read, a scene inside of the element may be incomplete.
    if (document.readyState === "loading") await new Promise((done) => addEventListener("DOMContentLoaded", done));
    const styles = await Promise.all(["base", "parts"].map((name) => studio.text(`styles/${name}.css`)));
    const picture = element("canvas", { id: "map-picture" });
    const touched = element("canvas", { id: "map-finger", tabIndex: 0, role: "application", "aria-label": LABEL });
    const map = element("div", { className: "map" }, picture, touched, this.#hint);
    const scope = element("div", { className: "scope" });
    const card = element("div", { className: "card" }, map, this.#line, scope);
    this.shadowRoot.replaceChildren(element("style", {}, ...styles, STYLE), card);
    this.#engine = await engineOfAll();
    this.#map = new FrictionMap(map, picture);
    this.#finger = new Finger(this.#engine, this.#map, touched);
    this.#scope = new Scope(this.#samples, scope);
    this.#finger.onDown = () => (this.#hint.hidden = true);
    for (const type of ["pointerenter", "pointerdown", "focus"])
      touched.addEventListener(type, () => this.#play().catch((error) => this.say(error.message)));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      forgetColours();
      this.#map.draw();
      this.#scope.restyle();
    });
    await this.#load();
  }

  /** Reads the scene, checks it and draws its map. */
  async #load() {
    const profiles = {};
    for (const name of ["finger", "screen"]) if (this.hasAttribute(name)) profiles[name] = this.getAttribute(name);
    const { files, entry } = await this.#read();
    const check = await this.#engine.check(files, entry, profiles);
    if (!check.ok && !check.isDraft) {
      const places = check.problems.map(({ file, line, message }) => `${file ?? entry}:${line ?? 1}: ${message}`);
      throw new Error(places.join("\n"));
    }
    this.#scene = [files, entry, profiles];
    this.#check = check;
    const sizePx = mapSizePx(check.screen, MAP_LONG_SIDE_PX);
    this.#map.show(await this.#engine.map(...this.#scene, { ...sizePx, speedMmPerS: 100 }), check);
    this.#line.className = "line fine";
    this.#line.textContent = check.isDraft ? `${entry}: draft, clamped; a board refuses it` : entry;
    this.dispatchEvent(new CustomEvent("ready", { detail: check }));
    if (playing === this) {
      playing = undefined;
      await this.#play();
    }
  }

  /** The files of the scene that the attributes name, or that stands in the element. */
  async #read() {
    const carried = await carriedFiles();
    const [name, src, text] = [this.getAttribute("scene"), this.getAttribute("src"), this.textContent.trim()];
    if (name !== null) {
      if (`${name}.toml` in carried) return { files: carried, entry: `${name}.toml` };
      throw new Error(`scene="${name}": no bundled scene has this name`);
    }
    if (src !== null) return this.#fetched(new URL(src, document.baseURI), carried);
    if (text !== "") return { files: { ...carried, "scene.toml": text }, entry: "scene.toml" };
    throw new Error('<frixel-scene> has no scene: give it scene="brick", src="my.toml", or a scene\'s text inside');
  }

  /** The scene at an address, and the files that it names, from there. */
  async #fetched(url, carried) {
    const entry = decodeURIComponent(url.pathname.split("/").pop()) || "scene.toml";
    const content = async (address) => {
      const answer = await fetch(address);
      if (!answer.ok) throw new Error(`${address}: ${answer.status} ${answer.statusText}`);
      return new Uint8Array(await answer.arrayBuffer());
    };
    if (url.protocol === "file:") {
      throw new Error(
        `src="${this.getAttribute("src")}": a document that was opened from a file can read no other file; ` +
          "put the scene's text inside of the element",
      );
    }
    const files = { ...carried, [entry]: await content(url) };
    const sought = new Set();
    for (;;) {
      const { names } = await this.#engine.usedFiles(files, entry);
      const missing = names.filter((name) => !sought.has(name) && !(name in files));
      if (missing.length === 0) return { files, entry };
      for (const name of missing) {
        sought.add(name);
        // Of a file that is not there, the compiler says so.
        await content(new URL(name, url)).then((bytes) => (files[name] = bytes)).catch(() => {});
      }
    }
  }

  async #play() {
    if (playing === this || !this.#scene) return;
    playing = this;
    await this.#engine.play(...this.#scene);
  }

  /** Takes what was felt. Documents get it as the event `feel`. */
  feel(frame) {
    this.#samples.add(frame);
    this.#finger.feel(frame, this.#check);
    this.dispatchEvent(new CustomEvent("feel", { detail: frame }));
  }

  /** Shows a sentence. */
  say(sentence) {
    this.#line.className = "line bad";
    this.#line.textContent = sentence;
    if (!this.#line.isConnected) this.shadowRoot.append(this.#line);
  }
}

customElements.define("frixel-scene", FrixelScene);
