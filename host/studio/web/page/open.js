// The dialog of Open: files, and the pieces of work that the browser keeps.
// @ts-check

import { choiceButton, fillDialog } from "./dialogs.js";
import { byId, element } from "./dom.js";
import { attempt } from "./notices.js";
import { fragmentIn } from "./share.js";

/** @import { Work, Works } from "./works.js" */

export class Open {
  #works;
  #dialog = byId("open");
  /** @type {string[]} */
  #urls = [];
  /**
   * A piece of work is chosen: `onWork(id)`.
   * @type {(id: string) => unknown}
   */
  onWork = () => {};
  /**
   * A link is pasted: `onLink(fragment)`.
   * @type {(fragment: string) => unknown}
   */
  onLink = () => {};

  /**
   * `choose()` lets a person choose files.
   * @param {Works} works
   * @param {() => void} choose
   */
  constructor(works, choose) {
    this.#works = works;
    byId("open-files").onclick = () => this.#open(choose);
    this.#dialog.addEventListener("close", () => this.#revoke());
  }

  #revoke() {
    for (const url of this.#urls.splice(0)) URL.revokeObjectURL(url);
  }

  /** @param {() => void} choose */
  async #open(choose) {
    const list = element("div", { className: "scenes" });
    fillDialog(
      this.#dialog,
      "Open",
      [choiceButton(this.#dialog, "Files…", choose)],
      element("p", { className: "soft" }, "Files: a scene with its files, pictures, profiles, or a saved zip."),
      this.#link(),
      element("h3", {}, "Recent scenes"),
      list,
    );
    this.#dialog.showModal();
    const works = await this.#works.all().catch(() => /** @type {Work[]} */ ([]));
    const edited = works.filter(({ isEdited }) => isEdited);
    if (edited.length > 0) list.append(...edited.map((work) => this.#card(work)));
    else list.append("A scene that you change is kept here by this browser. None is kept yet.");
  }

  /** A field for the link of a scene: on a phone there is no other way to paste one. */
  #link() {
    const field = element("input", { type: "text", placeholder: "Paste a link…", "aria-label": "Link of a scene" });
    const said = element("p", { className: "fine", hidden: true, role: "alert" });
    const open = element("button", { type: "submit" }, "Open the link");
    const form = element("form", { className: "row link-row" }, field, open, said);
    form.onsubmit = (event) => {
      event.preventDefault();
      const fragment = fragmentIn(field.value.trim());
      said.hidden = fragment !== undefined;
      said.textContent = "This is no link of a scene: one that Share made has #scene= in it.";
      if (fragment === undefined) return;
      this.#dialog.close();
      attempt(() => this.onLink(fragment));
    };
    return form;
  }

  /** @param {Work} work */
  #card({ id, name, changedMs, picture }) {
    const card = element("article", { className: "scene" });
    if (picture) {
      const url = URL.createObjectURL(picture);
      this.#urls.push(url);
      card.append(element("img", { src: url, alt: "" }));
    }
    const open = choiceButton(this.#dialog, `Open ${name}`, () => this.onWork(id));
    const remove = element("button", {}, "Delete");
    remove.onclick = () => {
      remove.textContent = "Delete for good";
      remove.onclick = () => attempt(() => this.#works.delete(id).then(() => card.remove()));
    };
    const time = element("time", { dateTime: new Date(changedMs).toISOString() }, new Date(changedMs).toLocaleString());
    card.append(element("h3", {}, name), element("p", { className: "fine" }, time), open, remove);
    return card;
  }
}
