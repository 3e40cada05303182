// The pictures of the project: a list, with a layer for each at a press.
// @ts-check

import { byId, element } from "./dom.js";
import { isPicture } from "./project.js";

/** @import { Editor } from "./editor.js" */
/** @import { Project } from "./project.js" */

/**
 * @param {Project} project
 * @param {Editor} editor
 * @param {(name: string) => void} onRemove
 */
export function showPictures(project, editor, onRemove) {
  const panel = byId("panel-pictures");
  for (const image of panel.querySelectorAll("img")) URL.revokeObjectURL(image.src);
  const pictures = [...project.files].filter(([name]) => isPicture(name));
  panel.replaceChildren(...pictures.map(([name, bytes]) => row(name, bytes, editor, onRemove)));
  panel.append(
    element(
      "p",
      { className: "soft" },
      pictures.length > 0
        ? "Black is bare glass, white the most that the drive can add."
        : "Drop a PNG or JPEG anywhere on the page, or use Open. Black is bare glass, white the most that the drive " +
            "can add.",
    ),
  );
}

/**
 * @param {string} name
 * @param {BlobPart} bytes
 * @param {Editor} editor
 * @param {(name: string) => void} onRemove
 */
function row(name, bytes, editor, onRemove) {
  const url = URL.createObjectURL(new Blob([bytes], { type: /\.png$/i.test(name) ? "image/png" : "image/jpeg" }));
  const image = element("img", { src: url, alt: "" });
  image.onerror = () => (image.hidden = true);
  const add = element("button", {}, "Add as a layer");
  add.onclick = () => editor.append(layerOf(name));
  const remove = element("button", { onclick: () => onRemove(name), "aria-label": `Remove ${name}` }, "Remove");
  return element(
    "div",
    { className: "picture" },
    image,
    element("b", {}, name),
    element("span", { className: "gap" }),
    add,
    remove,
  );
}

/**
 * A layer that shows a picture on the example screen; 0.4 mm of pitch fits into a board's room.
 * @param {string} name
 */
export function layerOf(name) {
  const title = JSON.stringify(name.replace(/\.\w+$/, ""));
  return (
    `[[layer]]\nname = ${title}\nkind = "bitmap"\npicture = ${JSON.stringify(name)}\nx_mm = 10\ny_mm = 10\n` +
    "width_mm = 60\npitch_mm = 0.4\n"
  );
}
