// The pictures of the project: a list, with a layer for each at a press.
// @ts-check

import { byId, element, shortName } from "./dom.js";
import { isPicture } from "./project.js";

/** @import { Project } from "./project.js" */

/**
 * @param {Project} project
 * @param {(name: string, bytes: Uint8Array<ArrayBuffer>) => void} onAdd A layer with this picture is wanted.
 * @param {(name: string) => void} onRemove
 */
export function showPictures(project, onAdd, onRemove) {
  const list = byId("pictures");
  for (const image of list.querySelectorAll("img")) URL.revokeObjectURL(image.src);
  const pictures = [...project.files].filter(([name]) => isPicture(name));
  const rows = pictures.map(([name, bytes]) => row(name, /** @type {Uint8Array<ArrayBuffer>} */ (bytes), onAdd, onRemove));
  list.replaceChildren(...rows);
  byId("no-pictures").hidden = pictures.length > 0;
}

/**
 * @param {string} name
 * @param {Uint8Array<ArrayBuffer>} bytes
 * @param {(name: string, bytes: Uint8Array<ArrayBuffer>) => void} onAdd
 * @param {(name: string) => void} onRemove
 */
function row(name, bytes, onAdd, onRemove) {
  const url = URL.createObjectURL(new Blob([bytes], { type: /\.png$/i.test(name) ? "image/png" : "image/jpeg" }));
  const image = element("img", { src: url, alt: "" });
  image.onerror = () => (image.hidden = true);
  const add = element("button", { onclick: () => onAdd(name, bytes) }, "Add as a layer");
  const remove = element("button", { onclick: () => onRemove(name), "aria-label": `Remove ${name}` }, "Remove");
  return element(
    "div",
    { className: "picture" },
    image,
    element("b", {}, shortName(name)),
    element("span", { className: "gap" }),
    add,
    remove,
  );
}
