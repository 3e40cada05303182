// The dialog of Open: files, and the pieces of work that the browser keeps.

import { attempt, byId, element } from "./dom.js";

export class Open {
  #works;
  #dialog = byId("open");
  #urls = [];
  /** A piece of work is chosen: `onWork(id)`. */
  onWork = () => {};

  /** `choose()` lets a person choose files. */
  constructor(works, choose) {
    this.#works = works;
    byId("open-files").onclick = () => this.#open(choose);
    this.#dialog.addEventListener("close", () => this.#urls.splice(0).forEach((url) => URL.revokeObjectURL(url)));
  }

  async #open(choose) {
    const files = element("button", { className: "primary" }, "Files…");
    files.onclick = () => {
      this.#dialog.close();
      choose();
    };
    const close = element("button", { onclick: () => this.#dialog.close() }, "Close");
    const list = element("div", { className: "scenes" });
    this.#dialog.replaceChildren(
      element("div", { className: "head" }, element("h2", {}, "Open"), files, close),
      element("p", { className: "soft" }, "Files: a scene with its files, pictures, profiles, or a saved zip."),
      element("h3", {}, "Recent scenes"),
      list,
    );
    this.#dialog.showModal();
    const works = await this.#works.all().catch(() => []);
    const edited = works.filter(({ isEdited }) => isEdited);
    if (edited.length > 0) list.append(...edited.map((work) => this.#card(work)));
    else list.append("A scene that you change is kept here by this browser. None is kept yet.");
  }

  #card({ id, name, changedMs, picture }) {
    const card = element("article", { className: "scene" });
    if (picture) {
      this.#urls.push(URL.createObjectURL(picture));
      card.append(element("img", { src: this.#urls.at(-1), alt: "" }));
    }
    const open = element("button", { className: "primary" }, `Open ${name}`);
    open.onclick = () => {
      this.#dialog.close();
      attempt(() => this.onWork(id));
    };
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
