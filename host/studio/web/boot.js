// The first script of the page: unpacks the files that the page carries, and starts its module.
//
// `cargo xtask studio` puts them into one HTML file, and into the scripts of <frixel-scene>. All call `boot(packed,
// entry)` with the files, each compressed by gzip and in base64, and the name of the module to start. The module of
// <frixel-scene> on a web server carries no pictures: it also gives the address of a folder that has them. `studio`
// gives the rest of the page their contents:
//
//   await studio.bytes("engine.wasm")          Uint8Array; of a file that is not carried, from that folder
//   await studio.text("scenes/brick.toml")     string
//   studio.policy                              what a content security policy must allow, a sentence
//   studio.names("scenes/")                    the names of carried files that begin so, sorted
//
// Modules import each other by relative paths; here they become blob URLs, because a page from a file has no others.
// @ts-check
"use strict";

/**
 * @param {Record<string, string>} packed
 * @param {string} entry
 * @param {string} [folder]
 */
function boot(packed, entry, folder) {
  /** @type {Map<string, Promise<string>>} */
  const urls = new Map();

  /** @param {string} name */
  async function bytes(name) {
    if (!(name in packed)) return fetched(name);
    const characters = atob(packed[name]);
    // `Uint8Array.from` takes half a second for the engine.
    const zipped = new Uint8Array(characters.length);
    for (let at = 0; at < zipped.length; at += 1) zipped[at] = characters.charCodeAt(at);
    const unpacking = new DecompressionStream("gzip");
    const unpacked = new Response(unpacking.readable).arrayBuffer();
    const writer = unpacking.writable.getWriter();
    await Promise.all([writer.write(zipped), writer.close()]);
    return new Uint8Array(await unpacked);
  }

  /** @param {string} name */
  async function fetched(name) {
    if (folder === undefined) throw new Error(`this page carries no file ${name}`);
    const answer = await fetch(new URL(name, folder));
    if (!answer.ok) throw new Error(`${answer.url}: ${answer.status} ${answer.statusText}`);
    return new Uint8Array(await answer.arrayBuffer());
  }

  /** @param {string} name */
  async function text(name) {
    return new TextDecoder().decode(await bytes(name));
  }

  function names(start = "") {
    return Object.keys(packed).filter((name) => name.startsWith(start)).sort();
  }

  /**
   * The URL of a module, whose imports are URLs, too.
   * @param {string} name
   */
  function moduleUrl(name) {
    const url = urls.get(name) ?? makeUrl(name);
    urls.set(name, url);
    return url;
  }

  /** @param {string} name */
  async function makeUrl(name) {
    const parts = (await text(name)).split(/^((?:import|export)\s[\w\s{},*$]*?from\s*)"(\.{1,2}\/[^"]+)"/m);
    // Each import splits the text into what is before it, its names, and its path. Those of types stand in comments.
    for (let at = 2; at < parts.length; at += 3) parts[at] = JSON.stringify(await moduleUrl(resolved(parts[at], name)));
    return URL.createObjectURL(new Blob([parts.join("")], { type: "text/javascript" }));
  }

  /**
   * The name of the file that a module calls `path`.
   * @param {string} path
   * @param {string} module
   */
  function resolved(path, module) {
    return new URL(path, `file:///${module}`).pathname.slice(1);
  }

  const policy =
    "if this document has a content security policy, it must allow script-src blob: 'wasm-unsafe-eval', " +
    "worker-src blob:, and connect-src for scenes and pictures beside it (docs/design/studio.md)";

  globalThis.studio = { bytes, text, names, moduleUrl, policy };
  moduleUrl(entry)
    .then((url) => import(url))
    .catch((error) => {
      console.error(error);
      if (!entry.startsWith("element/") || customElements.get("frixel-scene")) return;
      const sentence = `<frixel-scene> cannot start (${error.message}): ${policy}`;
      const Refused = class extends HTMLElement {
        connectedCallback() {
          if (!this.shadowRoot) this.attachShadow({ mode: "open" }).append(sentence);
        }
      };
      customElements.define("frixel-scene", Refused);
    });
}
