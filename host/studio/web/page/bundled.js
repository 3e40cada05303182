// The scenes, pictures and fingers that the page carries.

/** Names of the bundled scenes, without ending. */
export function sceneNames() {
  return studio
    .names("scenes/")
    .filter((name) => /^scenes\/[^/]+\.toml$/.test(name))
    .map((name) => name.slice(7, -5));
}

export function sceneText(name) {
  return studio.text(`scenes/${name}.toml`);
}

export function fingerNames() {
  return studio.names("scenes/fingers/").map((name) => name.slice("scenes/fingers/".length, -5));
}

export function schema() {
  return studio.text("docs/scene.schema.json").then(JSON.parse);
}

const pictures = new Map();

/** The bundled picture that scenes call `name`, or undefined. */
export async function picture(name) {
  const packed = `scenes/${name}`;
  if (!studio.names("scenes/textures/").includes(packed)) return undefined;
  if (!pictures.has(name)) pictures.set(name, await studio.bytes(packed));
  return pictures.get(name);
}
