// A scene as a link: text and small files of one's own, compressed in the fragment.
// @ts-check

import { deflateSync, inflateSync, strFromU8, strToU8 } from "../vendor/studio-vendor.js";

/** @import { Content, NamedFile, SavedScene } from "./project.js" */

/** Longest link that mail programs and chats take, characters. */
const LINK_MAX = 32_000;
/** Largest content of a link, unpacked: a link cannot make the page unpack gigabytes. */
const CONTENT_MAX_BYTES = 4_000_000;
const START = "#scene=";

/**
 * The link of a scene; throws a sentence where it would be too long.
 * @param {string} name
 * @param {string} text
 * @param {NamedFile[]} files
 */
export function linkOf(name, text, files) {
  const content = {
    name,
    text,
    files: Object.fromEntries(files.map(([key, value]) => [key, toBase64(asBytes(value))])),
  };
  const link =
    location.href.split("#")[0] + START + toBase64(deflateSync(strToU8(JSON.stringify(content)), { level: 9 }));
  if (link.length > LINK_MAX) {
    throw new Error(
      `This scene is too big for a link: ${link.length} characters, of ${LINK_MAX}. Save it and send the zip.`,
    );
  }
  return link;
}

/**
 * Says what another person needs for a link that was made in a page at this address.
 * @param {{ protocol: string, hostname: string }} address
 */
export function whoCanOpen({ protocol, hostname }) {
  const isOwn = protocol === "file:" || ["127.0.0.1", "localhost", "[::1]"].includes(hostname);
  return isOwn
    ? "It begins with an address on this computer: another person opens the studio's HTML file and pastes the link " +
        "into the page, or under “Open…”. Send them the file, too, or a saved zip."
    : "Whoever opens it needs nothing else.";
}

/**
 * The fragment of a link in pasted text, or undefined.
 * @param {string} text
 */
export function fragmentIn(text) {
  return /^\S*(#scene=[\w-]+)\s*$/.exec(text)?.[1];
}

/** @param {string} fragment */
export function isLink(fragment) {
  return fragment.startsWith(START);
}

/**
 * What a link carries; throws a sentence where it is no scene.
 * @param {string} fragment
 * @returns {SavedScene}
 */
export function sceneOfFragment(fragment) {
  const broken = "The link does not hold a scene: a part of it was lost or changed. The scene you had stays.";
  try {
    if (fragment.length > LINK_MAX) throw new Error(broken);
    const packed = fromBase64(fragment.slice(START.length));
    const content = JSON.parse(strFromU8(inflateSync(packed, { out: new Uint8Array(CONTENT_MAX_BYTES) })));
    if (typeof content.text !== "string" || typeof content.name !== "string") throw new Error(broken);
    /** @type {NamedFile[]} */
    const files = Object.entries(content.files ?? {}).map(([name, value]) => [name, fromBase64(value)]);
    return { name: content.name, text: content.text, files };
  } catch {
    throw new Error(broken);
  }
}

/** @param {Content} value */
function asBytes(value) {
  return typeof value === "string" ? strToU8(value) : value;
}

/** @param {Uint8Array} bytes */
export function toBase64(bytes) {
  let binary = "";
  for (const byte of bytes) binary += String.fromCharCode(byte);
  return btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

/** @param {string} text */
export function fromBase64(text) {
  return Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (character) => character.charCodeAt(0));
}
