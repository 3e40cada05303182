// The module of `frixel.widget.SceneWidget` in notebooks: <frixel-scene> as a view of anywidget
// (https://anywidget.dev).
//
// `cargo xtask studio` appends it to the script of the element. Python sends the scene; nothing is sent back.
// @ts-check

/** @import { Files } from "../engine/types" */
/**
 * What Python sends of a scene: its text, the files that the text names, and profiles in place of its own.
 * @typedef {{ text: string, files: Record<string, DataView<ArrayBuffer>>, finger: string | null, screen: string | null }} SentScene
 */
/**
 * @typedef {object} Model
 * @property {(name: string) => any} get
 * @property {(event: string, act: () => void) => void} on
 * @property {(event: string, act: () => void) => void} off
 */

const CHANGES = ["change:scene", "change:touch"];

/**
 * Shows the scene in an element of the notebook; returns what removes it.
 * @param {{ model: Model, el: HTMLElement }} view
 */
async function render({ model, el }) {
  // The script defines the element some time after it has run.
  await customElements.whenDefined("frixel-scene");
  const show = () => el.replaceChildren(sceneElement(model.get("scene"), model.get("touch")));
  show();
  for (const change of CHANGES) model.on(change, show);
  return () => {
    for (const change of CHANGES) model.off(change, show);
    el.replaceChildren();
  };
}

/**
 * @param {SentScene} scene
 * @param {string} touch
 */
function sceneElement({ text, files, finger, screen }, touch) {
  const element = /** @type {HTMLElement & { files: Files }} */ (document.createElement("frixel-scene"));
  element.textContent = text;
  element.files = Object.fromEntries(Object.entries(files).map(([name, view]) => [name, copied(view)]));
  for (const [name, value] of Object.entries({ finger, screen, touch })) {
    if (value !== null) element.setAttribute(name, value);
  }
  return element;
}

/**
 * The bytes alone: a message to a worker would copy the whole buffer that they are a part of.
 * @param {DataView<ArrayBuffer>} view
 */
function copied({ buffer, byteOffset, byteLength }) {
  return new Uint8Array(buffer.slice(byteOffset, byteOffset + byteLength));
}

export default { render };
