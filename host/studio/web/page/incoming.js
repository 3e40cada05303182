// Files that a person drops or opens: scenes, pictures, profiles and saved projects.

import { projectOf } from "./archive.js";
import { byId, notify } from "./dom.js";

/** Largest text, picture and zip, bytes. */
const MAX = { toml: 500_000, png: 8_000_000, zip: 16_000_000 };
const PNG = [0x89, 0x50, 0x4e, 0x47];

export class Incoming {
  /** `{ scene: { name, text, files, profiles? }, files: [[name, content]], finger, screen }`, some missing. */
  onFiles = () => {};

  constructor() {
    const input = byId("files");
    byId("open-files").onclick = () => input.click();
    input.onchange = () => {
      this.take([...input.files]);
      input.value = "";
    };
    const drop = byId("drop");
    let depth = 0;
    const show = (change) => {
      depth = Math.max(0, depth + change);
      drop.hidden = depth === 0;
    };
    addEventListener("dragenter", (event) => event.dataTransfer?.types.includes("Files") && show(1));
    addEventListener("dragleave", (event) => event.dataTransfer?.types.includes("Files") && show(-1));
    addEventListener("dragover", (event) => event.preventDefault());
    addEventListener("drop", (event) => {
      event.preventDefault();
      show(-depth);
      this.take([...(event.dataTransfer?.files ?? [])]);
    });
  }

  /** Takes what can be taken of these files, and says what cannot, and why. */
  async take(list) {
    const found = { files: [] };
    const refused = [];
    for (const file of list) {
      try {
        Object.assign(found, await read(file, found));
      } catch (error) {
        refused.push(`${file.name}: ${error.message}`);
      }
    }
    if (found.scene || found.finger || found.screen || found.files.length > 0) this.onFiles(found);
    if (refused.length > 0) notify(refused.join("\n"));
  }
}

async function read(file, found) {
  const ending = /\.(toml|png|zip)$/i.exec(file.name)?.[1].toLowerCase();
  if (!ending) throw new Error("expected a scene or profile (.toml), a picture (.png) or a saved project (.zip)");
  if (file.size > MAX[ending]) {
    const [size, most] = [file.size, MAX[ending]].map((bytes) => (bytes / 1e6).toFixed(1));
    throw new Error(`the file has ${size} MB, more than the ${most} MB that the studio opens`);
  }
  const bytes = new Uint8Array(await file.arrayBuffer());
  if (ending === "zip") return { scene: projectOf(bytes) };
  if (ending === "png") {
    if (PNG.some((byte, at) => bytes[at] !== byte)) throw new Error("this is no PNG picture, whatever its name says");
    return { files: [...found.files, [file.name, bytes]] };
  }
  return readToml(file.name, bytes);
}

function readToml(fileName, bytes) {
  let text;
  try {
    text = new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    throw new Error("this is no text in UTF-8");
  }
  const name = fileName.replace(/\.toml$/i, "");
  if (/^\s*(\[|version\s*=)/m.test(text)) return { scene: { name, text, files: [] } };
  if (/^\s*friction_coefficient\s*=/m.test(text)) return { finger: { name, text } };
  if (/^\s*width_mm\s*=/m.test(text)) return { screen: { name, text } };
  return { scene: { name, text, files: [] } };
}
