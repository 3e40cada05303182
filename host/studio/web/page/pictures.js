// The pictures of the project: a list, with a layer for each at a press.
// @ts-check

import { byId, element, shortName } from "./dom.js";
import { isPicture } from "./project.js";
import { pictureIn } from "./toml_text.js";

/** @import { Project } from "./project.js" */

/**
 * @param {Project} project
 * @param {(layer: string) => void} onAdd A layer with this text is wanted.
 * @param {(name: string) => void} onRemove
 */
export function showPictures(project, onAdd, onRemove) {
  const panel = byId("panel-pictures");
  for (const image of panel.querySelectorAll("img")) URL.revokeObjectURL(image.src);
  const pictures = [...project.files].filter(([name]) => isPicture(name));
  panel.replaceChildren(...pictures.map(([name, bytes]) => row(name, bytes, project, onAdd, onRemove)));
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
 * @param {(layer: string) => void} onAdd A layer with this text is wanted.
 * @param {(name: string) => void} onRemove
 */
function row(name, bytes, project, onAdd, onRemove) {
  const url = URL.createObjectURL(new Blob([bytes], { type: /\.png$/i.test(name) ? "image/png" : "image/jpeg" }));
  const image = element("img", { src: url, alt: "" });
  image.onerror = () => (image.hidden = true);
  const add = element("button", {}, "Add as a layer");
  add.onclick = () => {
    const { naturalWidth, naturalHeight } = image;
    onAdd(pictureIn("", name, naturalWidth / naturalHeight || 1, project.screen));
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
