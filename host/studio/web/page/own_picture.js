// A picture of one's own that a person chooses, for a layer.
// @ts-check

import { chosenFile, sentenceOf, stemOf } from "./dom.js";
import { contentOf } from "./incoming.js";
import { sameName } from "./project.js";
import { pictureIn } from "./toml_text.js";

/** @import { Engine } from "../engine/engine.js" */
/** @import { Hands } from "./hands.js" */
/** @import { OpenScene } from "./open_scene.js" */
/** @import { Project } from "./project.js" */

/**
 * A picture with its width over its height.
 * @typedef {{ name: string, bytes: Uint8Array<ArrayBuffer>, aspect: number }} OwnPicture
 */

const PICTURE_COMMENT = "A picture: black is bare glass, white the most that the drive can add.";

/**
 * Lets a person choose a picture; resolves to undefined if none is chosen.
 * @param {Engine} engine
 * @returns {Promise<OwnPicture | undefined>}
 */
export async function choosePicture(engine) {
  const file = await chosenFile("image/png,image/jpeg");
  if (!file) return undefined;
  try {
    const bytes = await contentOf(file);
    const { aspect } = await engine.picture(bytes);
    return { name: sameName(file.name), bytes, aspect };
  } catch (error) {
    throw new Error(`${file.name}: ${sentenceOf(error)}`);
  }
}

/**
 * Opens a scene with a picture that a person chooses, whose layer is selected.
 * @param {Engine} engine
 * @param {OpenScene} scene
 * @param {Hands} hands
 * @param {Project} project
 */
export async function beginWithPicture(engine, scene, hands, project) {
  const picture = await choosePicture(engine);
  if (!picture) return;
  const { name, bytes, aspect } = picture;
  const text = pictureIn(`# ${PICTURE_COMMENT}\nversion = 1\n`, name, aspect, project.screenOfNew);
  await hands.editNext(() => scene.open({ name: stemOf(name), text, files: [[name, bytes]] }));
}
