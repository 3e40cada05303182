// The files of a scene above the editor: a tab for each, where there is more than one.
// @ts-check

import { byId, element, shortName } from "./dom.js";
import { stepOf } from "./tabs.js";

/** @import { Editor, FileOfScene } from "./editor.js" */
/** @import { Project } from "./project.js" */

export class FileTabs {
  #list = byId("file-tabs");
  #editor;
  #project;

  /**
   * @param {Editor} editor
   * @param {Project} project
   */
  constructor(editor, project) {
    this.#editor = editor;
    this.#project = project;
    editor.onFiles = (files) => this.#show(files);
    this.#list.onkeydown = ({ key }) => {
      const step = stepOf(key);
      if (!step) return;
      const { files } = this.#editor;
      const next = (files.findIndex(({ isShown }) => isShown) + step + files.length) % files.length;
      this.#editor.show(files[next].name);
      /** @type {HTMLElement} */ (this.#list.children[next]).focus();
    };
  }

  /** @param {FileOfScene[]} files */
  #show(files) {
    this.#list.hidden = files.length < 2;
    this.#list.replaceChildren(...files.map((file) => this.#tab(file)));
  }

  /** @param {FileOfScene} file */
  #tab({ name, isShown, mistakes }) {
    const count = mistakes === 1 ? "1 mistake" : `${mistakes} mistakes`;
    return element(
      "button",
      {
        role: "tab",
        "aria-selected": isShown,
        "aria-controls": "editor",
        tabIndex: isShown ? 0 : -1,
        onclick: () => this.#editor.show(name),
      },
      shortName(name ?? this.#project.entry),
      ...(mistakes > 0 ? [element("span", { className: "count", "aria-label": count }, `${mistakes}`)] : []),
    );
  }
}
