// The pictures of the project: a list, with a layer for each at a press.
// @ts-check

import { byId, element, shortName } from "./dom.js";
import { isPicture } from "./project.js";

/** @import { Screen } from "../engine/types" */
/** @import { Editor } from "./editor.js" */
/** @import { Project } from "./project.js" */

/** Largest part of the screen's width and height that a picture is added with. */
const PART_OF_SCREEN = 0.75;

/**
 * @param {Project} project
 * @param {Editor} editor
 * @param {(name: string) => void} onRemove
 */
export function showPictures(project, editor, onRemove) {
  const panel = byId("panel-pictures");
  for (const image of panel.querySelectorAll("img")) URL.revokeObjectURL(image.src);
  const pictures = [...project.files].filter(([name]) => isPicture(name));
  panel.replaceChildren(...pictures.map(([name, bytes]) => row(name, bytes, project, editor, onRemove)));
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
 * @param {Project} project
 * @param {Editor} editor
 * @param {(name: string) => void} onRemove
 */
function row(name, bytes, project, editor, onRemove) {
  const url = URL.createObjectURL(new Blob([bytes], { type: /\.png$/i.test(name) ? "image/png" : "image/jpeg" }));
  const image = element("img", { src: url, alt: "" });
  image.onerror = () => (image.hidden = true);
  const add = element("button", {}, "Add as a layer");
  add.onclick = () => {
    const { naturalWidth, naturalHeight } = image;
    editor.append(layerOf(name, naturalWidth / naturalHeight || 1, project.screen));
  };
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

/**
 * A layer that shows a picture in the middle of a screen. It has no pitch: the compiler takes the finest that a board has
 * room for, whatever other pictures the scene has.
 * @param {string} name
 * @param {number} aspect Width over height of the picture.
 * @param {Screen} screen
 */
function layerOf(name, aspect, { widthMm, heightMm }) {
  const width = PART_OF_SCREEN * Math.min(widthMm, heightMm * aspect);
  const tenths = (/** @type {number} */ mm) => Math.round(10 * mm) / 10;
  const title = JSON.stringify(name.replace(/\.\w+$/, ""));
  return (
    `[[layer]]\nname = ${title}\nkind = "bitmap"\npicture = ${JSON.stringify(name)}\n` +
    `x_mm = ${tenths((widthMm - width) / 2)}\ny_mm = ${tenths((heightMm - width / aspect) / 2)}\n` +
    `width_mm = ${Math.max(0.1, tenths(width))}\n`
  );
}
