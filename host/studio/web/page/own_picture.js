// A picture of one's own that a person chooses, for a layer.
// @ts-check

import { chosenFile, sentenceOf, stemOf } from "./dom.js";
import { read } from "./incoming.js";
import { pictureIn } from "./toml_text.js";

/** @import { Hands } from "./hands.js" */
/** @import { OpenScene } from "./open_scene.js" */
/** @import { Project } from "./project.js" */

/**
 * A picture with its width over its height.
 * @typedef {{ name: string, bytes: Uint8Array<ArrayBuffer>, aspect: number }} OwnPicture
 */

const PICTURE_COMMENT = "A picture: black is bare glass, white the most that the drive can add.";

/** Lets a person choose a picture; resolves to undefined if none is chosen. */
export async function choosePicture() {
  const file = await chosenFile("image/png,image/jpeg");
  return file && chosen(file);
}

/**
 * @param {File} file
 * @returns {Promise<OwnPicture>}
 */
async function chosen(file) {
  const { files = [] } = await read(file, { texts: [], files: [], profiles: [] }).catch((error) => {
    throw new Error(`${file.name}: ${sentenceOf(error)}`);
  });
  const [name, bytes] = files[0] ?? [];
  if (!name || typeof bytes !== "object") throw new Error(`${file.name}: expected a picture (.png, .jpg)`);
  // The compiler does not turn a photo as its camera says.
  const image = await createImageBitmap(new Blob([bytes]), { imageOrientation: "none" }).catch(() => {
    throw new Error(`${name}: this picture cannot be read`);
  });
  const aspect = image.width / image.height;
  image.close();
  return { name, bytes, aspect };
}

/**
 * Opens a scene with a picture that a person chooses, whose layer is selected.
 * @param {OpenScene} scene
 * @param {Hands} hands
 * @param {Project} project
 */
export async function beginWithPicture(scene, hands, project) {
  const picture = await choosePicture();
  if (!picture) return;
  const { name, bytes, aspect } = picture;
  const text = pictureIn(`# ${PICTURE_COMMENT}\nversion = 1\n`, name, aspect, project.screenOfNew);
  await hands.editNext(() => scene.open({ name: stemOf(name), text, files: [[name, bytes]] }));
}
