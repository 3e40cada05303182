// What a person works on: the scene's text (which the editor holds) and the files that it names.

import { picture } from "./bundled.js";

export const ENTRY = "scene.toml";

export class Project {
  /** Files of one's own, as the scene writes their names. */
  files = new Map();
  /** Name of the scene, for files that are saved. */
  name = "scene";
  /** Finger and screen to play with in place of the scene's own; name or TOML text. */
  profiles = {};

  /** Names that the text gives to other files. */
  static namesIn(text) {
    return [...new Set([...text.matchAll(/^\s*picture\s*=\s*"([^"]+)"/gm)].map((match) => match[1]))];
  }

  /** All files that the engine needs for this text. */
  async filesFor(text) {
    const files = { [ENTRY]: text };
    for (const [name, content] of this.files) if (name !== ENTRY) files[name] = content;
    for (const name of Project.namesIn(text)) {
      const bundled = name in files ? undefined : await picture(name);
      if (bundled) files[name] = bundled;
    }
    return files;
  }

  /** Files of one's own that this text names. */
  ownFilesFor(text) {
    return Project.namesIn(text).filter((name) => this.files.has(name));
  }
}
