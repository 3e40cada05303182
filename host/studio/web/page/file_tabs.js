// The files of a scene above the editor: a tab for each, where there is more than one.

import { byId, element } from "./dom.js";

export class FileTabs {
  #list = byId("file-tabs");
  #editor;
  #project;

  constructor(editor, project) {
    this.#editor = editor;
    this.#project = project;
    editor.onFiles = (files) => this.#show(files);
    this.#list.onkeydown = ({ key }) => {
      const step = { ArrowLeft: -1, ArrowRight: 1 }[key];
      if (!step) return;
      const { files } = this.#editor;
      const next = (files.findIndex(({ isShown }) => isShown) + step + files.length) % files.length;
      this.#editor.show(files[next].name);
      this.#list.children[next].focus();
    };
  }

  #show(files) {
    this.#list.hidden = files.length < 2;
    this.#list.replaceChildren(...files.map((file) => this.#tab(file)));
  }

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
      name ?? this.#project.entry,
      ...(mistakes > 0 ? [element("span", { className: "count", "aria-label": count }, `${mistakes}`)] : []),
    );
  }
}
