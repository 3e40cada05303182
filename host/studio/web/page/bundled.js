// The scenes, pictures, fingers and screens that the page carries.
// @ts-check

/** Names of the bundled scenes, without ending. */
export function sceneNames() {
  return studio
    .names("scenes/")
    .filter((name) => /^scenes\/[^/]+\.toml$/.test(name))
    .map((name) => name.slice(7, -5));
}

/** @param {string} name */
export function sceneText(name) {
  return studio.text(`scenes/${name}.toml`);
}

export function fingerNames() {
  return studio.names("scenes/fingers/").map((name) => name.slice("scenes/fingers/".length, -5));
}

export function schema() {
  return studio.text("docs/design/scene.schema.json").then((text) => JSON.parse(text));
}

/** @type {Promise<Record<string, Uint8Array<ArrayBuffer>>> | undefined} */
let carried;

/** The files of the page that scenes may name, by the names that the bundled scenes use. */
export function carriedFiles() {
  carried ??= readCarried();
  return carried;
}

async function readCarried() {
  const names = studio.names("scenes/");
  const contents = await Promise.all(names.map((name) => studio.bytes(name)));
  return Object.fromEntries(names.map((name, at) => [name.slice("scenes/".length), contents[at]]));
}
