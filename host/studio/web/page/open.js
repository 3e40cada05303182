// The dialog of Open: files, and the pieces of work that the browser keeps.
// @ts-check

import { choiceButton } from "./dialogs.js";
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
    byId("open-files").onclick = () => this.#open();
    byId("choose-files").onclick = choose;
    byId("link-form").onsubmit = (event) => this.#openLink(event);
    this.#dialog.addEventListener("close", () => this.#revoke());
  }

  #revoke() {
    for (const url of this.#urls.splice(0)) URL.revokeObjectURL(url);
  }

  async #open() {
    const list = byId("recent");
    list.replaceChildren();
    byId("link").value = "";
    byId("no-link").hidden = true;
    this.#dialog.showModal();
    const works = await this.#works.all().catch(() => /** @type {Work[]} */ ([]));
    const edited = works.filter(({ isEdited }) => isEdited);
    if (edited.length > 0) list.append(...edited.map((work) => this.#card(work)));
    else list.append("A scene that you change is kept here by this browser. None is kept yet.");
  }

  /**
   * On a phone there is no other way to paste a link.
   * @param {Event} event
   */
  #openLink(event) {
    event.preventDefault();
    const fragment = fragmentIn(byId("link").value.trim());
    byId("no-link").hidden = fragment !== undefined;
    if (fragment === undefined) return;
    this.#dialog.close();
    attempt(() => this.onLink(fragment));
  }

  /** @param {Work} work */
  #card({ id, name, changedMs, picture }) {
    const card = element("article", { className: "scene" });
    if (picture) {
      const url = URL.createObjectURL(picture);
      this.#urls.push(url);
      card.append(element("img", { src: url, alt: "" }));
    }
    const open = choiceButton(`Open ${name}`, () => this.onWork(id));
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
