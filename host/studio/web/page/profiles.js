// The finger and the screen to play with in place of the scene's own, and the simulated touch source.
// @ts-check

import { byId, element, shortName } from "./dom.js";

/** @import { Profiles as Chosen } from "../engine/types" */
/** @import { OwnProfile } from "./incoming.js" */
/** @import { Project } from "./project.js" */
/** @typedef {keyof Chosen} Kind */

const KINDS = /** @type {const} */ (["finger", "screen", "touch"]);

/** What is chosen in the options. */
const OPTIONS = /** @type {const} */ (["finger", "screen"]);

export class Profiles {
  #project;
  /** Another finger, screen or touch source was chosen. */
  onChange = () => {};
  /**
   * Profiles of one's own, by name: TOML text.
   * @type {Record<Kind, Map<string, string>>}
   */
  #own = { finger: new Map(), screen: new Map(), touch: new Map() };

  /**
   * @param {Project} project
   * @param {string[]} fingers
   */
  constructor(project, fingers) {
    this.#project = project;
    byId("finger").append(...fingers.map((name) => element("option", { value: name }, name)));
    for (const kind of KINDS)
      byId(kind).onchange = () => {
        this.#apply(kind, byId(kind).value);
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
    this.#mark();
  }

  /** What is not the scene's changes all that is felt: the button of the options says it. */
  #mark() {
    const chosen = OPTIONS.map((kind) => byId(kind).value).filter((name) => name !== "");
    const mark = byId("options-mark");
    mark.hidden = chosen.length === 0;
    mark.textContent = `: ${chosen.map((name) => shortName(name.replaceAll("_", " "))).join(", ")}`;
  }

  /**
   * Chooses a profile of one's own.
   * @param {Kind} kind
   * @param {OwnProfile} profile
   */
  add(kind, { name, text }) {
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
    for (const kind of KINDS) {
      const wanted = profiles[kind];
      const chosen = typeof wanted === "string" ? wanted : "";
      if (chosen.includes("\n")) this.add(kind, { name: `saved ${kind}`, text: chosen });
      else {
        byId(kind).value = chosen;
        this.#apply(kind, byId(kind).value);
      }
    }
  }
}
