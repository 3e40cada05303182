// Everything of a project as a zip, and back.
// @ts-check

import { strFromU8, strToU8, unzipSync, zipSync } from "../vendor/studio-vendor.js";

/** @import { UnzipFileInfo } from "../vendor/studio-vendor.js" */
/** @import { Profiles } from "../engine/types" */
/** @import { SavedScene } from "./project.js" */

/** Most bytes that a zip may unpack to, and most files in it. A small zip can hold gigabytes of zeros. */
export const UNPACKED_MAX_BYTES = 32_000_000;
const FILES_MAX = 100;
/** Name of the scene where the settings say none. */
const ENTRY = "scene.toml";
/** What was chosen in the page. */
const SETTINGS = "studio.json";

/** @param {SavedScene & { entry: string }} scene */
export function zipOf({ name, entry, text, files, profiles }) {
  const settings = JSON.stringify({ name, entry, profiles }, null, 2);
  /** @type {Record<string, Uint8Array>} */
  const entries = { [entry]: strToU8(text), [SETTINGS]: strToU8(settings) };
  for (const [file, content] of files) entries[file] = typeof content === "string" ? strToU8(content) : content;
  return zipSync(entries, { level: 6 });
}

/**
 * A project from a zip; throws a sentence where it holds none. A zip that `isOwn` was packed by this browser from what
 * it had open, and has no limits.
 * @param {Uint8Array} bytes
 * @returns {SavedScene}
 */
export function projectOf(bytes, { isOwn = false } = {}) {
  const entries = unpacked(bytes, isOwn);
  const { [SETTINGS]: chosen, ...all } = entries;
  /** @type {{ name?: unknown, entry?: string, profiles?: Profiles }} */
  let settings = {};
  try {
    settings = (chosen && JSON.parse(strFromU8(chosen))) ?? {};
  } catch {
    // Without settings the scene plays with its own finger and screen.
  }
  const { [settings.entry ?? ENTRY]: scene, ...files } = all;
  if (!scene) throw new Error(`This zip holds no ${settings.entry ?? ENTRY}: it was not saved by the studio.`);
  return {
    name: String(settings.name ?? "scene").slice(0, 60),
    profiles: { ...settings.profiles },
    text: strFromU8(scene),
    files: Object.entries(files),
  };
}

/**
 * The files of a zip by their names; throws a sentence where there are too many or they are too big.
 * @param {Uint8Array} bytes
 * @param {boolean} isOwn
 * @returns {Record<string, Uint8Array<ArrayBuffer>>}
 */
function unpacked(bytes, isOwn) {
  let [files, size, packed] = [0, 0, 0];
  // Files that share their packed bytes would be unpacked from them again and again.
  const isApart = () => isOwn || packed <= bytes.length;
  const hasRoom = () => isOwn || (files <= FILES_MAX && size <= UNPACKED_MAX_BYTES);
  // The sizes are those that the zip states; a file is unpacked into no more than its stated size.
  const filter = (/** @type {UnzipFileInfo} */ { name, size: packedSize, originalSize }) => {
    files += 1;
    size += originalSize;
    packed += packedSize;
    return isApart() && hasRoom() && !name.endsWith("/");
  };
  /** @type {ReturnType<typeof unzipSync>} */
  let entries;
  try {
    entries = unzipSync(bytes, { filter });
  } catch {
    throw new Error("This zip cannot be read: save it anew from the studio.");
  }
  if (!isApart()) {
    throw new Error("The files of this zip lie over one another: save it anew from the studio.");
  }
  if (!hasRoom()) {
    const limits = `at most ${FILES_MAX} files of together ${UNPACKED_MAX_BYTES / 1e6} MB`;
    throw new Error(`This zip unpacks to ${files} files of together ${mb(size)} MB; the studio opens ${limits}.`);
  }
  return /** @type {Record<string, Uint8Array<ArrayBuffer>>} */ (entries);
}

/** @param {number} bytes */
function mb(bytes) {
  return (bytes / 1e6).toFixed(1);
}
