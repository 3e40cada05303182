// Everything of a project as a zip, and back.

import { strFromU8, strToU8, unzipSync, zipSync } from "../vendor/studio-vendor.js";

/** Largest file of a zip, and most files, that are unpacked. */
const FILE_MAX_BYTES = 8_000_000;
const FILES_MAX = 100;
/** Name of the scene where the settings say none. */
const ENTRY = "scene.toml";
/** What was chosen in the page. */
const SETTINGS = "studio.json";

export function zipOf({ name, entry, text, files, profiles }) {
  const settings = JSON.stringify({ name, entry, profiles }, null, 2);
  const entries = { [entry]: strToU8(text), [SETTINGS]: strToU8(settings) };
  for (const [file, content] of files) entries[file] = typeof content === "string" ? strToU8(content) : content;
  return zipSync(entries, { level: 6 });
}

/** A project from a zip; throws a sentence where it holds none. */
export function projectOf(bytes) {
  let count = 0;
  let entries;
  try {
    entries = unzipSync(bytes, {
      filter: ({ name, originalSize }) => {
        count += 1;
        return count <= FILES_MAX && originalSize <= FILE_MAX_BYTES && !name.endsWith("/");
      },
    });
  } catch {
    throw new Error("This zip cannot be read: save it anew from the studio.");
  }
  const { [SETTINGS]: chosen, ...all } = entries;
  let settings = {};
  try {
    settings = chosen ? JSON.parse(strFromU8(chosen)) : {};
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
