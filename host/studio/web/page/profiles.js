// The finger and the screen to play with in place of the scene's own.

import { byId, element } from "./dom.js";

export class Profiles {
  #project;
  #onChange;
  /** Profiles of one's own, by name: TOML text. */
  #own = { finger: new Map(), screen: new Map() };

  constructor(project, fingers, onChange) {
    this.#project = project;
    this.#onChange = onChange;
    this.#fill("finger", ["scene's", ...fingers]);
    this.#fill("screen", ["scene's", "example"]);
  }

  #fill(kind, names) {
    const select = byId(kind);
    select.append(...names.map((name, at) => element("option", { value: at === 0 ? "" : name }, name)));
    select.onchange = () => {
      this.#apply(kind, select.value);
      this.#onChange();
    };
  }

  #apply(kind, name) {
    if (name === "") delete this.#project.profiles[kind];
    else this.#project.profiles[kind] = this.#own[kind].get(name) ?? name;
  }

  addFinger({ name, text }) {
    this.#add("finger", name, text);
  }

  addScreen({ name, text }) {
    this.#add("screen", name, text);
  }

  #add(kind, name, text) {
    if (!this.#own[kind].has(name)) byId(kind).append(element("option", { value: name }, name));
    this.#own[kind].set(name, text);
    byId(kind).value = name;
    this.#apply(kind, name);
  }

  /** Chooses what a saved project had. */
  choose(profiles) {
    for (const kind of ["finger", "screen"]) {
      const chosen = typeof profiles[kind] === "string" ? profiles[kind] : "";
      if (chosen.includes("\n")) this.#add(kind, `saved ${kind}`, chosen);
      else {
        byId(kind).value = chosen;
        this.#apply(kind, byId(kind).value);
      }
    }
  }
}
