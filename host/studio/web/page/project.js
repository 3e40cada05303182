// What a person works on: the scene's text (which the editor holds) and the files that it names.
// @ts-check

import { carriedFiles } from "./bundled.js";
import { NAME_MAX } from "./dom.js";

/** @import { Engine } from "../engine/engine.js" */
/** @import { Files, Profiles, Screen } from "../engine/types" */
/**
 * Text of a TOML file, bytes of a picture.
 * @typedef {string | Uint8Array<ArrayBuffer>} Content
 * @typedef {[name: string, content: Content]} NamedFile
 */
/**
 * A scene as files and links carry it.
 * @typedef {{ name: string, text: string, files: NamedFile[], profiles?: Profiles }} SavedScene
 */
/**
 * A piece of work that the browser keeps.
 * @typedef {{ id: string, isEdited: boolean, changedMs: number }} OpenWork
 */
/**
 * A scene to open, kept by the browser or not.
 * @typedef {SavedScene & Partial<OpenWork>} SceneToOpen
 */

/** Longest text that the studio takes, bytes. */
export const TEXT_MAX_BYTES = 500_000;
/** The screen of a scene that does not say one. */
const DEFAULT_SCREEN = { widthMm: 120, heightMm: 80 };
/** What file systems refuse in a name, and names that Windows keeps for itself. */
const NOT_IN_NAMES = /[<>:"/\\|?*\p{Cc}]/gu;
const RESERVED = /^(con|prn|aux|nul|com\d|lpt\d)(?=\.|$)/i;

export class Project {
  #engine;
  #name = "scene";
  /**
   * Files of one's own, by their names as `sameName` writes them: texts of TOML files, bytes of pictures.
   * @type {Map<string, Content>}
   */
  files = new Map();
  /**
   * Finger and screen to play with in place of the scene's own, and the simulated touch source; name or TOML text.
   * @type {Profiles}
   */
  profiles = {};
  /**
   * The screen of the scene that was checked last.
   * @type {Screen}
   */
  screen = DEFAULT_SCREEN;
  /** How many scenes were opened: what was begun for one may be ready when another is open. */
  opened = 0;

  /** @param {Engine} engine */
  constructor(engine) {
    this.#engine = engine;
  }

  /** Name of the scene. */
  get name() {
    return this.#name;
  }

  set name(name) {
    const allowed = [...name.replaceAll(NOT_IN_NAMES, "-")].slice(0, NAME_MAX).join("").replace(/[. ]+$/, "");
    this.#name = allowed.replace(RESERVED, "$1-") || "scene";
  }

  /** Name of the scene's file. */
  get entry() {
    return `${this.#name}.toml`;
  }

  /** The screen that a scene which says none is played with. */
  get screenOfNew() {
    return this.profiles.screen ? this.screen : DEFAULT_SCREEN;
  }

  /**
   * Replaces all files of one's own by these, given as `[name, content]`.
   * @param {NamedFile[]} files
   */
  async replaceFiles(files) {
    const carried = await carriedFiles();
    this.opened += 1;
    this.files.clear();
    for (const [name, content] of files) if (!isSame(content, carried[name])) this.add(name, content);
  }

  /**
   * Adds a file; texts get the line ends that the editor gives them.
   * @param {string} name
   * @param {Content} content
   */
  add(name, content) {
    const text = isToml(name) && typeof content !== "string" ? new TextDecoder().decode(content) : content;
    this.files.set(sameName(name), isToml(name) && typeof text === "string" ? text.replaceAll(/\r\n?/g, "\n") : text);
  }

  /**
   * The name, or one like it, under which a file can be added without taking the place of another.
   * @param {string} name
   * @param {Content} content
   */
  freeName(name, content) {
    const [base, ending] = [name.replace(/\.\w+$/, ""), /\.\w+$/.exec(name)?.[0] ?? ""];
    let free = name;
    for (let number = 2; this.files.has(free) && !isSame(this.files.get(free), content); number += 1)
      free = `${base}-${number}${ending}`;
    return free;
  }

  /**
   * All files that the engine may need for this text of the scene.
   * @param {string} text
   * @returns {Promise<Files>}
   */
  async filesFor(text) {
    return { ...(await carriedFiles()), ...Object.fromEntries(this.files), [this.entry]: text };
  }

  /**
   * Files of one's own for a link, as `[name, content]`: those that this text uses.
   * @param {string} text
   */
  async filesForLink(text) {
    const { names, isWhole } = await this.#engine.usedFiles(await this.filesFor(text), this.entry);
    // A mistake may hide the name of a file.
    return [...this.files].filter(([name]) => !isWhole || names.map(sameName).includes(name));
  }

  /**
   * Files for a zip, as `[name, content]`: all of one's own, and those of the page that this text uses.
   * @param {string} text
   */
  async filesForZip(text) {
    const { names } = await this.#engine.usedFiles(await this.filesFor(text), this.entry);
    /** @type {NamedFile[]} */
    const carried = Object.entries(await carriedFiles()).filter(([name]) => names.includes(name));
    return [...new Map([...carried, ...this.files])].filter(([name]) => name !== this.entry);
  }
}

/**
 * Says that a file or a text is not taken.
 * @param {string} what
 * @param {number} bytes
 * @param {number} mostBytes
 */
export function tooLarge(what, bytes, mostBytes) {
  // A little more than the most is more in words, too.
  const [size, most] = [bytes, mostBytes].map((each) => (Math.ceil(each / 1e5) / 10).toFixed(1));
  return `the ${what} has ${size} MB, more than the ${most} MB that the studio opens`;
}

/**
 * Throws a sentence where a scene has a text that is longer than the studio takes.
 * @param {SavedScene} scene
 */
export function assertTextsFit({ name, text, files }) {
  for (const [file, content] of [/** @type {NamedFile} */ ([`${name}.toml`, text]), ...files]) {
    const bytes = isToml(file) ? bytesOf(content) : 0;
    if (bytes > TEXT_MAX_BYTES) throw new Error(`${file}: ${tooLarge("text", bytes, TEXT_MAX_BYTES)}`);
  }
}

/** @param {Content} content */
export function bytesOf(content) {
  return typeof content === "string" ? new TextEncoder().encode(content).length : content.length;
}

/**
 * A name of a file in the characters that the page compares: scenes and file systems may have others for the same text.
 * @param {string} name
 */
export function sameName(name) {
  return name.normalize("NFC");
}

/** @param {string} name */
export function isToml(name) {
  return /\.toml$/i.test(name);
}

/** @param {string} name */
export function isPicture(name) {
  return /\.(png|jpe?g)$/i.test(name);
}

/**
 * @param {Content | undefined} content
 * @param {Content | undefined} other
 */
function isSame(content, other) {
  if (typeof content !== "object" || typeof other !== "object") return false;
  return content.length === other.length && content.every((byte, at) => byte === other[at]);
}
