// The finger and the screen to play with in place of the scene's own.
// @ts-check

import { byId, element } from "./dom.js";

/** @import { Profiles as Chosen } from "../engine/types" */
/** @import { OwnProfile } from "./incoming.js" */
/** @import { Project } from "./project.js" */
/** @typedef {"finger" | "screen"} Kind */

export class Profiles {
  #project;
  /** Another finger or screen was chosen. */
  onChange = () => {};
  /**
   * Profiles of one's own, by name: TOML text.
   * @type {Record<Kind, Map<string, string>>}
   */
  #own = { finger: new Map(), screen: new Map() };

  /**
   * @param {Project} project
   * @param {string[]} fingers
   */
  constructor(project, fingers) {
    this.#project = project;
    this.#fill("finger", ["scene's", ...fingers]);
    this.#fill("screen", ["scene's", "example"]);
  }

  /**
   * @param {Kind} kind
   * @param {string[]} names
   */
  #fill(kind, names) {
    const select = byId(kind);
    select.append(...names.map((name, at) => element("option", { value: at === 0 ? "" : name }, name)));
    select.onchange = () => {
      this.#apply(kind, select.value);
      this.onChange();
    };
  }

  /**
   * @param {Kind} kind
   * @param {string} name
   */
  #apply(kind, name) {
    if (name === "") delete this.#project.profiles[kind];
    else this.#project.profiles[kind] = this.#own[kind].get(name) ?? name;
  }

  /** @param {OwnProfile} profile */
  addFinger({ name, text }) {
    this.#add("finger", name, text);
  }

  /** @param {OwnProfile} profile */
  addScreen({ name, text }) {
    this.#add("screen", name, text);
  }

  /**
   * @param {Kind} kind
   * @param {string} name
   * @param {string} text
   */
  #add(kind, name, text) {
    if (!this.#own[kind].has(name)) byId(kind).append(element("option", { value: name }, name));
    this.#own[kind].set(name, text);
    byId(kind).value = name;
    this.#apply(kind, name);
  }

  /**
   * Chooses what a saved project had.
   * @param {Chosen} profiles
   */
  choose(profiles) {
    for (const kind of /** @type {const} */ (["finger", "screen"])) {
      const wanted = profiles[kind];
      const chosen = typeof wanted === "string" ? wanted : "";
      if (chosen.includes("\n")) this.#add(kind, `saved ${kind}`, chosen);
      else {
        byId(kind).value = chosen;
        this.#apply(kind, byId(kind).value);
      }
    }
  }
}
