// Files that a person drops or opens: scenes, pictures, profiles and saved projects.
// @ts-check

import { projectOf, UNPACKED_MAX_BYTES } from "./archive.js";
import { byId, sentenceOf, shortName } from "./dom.js";
import { forgetNotice, notify } from "./notices.js";
import { TEXT_MAX_BYTES, isPicture, isToml, sameName, tooLarge } from "./project.js";

/** @import { Engine } from "../engine/engine.js" */
/** @import { Kind } from "./profiles.js" */
/** @import { NamedFile, SavedScene } from "./project.js" */
/** @typedef {{ name: string, text: string }} OwnProfile */


/**
 * What stands in files that a person gives: texts that are not sorted yet, and the other files.
 * @typedef {object} Found
 * @property {[string, string][]} texts
 * @property {NamedFile[]} files
 * @property {SavedScene} [scene]
 * @property {[Kind, OwnProfile][]} profiles
 */

export class Incoming {
  #engine;
  #usedByScene;
  /**
   * What could be taken of the files.
   * @type {(found: Found) => unknown}
   */
  onFiles = () => {};

  /**
   * `usedByScene()` gives the names of the files that the scene of the page uses.
   * @param {Engine} engine
   * @param {() => Promise<string[]>} usedByScene
   */
  constructor(engine, usedByScene) {
    this.#engine = engine;
    this.#usedByScene = usedByScene;
    const input = byId("files");
    input.onchange = () => {
      this.take([...(input.files ?? [])]);
      input.value = "";
    };
    const drop = byId("drop");
    const hasFiles = (/** @type {DragEvent} */ event) => event.dataTransfer?.types.includes("Files");
    let depth = 0;
    const show = (/** @type {number} */ change) => {
      depth = Math.max(0, depth + change);
      drop.hidden = depth === 0;
    };
    addEventListener("dragenter", (event) => hasFiles(event) && show(1));
    addEventListener("dragleave", (event) => hasFiles(event) && show(-1));
    addEventListener("dragover", (event) => event.preventDefault());
    addEventListener("drop", (event) => {
      event.preventDefault();
      show(-depth);
      this.take([...(event.dataTransfer?.files ?? [])]);
    });
  }

  /**
   * Takes what can be taken of these files, and says what cannot, and why.
   * @param {File[]} list
   */
  async take(list) {
    /** @type {Found} */
    const found = { files: [], texts: [], profiles: [] };
    /** @type {string[]} */
    const refused = [];
    forgetNotice();
    for (const file of list) {
      try {
        await this.#read(file, found);
      } catch (error) {
        refused.push(`${file.name}: ${sentenceOf(error)}`);
      }
    }
    try {
      await this.#sort(found, refused);
      if (found.scene || found.profiles.length > 0 || found.files.length > 0) await this.onFiles(found);
    } catch (error) {
      refused.push(sentenceOf(error));
    }
    if (refused.length > 0) notify(refused.join("\n"), undefined, { beside: byId("open-files") });
    else if (!found.scene) {
      const profiles = found.profiles.map(([, { name }]) => name);
      const added = [...found.files.map(([name]) => name), ...profiles].map(shortName);
      notify(`Added: ${added.join(", ")}.`, undefined, { isGood: true, beside: byId("open-files") });
    }
  }

  /**
   * @param {File} file
   * @param {Found} found Takes what stands in the file.
   */
  async #read(file, found) {
    const bytes = await contentOf(file);
    const name = sameName(file.name);
    if (isPicture(name)) {
      await this.#engine.picture(bytes);
      found.files.push([name, bytes]);
    } else if (isToml(name)) found.texts.push([name, textOf(bytes)]);
    else found.scene = projectOf(bytes);
  }

  /**
   * Tells the scene among the texts from the files that it uses, and from profiles to play with.
   * @param {Found} found
   * @param {string[]} refused
   */
  async #sort(found, refused) {
    const texts = Object.fromEntries(found.texts);
    // A scene of the drop, or the scene that the page has, may use the others.
    const used = new Set((await this.#usedByScene()).map(sameName));
    /** @type {Record<string, Kind | "scene">} */
    const kinds = {};
    for (const entry of Object.keys(texts)) {
      const { names, kind } = await this.#engine.usedFiles(texts, entry);
      for (const name of names) if (name !== entry) used.add(sameName(name));
      kinds[entry] = kind;
    }
    for (const [fileName, text] of found.texts) {
      const name = fileName.replace(/\.toml$/i, "");
      const kind = kinds[fileName];
      if (used.has(fileName)) found.files.push([fileName, text]);
      else if (kind !== "scene") found.profiles.push([kind, { name, text }]);
      else if (!found.scene) found.scene = { name, text, files: [] };
      else refused.push(`${fileName}: a scene, too, but ${found.scene.name} is opened; open one at a time`);
    }
    if (found.scene) found.scene.files = [...found.scene.files, ...found.files];
  }
}

/**
 * The content of a file that can be taken.
 * @param {File} file
 */
export async function contentOf(file) {
  const ending = /\.(toml|png|jpe?g|zip)$/i.exec(file.name)?.[1].toLowerCase();
  if (!ending) throw new Error("expected a scene or profile (.toml), a picture (.png, .jpg) or a saved project (.zip)");
  const maxBytes = ending === "toml" ? TEXT_MAX_BYTES : UNPACKED_MAX_BYTES;
  if (file.size > maxBytes) throw new Error(tooLarge("file", file.size, maxBytes));
  return new Uint8Array(await file.arrayBuffer());
}

/** @param {Uint8Array} bytes */
function textOf(bytes) {
  let text;
  try {
    text = new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    throw new Error("this is no text in UTF-8");
  }
  if (text.trim() === "") throw new Error("this file is empty: it has no scene");
  return text;
}
