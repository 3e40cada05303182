// The bar at the top: what a person does with the whole scene, and links that bring one.
// @ts-check

import { projectOf, zipOf } from "./archive.js";
import { byId, download } from "./dom.js";
import { attempt, notify } from "./notices.js";
import { Open } from "./open.js";
import { mistakesIn } from "./problems.js";
import { fragmentIn, isLink, linkOf, sceneOfFragment, whoCanOpen } from "./share.js";

/** @import { Engine } from "../engine/engine.js" */
/** @import { Editor } from "./editor.js" */
/** @import { Gallery } from "./gallery.js" */
/** @import { OpenScene } from "./open_scene.js" */
/** @import { Project } from "./project.js" */
/** @import { Works } from "./works.js" */

/** @typedef {{ gallery: Gallery, works: Works, editor: Editor, engine: Engine, project: Project }} Parts */

/** @param {Parts & { scene: OpenScene }} parts */
export function makeBar({ scene, gallery, works, editor, engine, project }) {
  const dialog = new Open(works, () => byId("files").click());
  dialog.onWork = async (id) => scene.open(await scene.autosave.work(id));
  dialog.onLink = (fragment) => scene.open(sceneOfFragment(fragment));
  makeMenu();
  byId("open-gallery").onclick = () => attempt(() => gallery.open());
  byId("undo").onclick = () => editor.undo();
  byId("redo").onclick = () => editor.redo();
  editor.onHistory = () => {
    byId("undo").disabled = !editor.canUndo;
    byId("redo").disabled = !editor.canRedo;
  };
  byId("save").onclick = () => attempt(() => save(scene, project, editor));
  byId("share").onclick = () => attempt(() => share(engine, project, editor.text));
  addEventListener("keydown", (event) => {
    if (event.key.toLowerCase() !== "s" || !(event.ctrlKey || event.metaKey) || event.altKey || event.shiftKey) return;
    event.preventDefault();
    byId("save").click();
  });
}

/** In a narrow window most of the buttons are in a menu, which closes at a press anywhere, and at Escape. */
function makeMenu() {
  const [menu, toggle] = [byId("menu"), byId("toggle-menu")];
  const show = (/** @type {boolean} */ isOpen) => {
    menu.classList.toggle("is-open", isOpen);
    toggle.setAttribute("aria-expanded", String(isOpen));
  };
  document.addEventListener("click", ({ target }) => {
    const isToggled = target instanceof Node && toggle.contains(target);
    show(isToggled && !menu.classList.contains("is-open"));
  });
  menu.parentElement?.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !menu.classList.contains("is-open")) return;
    event.preventDefault();
    show(false);
    toggle.focus();
  });
}

/**
 * @param {OpenScene} scene
 * @param {Project} project
 * @param {Editor} editor
 */
async function save(scene, project, editor) {
  const files = await project.filesForZip(editor.text);
  const zip = zipOf({ ...scene.saved, files });
  download(`${project.name}.zip`, zip, "application/zip");
  // Throws what a person is told where the studio would not open the zip again.
  projectOf(zip);
  notify(`${project.name}.zip is among your downloads.`, undefined, { isGood: true, beside: byId("save") });
}

/**
 * @param {Engine} engine
 * @param {Project} project
 * @param {string} text
 */
async function share(engine, project, text) {
  const { name, entry, profiles } = project;
  // The check that is shown may be of an older text.
  const checking = project.filesFor(text).then((files) => engine.compile(files, entry, { ...profiles }));
  const link = linkOf(name, text, await project.filesForLink(text));
  history.replaceState(null, "", new URL(link).hash);
  const place = await navigator.clipboard.writeText(link).then(
    () => "The link is copied.",
    () => "The link stands in the address line: copy it from there.",
  );
  const said = `${place} It holds the whole scene; nothing is uploaded. ${whoCanOpen(location)}`;
  const check = await checking;
  const { count, isDraft } = mistakesIn(check);
  const plays = isDraft ? "it plays as a draft only" : "it does not play before that is mended";
  const warned = check.ok ? "" : `The scene has ${count}: whoever opens the link sees the text, and ${plays}. `;
  notify(`${warned}${said}`, undefined, { isGood: check.ok, beside: byId("share") });
}

/**
 * Opens the scene of the address, if it has one.
 * @param {OpenScene} scene
 */
export function openLink(scene) {
  if (isLink(location.hash)) attempt(() => scene.open(sceneOfFragment(location.hash)));
}

/**
 * Opens links that come later: in the address, or pasted into the page.
 * @param {OpenScene} scene
 */
export function followLinks(scene) {
  addEventListener("hashchange", () => openLink(scene));
  const paste = (/** @type {ClipboardEvent} */ event) => {
    const fragment = fragmentIn(event.clipboardData?.getData("text/plain") ?? "");
    if (fragment === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    /** @type {NodeListOf<HTMLDialogElement>} */
    const dialogs = document.querySelectorAll("dialog[open]");
    for (const dialog of dialogs) dialog.close();
    attempt(() => scene.open(sceneOfFragment(fragment)));
  };
  addEventListener("paste", paste, { capture: true });
}
