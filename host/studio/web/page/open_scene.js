// The scene that is open: its name, its files, and how another one takes its place.
// @ts-check

import { Autosave } from "./autosave.js";
import { byId } from "./dom.js";
import { forgetNotice, notify } from "./notices.js";
import { showPictures } from "./pictures.js";
import { isPicture, isToml } from "./project.js";

/** @import { Engine } from "../engine/engine.js" */
/** @import { Compare } from "./compare.js" */
/** @import { Editor } from "./editor.js" */
/** @import { Found } from "./incoming.js" */
/** @import { Player } from "./player.js" */
/** @import { Profiles } from "./profiles.js" */
/** @import { Project, SavedScene, SceneToOpen } from "./project.js" */
/** @import { Works } from "./works.js" */

/**
 * @typedef {object} Parts
 * @property {Engine} engine
 * @property {Project} project
 * @property {Player} player
 * @property {Editor} editor
 * @property {Compare} compare
 * @property {Profiles} profiles
 * @property {Works} works
 */

export class OpenScene {
  #engine;
  #project;
  #player;
  #editor;
  #compare;
  #profiles;
  #autosave;

  /** @param {Parts} parts */
  constructor({ engine, project, player, editor, compare, profiles, works }) {
    this.#engine = engine;
    this.#project = project;
    this.#player = player;
    this.#editor = editor;
    this.#compare = compare;
    this.#profiles = profiles;
    this.#autosave = new Autosave(works, () => this.saved);
    editor.onChange = (file, text) => {
      compare.cancel();
      if (file !== undefined) project.files.set(file, text);
      this.#autosave.changed();
      player.later(editor.text);
    };
    profiles.onChange = () => {
      this.#autosave.changed();
      this.replay();
    };
    byId("scene-name").onchange = () => this.#rename(byId("scene-name").value);
  }

  /**
   * All of it, as archive.js packs it.
   * @returns {SavedScene & { entry: string }}
   */
  get saved() {
    const { name, entry, profiles, files } = this.#project;
    return { name, entry, profiles: { ...profiles }, text: this.#editor.text, files: [...files] };
  }

  /** What was open before a reload, if anything was. */
  last() {
    return this.#autosave.last();
  }

  /**
   * A piece of work that the browser keeps.
   * @param {string} id
   */
  work(id) {
    return this.#autosave.work(id);
  }

  /**
   * The scene's map has this picture.
   * @param {Blob} picture
   */
  show(picture) {
    this.#autosave.show(picture);
  }

  /** Plays the scene anew, as it is now. */
  replay() {
    this.#compare.cancel();
    this.#player.now(this.#editor.text);
  }

  /**
   * Opens a scene from elsewhere. A changed scene can be brought back.
   * @param {SceneToOpen} scene
   */
  open(scene) {
    return this.#bringIn(() => this.#replace(scene));
  }

  /**
   * Takes a layer over from elsewhere.
   * @param {string} text
   */
  append(text) {
    return this.#bringIn(async () => this.#editor.append(text));
  }

  /**
   * Takes what a person has dropped or chosen.
   * @param {Found} found
   */
  take({ scene, files, profiles }) {
    return this.#bringIn(async () => {
      for (const [kind, profile] of profiles) this.#profiles.add(kind, profile);
      if (scene) await this.#replace(scene);
      else {
        for (const [name, content] of files) this.#project.add(name, content);
        this.#filesChanged();
      }
      if (!files.some(([name]) => isPicture(name))) return;
      this.#editor.onReveal();
      byId("tab-pictures").click();
    });
  }

  /**
   * Runs an action that brings something from elsewhere into the scene. A real board is disarmed before, and nothing
   * can be armed until it has the scene that is shown then.
   * @param {() => Promise<void>} action
   */
  #bringIn(action) {
    return this.#player.expect(async () => {
      try {
        await this.#engine.forget();
        await action();
      } catch (error) {
        // The board gets the scene back that is still shown.
        this.replay();
        throw error;
      }
    });
  }

  /** @param {SceneToOpen} scene */
  async #replace({ name, text, files = [], profiles, ...work }) {
    const [autosave, project] = [this.#autosave, this.#project];
    const before = { ...this.saved, ...autosave.state };
    forgetNotice();
    await autosave.leave();
    await project.replaceFiles(files);
    project.name = name;
    this.#showName();
    if (profiles) this.#profiles.choose(profiles);
    this.#editor.open(text);
    this.#showFiles();
    await autosave.opened(work);
    if (before.isEdited)
      notify(
        `${project.name} is open.`,
        { words: `Back to ${before.name}`, action: () => this.open(before) },
        { isGood: true, beside: byId("scene-name") },
      );
  }

  #showName() {
    const { name } = this.#project;
    Object.assign(byId("scene-name"), { value: name, size: Math.max(4, Math.min(name.length, 24)) });
    document.title = `${name} · frixel studio`;
  }

  /** @param {string} name */
  #rename(name) {
    const project = this.#project;
    const before = project.name;
    project.name = name.trim();
    if (project.files.has(project.entry)) {
      const said = `${project.entry} is a file of this scene already: choose another name.`;
      notify(said, undefined, { beside: byId("scene-name") });
      project.name = before;
    }
    this.#showName();
    if (project.name !== before) this.#filesChanged();
  }

  #filesChanged() {
    this.#autosave.changed();
    this.#showFiles();
    this.replay();
  }

  #showFiles() {
    const { files } = this.#project;
    showPictures(this.#project, this.#editor, (name) => {
      files.delete(name);
      this.#filesChanged();
    });
    /** @type {[string, string][]} */
    const texts = [];
    for (const [name, content] of files) if (isToml(name) && typeof content === "string") texts.push([name, content]);
    this.#editor.setFiles(texts);
  }
}
