// Files that a person drops or opens: scenes, pictures, profiles and saved projects.
// @ts-check

import { projectOf, UNPACKED_MAX_BYTES } from "./archive.js";
import { byId, sentenceOf, shortName } from "./dom.js";
import { forgetNotice, notify } from "./notices.js";
import { TEXT_MAX_BYTES, isPicture, sameName, tooLarge } from "./project.js";

/** @import { Files } from "../engine/types" */
/** @import { Kind } from "./profiles.js" */
/** @import { NamedFile, SavedScene } from "./project.js" */
/** @typedef {(files?: Files, entry?: string) => Promise<{ names: string[] }>} UsedFiles */
/** @typedef {{ name: string, text: string }} OwnProfile */

/**
 * Largest text, picture and zip, bytes.
 * @type {Record<string, number>}
 */
const MAX_BYTES = { toml: TEXT_MAX_BYTES, png: 8_000_000, jpg: 8_000_000, jpeg: 8_000_000, zip: UNPACKED_MAX_BYTES };
const JPEG = [0xff, 0xd8, 0xff];
/**
 * The first bytes of pictures, by the ending of their names.
 * @type {Record<string, number[]>}
 */
const SIGNATURES = { png: [0x89, 0x50, 0x4e, 0x47], jpg: JPEG, jpeg: JPEG };
/** The last chunk of a PNG, and in how many bytes at the end it is looked for. */
const PNG_END = "IEND";
const PNG_END_BYTES = 64;

/**
 * What stands in files that a person gives: texts that are not sorted yet, and the other files.
 * @typedef {object} Found
 * @property {[string, string][]} texts
 * @property {NamedFile[]} files
 * @property {SavedScene} [scene]
 * @property {[Kind, OwnProfile][]} profiles
 */

export class Incoming {
  /** @type {UsedFiles} */
  #usedFiles;
  /**
   * What could be taken of the files.
   * @type {(found: Found) => unknown}
   */
  onFiles = () => {};

  /**
   * `usedFiles(files, entry)` gives the names of the files that a scene uses; without arguments, those of the scene
   * that the page has.
   * @param {UsedFiles} usedFiles
   */
  constructor(usedFiles) {
    this.#usedFiles = usedFiles;
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
        Object.assign(found, await read(file, found));
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
   * Tells the scene among the texts from the files that it uses, and from profiles to play with.
   * @param {Found} found
   * @param {string[]} refused
   */
  async #sort(found, refused) {
    const texts = Object.fromEntries(found.texts);
    // A scene of the drop, or the scene that the page has, may use the others.
    const used = new Set((await this.#usedFiles()).names.map(sameName));
    for (const entry of Object.keys(texts)) {
      const { names } = await this.#usedFiles(texts, entry);
      for (const name of names) if (name !== entry) used.add(sameName(name));
    }
    for (const [fileName, text] of found.texts) {
      const name = fileName.replace(/\.toml$/i, "");
      const kind = kindOf(text);
      if (used.has(fileName)) found.files.push([fileName, text]);
      else if (kind !== "scene") found.profiles.push([kind, { name, text }]);
      else if (!found.scene) found.scene = { name, text, files: [] };
      else refused.push(`${fileName}: a scene, too, but ${found.scene.name} is opened; open one at a time`);
    }
    if (found.scene) found.scene.files = [...found.scene.files, ...found.files];
  }
}

/**
 * What stands in a file, if it can be taken.
 * @param {File} file
 * @param {Found} found
 * @returns {Promise<Partial<Found>>}
 */
export async function read(file, found) {
  const ending = /\.(toml|png|jpe?g|zip)$/i.exec(file.name)?.[1].toLowerCase();
  if (!ending) throw new Error("expected a scene or profile (.toml), a picture (.png, .jpg) or a saved project (.zip)");
  if (file.size > MAX_BYTES[ending]) throw new Error(tooLarge("file", file.size, MAX_BYTES[ending]));
  const bytes = new Uint8Array(await file.arrayBuffer());
  if (ending === "zip") return { scene: projectOf(bytes) };
  if (isPicture(file.name)) {
    if (SIGNATURES[ending].some((byte, at) => bytes[at] !== byte))
      throw new Error(`this is no ${ending === "png" ? "PNG" : "JPEG"} picture, whatever its name says`);
    if (ending === "png" && !String.fromCharCode(...bytes.slice(-PNG_END_BYTES)).includes(PNG_END))
      throw new Error("this PNG picture is cut off: its end is missing; save or copy it anew");
    return { files: [...found.files, [sameName(file.name), bytes]] };
  }
  const text = textOf(bytes);
  if (text.trim() === "") throw new Error("this file is empty: it has no scene");
  return { texts: [...found.texts, [sameName(file.name), text]] };
}

/** @param {Uint8Array} bytes */
function textOf(bytes) {
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    throw new Error("this is no text in UTF-8");
  }
}

/**
 * Kind of a TOML text. One of no known kind is read as a scene, to show its mistakes.
 * @param {string} text
 * @returns {Kind | "scene"}
 */
function kindOf(text) {
  if (/^\s*(\[|version\s*=)/m.test(text)) return "scene";
  if (/^\s*friction_coefficient\s*=/m.test(text)) return "finger";
  if (/^\s*reports_per_s\s*=/m.test(text)) return "touch";
  return /^\s*width_mm\s*=/m.test(text) ? "screen" : "scene";
}
